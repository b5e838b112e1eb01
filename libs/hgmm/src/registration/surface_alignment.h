#pragma once
#include <Eigen/Core>
#include <vector>

#include "hgmm/mixture.h"
#include "hgmm/scan.h"
#include "occupancy/patch_tree.h"
#include "registration/registration_cost.h"
#include "registration/registration_layers.h"

namespace hgmm {

/// Samples of a scan, thinned and evenly spread, about the sensor.
struct AlignmentSamples {
    /// The first sample of each cell of a grid, which is as fine as it may be for no more
    /// than `most` samples. Samples that are not finite are left out.
    /// @param normalOfRays_sensor ScanSamples::normalOfRays_sensor, zero if there is none
    AlignmentSamples(const Mixture<3>& samples_sensor,
                     const Eigen::Vector3d& normalOfRays_sensor, std::size_t most);

    std::size_t size() const { return mean.size(); }

    std::vector<Eigen::Vector3d> mean;                 ///< in the sensor frame [m]
    std::vector<Eigen::Matrix3d> covariance;           ///< [m^2]
    std::vector<bool> grazing;                         ///< areGrazing
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the means [m]
    /// As of RegistrationSource: a small rotation w about the centre moves the samples by
    /// |gyrationRadii w|, rms [m].
    Eigen::Matrix3d gyrationRadii = Eigen::Matrix3d::Identity();
    double gyrationRadius_m = 1.0;  ///< rms distance from the sensor, > 0
    /// Of a planar laser, which moves in the plane of its rays only.
    bool planar = false;
    Eigen::Vector3d planeNormal = Eigen::Vector3d::Zero();  ///< in the sensor frame, unit
};

/// What is known of a sensor's pose before its scan is looked at.
struct AlignmentPrior {
    Pose T_target_sensor;
    /// Of the error (w, v), as in Registration; positive definite.
    Matrix6d covariance = Matrix6d::Identity();
    /// How far off the prior may be, one standard deviation: the first stage looks so far.
    SearchRadius deviation;
};

/// Of errors with these deviations along each axis.
Matrix6d covarianceOf(const SearchRadius& deviation);

struct SurfaceAlignment {
    Pose T_target_sensor;
    /// Of the error (w, v), prior included; directions that the surfaces do not hold have
    /// that of the prior.
    Matrix6d covariance = Matrix6d::Identity();
    int observable = 0;    ///< directions that the surfaces hold [count], 0 to 6
    double overlap = 0.0;  ///< share of the samples that lie on a surface, [0, 1]
};

/// Aligns samples with surfaces: Gauss-Newton steps on the distances along the normals of
/// the nearest patches, in stages whose kernel (Geman and McClure's) narrows from the
/// prior's deviation to the thickness of the surfaces.
///
/// A patch holds a sample across itself, with the variances of both, and lets it slide
/// along; the line that a planar laser drew holds across both of its thin axes. A patch
/// that faces the sensor does not hold a sample whose ray grazes its surface: it is not
/// what the ray met, but what the pattern of rays drew. Directions that the surfaces do not
/// hold are left to the prior (solution remapping, Zhang and Singh 2016). Does not depend
/// on the number of threads.
SurfaceAlignment alignToSurfaces(const PatchTree<3>& target,
                                 const AlignmentSamples& samples,
                                 const AlignmentPrior& prior);

}  // namespace hgmm
