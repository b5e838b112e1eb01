#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace hgmm::evaluation::gp_octomap {

/// Points in columns [m].
using PointMatrix = Eigen::Matrix3Xd;

/// Of labels +1 and -1.
struct Kernel {
    double length_m;
    double sigmaF;
    double noise;  ///< standard deviation
};

/// Latent labels of some points.
struct Predictions {
    Eigen::VectorXd mean, variance;  ///< variance in [0, sigmaF^2]
};

/// Exact Gaussian process regression of labels with the Matern 3/2 kernel
/// sigmaF^2 (1 + s) exp(-s), s = sqrt(3) distance / length (Rasmussen and Williams 2006,
/// eq. 4.17), on the data of one block.
class LocalGp {
 public:
    LocalGp(PointMatrix points_m, const Eigen::VectorXd& labels, const Kernel& kernel);

    void predict(const PointMatrix& points_m, Predictions& out) const;

 private:
    Kernel kernel_;
    PointMatrix points_;
    Eigen::LLT<Eigen::MatrixXd> llt_;
    Eigen::VectorXd weights_;
};

}  // namespace hgmm::evaluation::gp_octomap
