#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <optional>

namespace hgmm::evaluation {

/// Sums over the points in one cell, relative to its centre so that nothing cancels: mean
/// and covariance in one pass.
struct PointSums {
    double n = 0.0;                                    ///< points; not whole once scaled
    Eigen::Vector3d first = Eigen::Vector3d::Zero();   ///< of offsets [m]
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< of their outer products [m^2]

    void add(const Eigen::Vector3d& offset_m);
    /// Sums of another set, relative to the same centre.
    void add(const PointSums& other);
    /// Keeps mean and covariance, but lets them weigh no more than n points.
    void limit(double nMax);
    Eigen::Vector3d mean() const { return first / n; }  ///< relative to the centre [m]
    /// Unbiased sample covariance [m^2]; n must be above 1.
    Eigen::Matrix3d covariance() const;
};

/// The normal distribution of the points in one cell.
struct CellGaussian {
    Eigen::Vector3d mean_map;     ///< [m]
    Eigen::Matrix3d information;  ///< inverse of the covariance [1/m^2]
    double logDensityAtMean;      ///< [ln 1/m^3]

    /// Mahalanobis distance, squared.
    double squaredDistance(const Eigen::Vector3d& p_map) const {
        const Eigen::Vector3d d = p_map - mean_map;
        return d.dot(information * d);
    }
    double density(const Eigen::Vector3d& p_map) const {
        return std::exp(logDensityAtMean - 0.5 * squaredDistance(p_map));
    }
};

/// Points below which a cell has no Gaussian, and the largest ratio of the eigenvalues of
/// its covariance: smaller ones are raised (Magnusson, The Three-Dimensional
/// Normal-Distributions Transform, PhD thesis, Oerebro University 2009, section 6.2).
constexpr double kMinCellPoints = 5.0;
constexpr double kMaxEigenvalueRatio = 100.0;

/// Nothing for a cell of too few points. Points in one spot are taken to spread over a
/// thousandth of the cell's edge.
std::optional<CellGaussian> gaussianOf(const PointSums& sums,
                                       const Eigen::Vector3d& centre_map, double edge_m);

}  // namespace hgmm::evaluation
