#pragma once
#include <Eigen/Core>

#include "hgmm/gaussian.h"

namespace hgmm {

/// A component as a piece of a surface.
struct Piece {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit vector
    double thickness_m = 0.0;                          ///< standard deviation along it
    double width_m = 0.0;  ///< the smaller one across it, or that in the plane of rays
};

/// @param normalOfRays of a planar laser; else zero
Piece pieceOf(const Gaussian<3>& component, const Eigen::Vector3d& normalOfRays);

/// Whether a piece is so much wider than thick that it is one of a wall or a door. Others,
/// as bushes and corners, let rays pass and are still there.
bool isSheet(const Piece& piece);

/// A ray went through a surface if it ends so far behind it [m]: 3 standard deviations, and
/// what poses may be off by.
/// @param sigma_m of the surface, in the direction in which it is asked [m]
double clearBehind(double sigma_m, double range_m);

}  // namespace hgmm
