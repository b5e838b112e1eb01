#include "registration/registration_layers.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace hgmm {

namespace {

/// Beyond so many widened standard deviations a target component has no
/// part in the alignment.
constexpr float kReach = 3.F;
/// A component is widened along itself by at most so many times the width.
constexpr double kMaxAspect = 30.0;
/// Thickness of a surface that is taken for exact [m].
constexpr double kThinnest_m = 1e-3;
/// Least radius of gyration: a single component turns about itself [m].
constexpr double kShortest_m = 0.1;
/// Source components that one thread sums at a time.
constexpr std::size_t kPairsPerChunk = 32;

bool isFinite(const Gaussian<3>& g) {
    return g.mean.allFinite() && g.covariance.allFinite();
}

std::size_t chunksOf(std::size_t n) {
    return (n + kPairsPerChunk - 1) / kPairsPerChunk;
}

Eigen::Matrix3d widenedShape(const Eigen::Matrix3d& axes, const Eigen::Vector3d& variances,
                             double width_m) {
    const Eigen::Array3d own = variances.array().max(kThinnest_m * kThinnest_m);
    const Eigen::Array3d aspect2 = (own / own.minCoeff()).min(kMaxAspect * kMaxAspect);
    const Eigen::Vector3d sum = own + width_m * width_m * aspect2;
    return axes * sum.asDiagonal() * axes.transpose();
}

/// Keeps the nearest of the components within kReach of p, equally near ones in the
/// index' order.
void findNearest(const ComponentIndex& index, const Eigen::Vector3f& p, Neighbours& found) {
    std::array<float, Neighbours::kMost> distance2;
    distance2.fill(kReach * kReach);
    index.visitCandidates(p.x(), p.y(), p.z(), [&](std::uint32_t j) {
        const float d2 = index.factor(j).squaredMahalanobis(p.data());
        if (!(d2 < distance2.back())) return;
        int k = Neighbours::kMost - 1;
        for (; k > 0 && d2 < distance2[k - 1]; --k) {
            distance2[k] = distance2[k - 1];
            found.target[k] = found.target[k - 1];
        }
        distance2[k] = d2;
        found.target[k] = j;
    });
}

}  // namespace

Eigen::Matrix3d gyrationRadiiOf(const Eigen::Matrix3d& moments) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(moments);
    const Eigen::Vector3d about =
        Eigen::Vector3d::Constant(moments.trace()) - eigen.eigenvalues();
    const Eigen::Vector3d gyrationRadii =
        about.cwiseMax(kShortest_m * kShortest_m).cwiseSqrt();
    return eigen.eigenvectors() * gyrationRadii.asDiagonal() *
           eigen.eigenvectors().transpose();
}

RegistrationSource::RegistrationSource(const Mixture<3>& mixture) {
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Gaussian<3> g = mixture[i];
        if (!isFinite(g)) continue;
        mean.emplace_back(g.mean);
        covariance.emplace_back(g.covariance);
        support.push_back(g.support);
        centre += mean.back();
    }
    if (mean.empty()) return;
    centre /= double(mean.size());
    double sum = 0.0;
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < mean.size(); ++i) {
        mean[i] -= centre;
        sum += mean[i].squaredNorm();
        moments += mean[i] * mean[i].transpose() + covariance[i];
    }
    gyrationRadius_m = std::max(std::sqrt(sum / double(mean.size())), kShortest_m);
    gyrationRadii = gyrationRadiiOf(moments / double(mean.size()));
}

double RegistrationSource::shareOf(const std::vector<Neighbours>& neighbours) const {
    double found = 0.0, total = 0.0;
    for (std::size_t i = 0; i < size(); ++i) {
        total += support[i];
        if (!neighbours[i].none()) found += support[i];
    }
    return total > 0.0 ? found / total : 0.0;
}

RegistrationSource RegistrationSource::thinned(double cell_m) const {
    RegistrationSource few;
    few.centre = centre;
    few.gyrationRadius_m = gyrationRadius_m;
    few.gyrationRadii = gyrationRadii;
    std::set<std::array<std::int64_t, 3>> taken;
    for (std::size_t i = 0; i < size(); ++i) {
        std::array<std::int64_t, 3> cell;
        for (int k = 0; k < 3; ++k) cell[k] = std::llround(mean[i][k] / cell_m);
        if (!taken.insert(cell).second) continue;
        few.mean.push_back(mean[i]);
        few.covariance.push_back(covariance[i]);
        few.support.push_back(support[i]);
    }
    return few;
}

Shapes::Shapes(const Mixture<3>& mixture) {
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Gaussian<3> g = mixture[i];
        if (!isFinite(g)) continue;
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
        eigen.computeDirect(g.covariance);
        if (!eigen.eigenvectors().allFinite()) continue;
        components.push_back(g);
        axes.push_back(eigen.eigenvectors());
        variances.push_back(eigen.eigenvalues());
    }
}

TargetLayer::TargetLayer(const Shapes& target, double width)
    : width_m(width), index(kReach, static_cast<float>(width)) {
    Mixture<3> mixture;
    mixture.reserve(target.components.size());
    for (std::size_t j = 0; j < target.components.size(); ++j) {
        mixture.pushBack(target.components[j]);
        mean.emplace_back(target.components[j].mean);
        widened.push_back(widenedShape(target.axes[j], target.variances[j], width));
    }
    index.rebuild(mixture);
}

