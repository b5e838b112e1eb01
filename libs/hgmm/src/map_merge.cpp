#include <algorithm>
#include <limits>
#include <stdexcept>

#include "hgmm/divergence.h"
#include "hgmm/map.h"
#include "map_derived.h"
#include "require_rigid.h"
#include "storable.h"

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

View moved(View view, const Pose& pose) {
    view.direction = pose.R * view.direction;
    return view;
}

/// Whether two estimates of a surface were made from one side of it, as splitByNovelty has
/// it.
bool sameSide(const Gaussian<3>& g, const View& a, const View& b) {
    if (!a.known() || !b.known()) return true;
    const Eigen::Matrix3d covariance = g.covariance;
    return a.direction.dot(covariance.ldlt().solve(b.direction)) > 0.0;
}

double similarity(const Gaussian<3>& a, const Gaussian<3>& b) {
    return std::min(klDivergence(a, b), klDivergence(b, a));
}

}  // namespace

void Map::merge(const Map& other, const Pose& T_this_other) {
    requireRigid(T_this_other, "merge: the pose of the other map");
    if (params_.occupancy.freeSpace.freeSpaceModel !=
        other.params_.occupancy.freeSpace.freeSpaceModel)
        throw std::invalid_argument(
            "merge: freeSpaceModel differs; maps of different models cannot be merged");
    if (&other == this) return merge(Map(other), T_this_other);
    if (other.isBlank()) return;
    const Eigen::Vector3d otherOrigin_this =
        T_this_other.R * other.origin_ + T_this_other.t;
    if (isBlank()) origin_ = otherOrigin_this.array().round();
    const Pose T_local_other{T_this_other.R, otherOrigin_this - origin_};

    const Model& from = other.model_;
    const std::size_t candidates = model_.surfaces.size();
    for (std::size_t i = 0; i < from.surfaces.size(); ++i) {
        const std::uint32_t became =
            mergeSurface(moved(from.surfaces[i], T_local_other),
                         moved(from.views[i], T_local_other), candidates);
        if (!freePerComponent()) continue;
        const Gaussian<4> free = moved(from.freeOfSurfaces[i], T_local_other);
        Mixture<4>& mine = model_.freeOfSurfaces;
        if (became == mine.size())
            mine.pushBack(storable(free));
        else
            mine.set(became, storable(mergeMoments(mine[became], free)));
        derived_->updateFree(*this, became);
    }
    for (std::size_t i = 0; i < from.freeSpace.mixture().size(); ++i)
        derived_->updateFree(
            *this, model_.freeSpace.merge(moved(from.freeSpace.mixture()[i], T_local_other),
                                          from.freeSpace.octave(i)));
    model_.modalities.merge(other.model_.modalities, T_local_other, params_);
    derived_->finish(*this);
}

std::uint32_t Map::mergeSurface(const Gaussian<3>& component, const View& view,
                                std::size_t candidates) {
    Mixture<3>& surfaces = model_.surfaces;
    const Eigen::Vector3f mean = Eigen::Vector3d(component.mean).cast<float>();
    auto best = static_cast<std::uint32_t>(surfaces.size());
    double bestSimilarity = params_.hierarchy.similarityMax;
    derived_->index(*this).visitCandidates(
        mean.x(), mean.y(), mean.z(), [&](std::uint32_t j) {
            if (j >= candidates) return;
            const Gaussian<3> mine = surfaces[j];
            if (!sameSide(mine, model_.views[j], view)) return;
            const double kl = similarity(mine, component);
            if (kl >= bestSimilarity) return;
            bestSimilarity = kl;
            best = j;
        });
    if (best == surfaces.size()) {
        surfaces.pushBack(storable(component));
        model_.views.pushBack(view);
    } else {
        const double before = surfaces.support[best];
        surfaces.set(best, storable(mergeMoments(surfaces[best], component)));
        model_.views.set(best, merged(model_.views[best], before, view, component.support));
    }
    derived_->updateSurface(*this, best);
    return best;
}

}  // namespace hgmm
