#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "base/require_rigid.h"
#include "hgmm/divergence.h"
#include "hgmm/map.h"
#include "map/model.h"
#include "mixture/regularized.h"

namespace hgmm {

namespace {

/// A component over space, and W where D = 4, which a change of frame leaves as it is.
template <int D>
Gaussian<D> moved(Gaussian<D> g, const Pose& pose) {
    Eigen::Matrix<double, D, D> A = Eigen::Matrix<double, D, D>::Identity();
    A.template topLeftCorner<3, 3>() = pose.R;
    const Eigen::Matrix<double, D, D> covariance = g.covariance;
    g.covariance = A * covariance * A.transpose();
    const Eigen::Matrix<double, D, 1> mean = g.mean;
    g.mean = A * mean;
    g.mean.template head<3>() += pose.t;
    return g;
}

ViewDirection moved(ViewDirection view, const Pose& pose) {
    view.direction = pose.R * view.direction;
    return view;
}

/// Whether two estimates of a surface were made from one side of it, as splitByNovelty has
/// it.
bool sameSide(const Gaussian<3>& g, const ViewDirection& a, const ViewDirection& b) {
    if (!a.known() || !b.known()) return true;
    const Eigen::Matrix3d covariance = g.covariance;
    return a.direction.dot(covariance.ldlt().solve(b.direction)) > 0.0;
}

double similarity(const Gaussian<3>& a, const Gaussian<3>& b) {
    return std::min(klDivergence(a, b), klDivergence(b, a));
}

/// Joins a component, in this local frame, to the most similar of the first `candidates`,
/// or adds it.
void mergeSurface(const Gaussian<3>& component, const ViewDirection& view,
                  std::size_t candidates, Model& model, QueryCache& cache) {
    ComponentStore& store = model.components;
    const Eigen::Vector3f mean = Eigen::Vector3d(component.mean).cast<float>();
    auto best = static_cast<std::uint32_t>(store.size());
    double bestSimilarity = model.params.hierarchy.similarityMax;
    cache.index().visitCandidates(mean.x(), mean.y(), mean.z(), [&](std::uint32_t j) {
        if (j >= candidates) return;
        const Gaussian<3> mine = store.surfaces()[j];
        if (!sameSide(mine, store.viewDirections()[j], view)) return;
        const double kl = similarity(mine, component);
        if (kl >= bestSimilarity) return;
        bestSimilarity = kl;
        best = j;
    });
    if (best == store.size()) {
        store.add(regularized(component), view);
    } else {
        const Gaussian<3> mine = store.surfaces()[best];
        store.set(
            best, regularized(mergeMoments(mine, component)),
            merged(store.viewDirections()[best], mine.support, view, component.support));
    }
    cache.apply(store.takeChanges());
}

/// Distance of the farthest mean of a mixture from the origin of its frame [m].
template <int D>
double farthestMean(const Mixture<D>& mixture) {
    double farthest = 0.0;
    for (std::size_t i = 0; i < mixture.size(); ++i)
        farthest = std::max(
            farthest, std::hypot(double(mixture.mean[0][i]), double(mixture.mean[1][i]),
                                 double(mixture.mean[2][i])));
    return farthest;
}

/// Throws std::invalid_argument if a map that is moved so would leave the bounds of maps.
void requireWithinBounds(const Model& from, const Eigen::Vector3d& origin_this,
                         const Pose& T_local_other) {
    if (!(origin_this.cwiseAbs().maxCoeff() <= kMaxPosition_m))
        throw std::invalid_argument(
            "merge: the origin of the other map comes to lie farther than 1e8 m from the "
            "origin");
    double farthest = std::max(farthestMean(from.components.surfaces()),
                               farthestMean(from.freeSpace.mixture()));
    for (const ModalityGroup& group : from.modalities.groups())
        farthest = std::max(farthest, farthestMean(group.mixture().places()));
    if (!(T_local_other.t.norm() + farthest <= kMaxCoordinate_m))
        throw std::invalid_argument(
            "merge: a component of the other map comes to lie farther than 1e9 m from this "
            "map's origin");
}

/// Openings where another map does not say that a point is rather occupied: a ray may have
/// ended there since, or before. In one map it would have shut them.
Openings notContradicted(const Openings& openings, const QueryCache& other,
                         const Pose& T_other_this) {
    if (openings.empty()) return openings;
    const OccupancyModel& answers = other.occupancy(0);
    const auto isOccupied = [&](const Eigen::Vector3d& point) {
        return answers.at(T_other_this.R * point + T_other_this.t).occupied > 0.5F;
    };
    return openings.where([&](const LatticeCell& cell) {
        // Surfaces are about as thick as cells are wide.
        const double quarter_m = powerOfTwo(cell.octave) / 4;
        const Eigen::Vector3d centre = cell.centre();
        bool isHit = isOccupied(centre);
        for (int k = 0; k < 8 && !isHit; ++k)
            isHit = isOccupied(centre + quarter_m * Eigen::Vector3d((k & 1) != 0 ? 1 : -1,
                                                                    (k & 2) != 0 ? 1 : -1,
                                                                    (k & 4) != 0 ? 1 : -1));
        return !isHit;
    });
}

}  // namespace

void Map::merge(const Map& other, const Pose& T_this_other) {
    requireRigid(T_this_other, "merge: the pose of the other map");
    if (&other == this) return merge(Map(other), T_this_other);
    Model& model = state_->model;
    const Model& from = other.state_->model;
    if (from.isBlank()) return;
    const Eigen::Vector3d otherOrigin_this = T_this_other.R * from.origin + T_this_other.t;
    const Eigen::Vector3d origin =
        model.isBlank() ? otherOrigin_this.array().round() : model.origin;
    const Pose T_local_other{T_this_other.R, otherOrigin_this - origin};
    requireWithinBounds(from, otherOrigin_this, T_local_other);
    model.origin = origin;

    const Openings theirs = notContradicted(from.openings, state_->cache, T_local_other);
    model.openings =
        notContradicted(model.openings, other.state_->cache, T_local_other.inverse());
    model.openings.merge(theirs, T_local_other);
    const std::size_t candidates = model.components.size();
    for (std::size_t i = 0; i < from.components.size(); ++i)
        mergeSurface(moved(from.components.surfaces()[i], T_local_other),
                     moved(from.components.viewDirections()[i], T_local_other), candidates,
                     model, state_->cache);
    std::vector<std::uint32_t> updatedFree;
    for (std::size_t i = 0; i < from.freeSpace.mixture().size(); ++i)
        updatedFree.push_back(model.freeSpace.merge(
            moved(from.freeSpace.mixture()[i], T_local_other), from.freeSpace.octave(i)));
    model.coverage.merge(from.coverage, T_local_other);
    std::sort(updatedFree.begin(), updatedFree.end());
    updatedFree.erase(std::unique(updatedFree.begin(), updatedFree.end()),
                      updatedFree.end());
    state_->cache.apply(model.components.takeChanges(), updatedFree);
    model.modalities.merge(from.modalities, T_local_other, model.params);
}

}  // namespace hgmm
