#include "vertical.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace hgmm::slam {
namespace {

constexpr double kReach_rad = M_PI / 6.0;   // of normals about the z axis
constexpr double kNarrowest_rad = 0.07;     // about what they share, in the end
constexpr std::size_t kFewest = 10;         // level patches that tell
constexpr double kThin = 0.3, kWide = 0.3;  // of a patch: its axes by each other

struct LevelPatch {
    Eigen::Vector3d normal;
    double area = 0.0;
};

std::vector<LevelPatch> levelPatches(const Mixture<3>& surfaces) {
    std::vector<LevelPatch> patches;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(
            Eigen::Matrix3d(surfaces[i].covariance));
        const Eigen::Vector3d sigma = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
        if (sigma[0] > kThin * sigma[1] || sigma[1] < kWide * sigma[2]) continue;
        Eigen::Vector3d normal = axes.eigenvectors().col(0);
        if (normal.z() < 0) normal = -normal;
        if (normal.z() < std::cos(kReach_rad)) continue;
        patches.push_back({normal, sigma[1] * sigma[2]});
    }
    return patches;
}

}  // namespace

Eigen::Vector3d verticalOf(const Mixture<3>& surfaces) {
    const std::vector<LevelPatch> patches = levelPatches(surfaces);
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    if (patches.size() < kFewest) return up;
    for (double reach_rad = kReach_rad; reach_rad > kNarrowest_rad; reach_rad *= 0.8) {
        Eigen::Vector3d sum = 1e-9 * up;
        for (const LevelPatch& patch : patches)
            if (patch.normal.dot(up) > std::cos(reach_rad))
                sum += patch.area * patch.normal;
        up = sum.normalized();
    }
    return up;
}

Eigen::Matrix3d rotationFromZ(const Eigen::Vector3d& vertical) {
    return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), vertical)
        .toRotationMatrix();
}

}  // namespace hgmm::slam