std::uint32_t TargetLayers::layerOf(double width_m) const {
    std::uint32_t layer = 0;
    while (layer + 1 < layers_.size() && M_SQRT2 * layers_[layer].width_m < width_m)
        ++layer;
    return layer;
}

std::vector<Neighbours> TargetLayers::associate(const RegistrationSource& source,
                                                const SearchRadius& searchRadius,
                                                const Pose& T_target_centre) const {
    std::vector<Neighbours> neighbours(source.size());
    const auto chunks = static_cast<std::int64_t>(chunksOf(source.size()));
#pragma omp parallel for schedule(static)
    for (std::int64_t chunk = 0; chunk < chunks; ++chunk) {
        const std::size_t first = std::size_t(chunk) * kPairsPerChunk;
        const std::size_t last = std::min(first + kPairsPerChunk, source.size());
        for (std::size_t i = first; i < last; ++i) {
            const Eigen::Vector3f p =
                (T_target_centre.R * source.mean[i] + T_target_centre.t).cast<float>();
            neighbours[i].layer = layerOf(searchRadius.at(source.mean[i].norm()));
            findNearest(layers_[neighbours[i].layer].index, p, neighbours[i]);
        }
    }
    return neighbours;
}

template <typename Visitor>
void TargetLayers::forEachPair(const RegistrationSource& source,
                               const std::vector<Neighbours>& neighbours,
                               const Pose& T_target_centre, std::size_t first,
                               std::size_t last, Visitor&& visit) const {
    const Eigen::Matrix3d& R = T_target_centre.R;
    ComponentPair pair;
    for (std::size_t i = first; i < last; ++i) {
        if (neighbours[i].none()) continue;
        const TargetLayer& layer = layers_[neighbours[i].layer];
        pair.width_m = layer.width_m;
        pair.arm = R * source.mean[i];
        pair.covariance = R * source.covariance[i] * R.transpose();
        for (const std::uint32_t j : neighbours[i].target) {
            if (j == Neighbours::kNobody) break;
            pair.between = pair.arm + T_target_centre.t - layer.mean[j];
            pair.widened = layer.widened[j];
            visit(pair, j);
        }
    }
}

template <typename Sum, typename Add>
Sum TargetLayers::sumOverPairs(const RegistrationSource& source,
                               const std::vector<Neighbours>& neighbours,
                               const Pose& T_target_centre, Add&& add) const {
    std::vector<Sum> sums(chunksOf(source.size()), Sum{});
    const auto chunks = static_cast<std::int64_t>(sums.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t chunk = 0; chunk < chunks; ++chunk) {
        const std::size_t first = std::size_t(chunk) * kPairsPerChunk;
        forEachPair(source, neighbours, T_target_centre, first,
                    std::min(first + kPairsPerChunk, source.size()),
                    [&](const ComponentPair& pair, std::uint32_t) {
                        add(pair, sums[std::size_t(chunk)]);
                    });
    }
    Sum total{};
    for (const Sum& sum : sums) total += sum;
    return total;
}

double TargetLayers::cost(const RegistrationSource& source,
                          const std::vector<Neighbours>& neighbours,
                          const Pose& T_target_centre) const {
    return sumOverPairs<double>(
        source, neighbours, T_target_centre,
        [](const ComponentPair& pair, double& sum) { sum += pairCost(pair); });
}

std::vector<double> TargetLayers::costs(const RegistrationSource& source,
                                        const std::vector<Neighbours>& neighbours,
                                        const Pose& T_target_centre) const {
    std::vector<double> costs(source.size(), 0.0);
    for (std::size_t i = 0; i < source.size(); ++i)
        forEachPair(
            source, neighbours, T_target_centre, i, i + 1,
            [&](const ComponentPair& pair, std::uint32_t) { costs[i] += pairCost(pair); });
    return costs;
}

CostSums TargetLayers::sums(const RegistrationSource& source,
                            const std::vector<Neighbours>& neighbours,
                            const Pose& T_target_centre) const {
    return sumOverPairs<CostSums>(
        source, neighbours, T_target_centre,
        [](const ComponentPair& pair, CostSums& sum) { addPair(pair, sum); });
}

Matrix6d TargetLayers::gradientScatter(const RegistrationSource& source,
                                       const std::vector<Neighbours>& neighbours,
                                       const Pose& T_target_centre) const {
    // What a component is off by, all its pairs share: gradients are summed over the pairs
    // of each target component, and over those of each source component.
    std::map<std::uint32_t, Vector6d> ofTarget;
    Matrix6d scatter = Matrix6d::Zero();
    CostSums unused;
    for (std::size_t i = 0; i < source.size(); ++i) {
        Vector6d ofSource = Vector6d::Zero();
        const auto visit = [&](const ComponentPair& pair, std::uint32_t j) {
            const Vector6d gradient = addPair(pair, unused);
            ofSource += gradient;
            ofTarget.try_emplace(j, Vector6d::Zero()).first->second += gradient;
        };
        forEachPair(source, neighbours, T_target_centre, i, i + 1, visit);
        scatter += ofSource * ofSource.transpose();
    }
    for (const auto& [j, gradient] : ofTarget) scatter += gradient * gradient.transpose();
    return scatter;
}

}  // namespace hgmm
