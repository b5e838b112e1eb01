#include "hgmm/evaluation/reconstruction.h"

#include <cmath>
#include <nanoflann.hpp>
#include <stdexcept>

#include "hgmm/sampling.h"

namespace hgmm::evaluation {
namespace {

/// The view of a point set that nanoflann asks for.
struct PointSet {
    const Points& points;

    std::size_t kdtree_get_point_count() const { return points.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return points[i][static_cast<Eigen::Index>(axis)];
    }
    template <class Bounds>
    bool kdtree_get_bbox(Bounds&) const {
        return false;
    }
};

using KdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointSet>,
                                        PointSet, 3, std::size_t>;

double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
}

double shareWithin(const std::vector<double>& distances_m, double threshold_m) {
    std::size_t within = 0;
    for (const double d : distances_m) within += d <= threshold_m ? 1 : 0;
    return static_cast<double>(within) / static_cast<double>(distances_m.size());
}

}  // namespace

std::vector<double> nearestDistances(const Points& queries, const Points& targets) {
    if (targets.empty())
        throw std::invalid_argument("nearestDistances: there are no targets");
    const PointSet set{targets};
    const KdTree tree(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    std::vector<double> distances(queries.size());
    const auto n = static_cast<std::ptrdiff_t>(queries.size());
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t i = 0; i < n; ++i) {
        std::size_t nearest = 0;
        double squared = 0.0;
        tree.knnSearch(queries[i].data(), 1, &nearest, &squared);
        distances[i] = std::sqrt(squared);
    }
    return distances;
}

Reconstruction compareSurfaces(const Points& model, const Points& measured,
                               double threshold_m) {
    if (model.empty() || measured.empty())
        throw std::invalid_argument("compareSurfaces: a point set is empty");
    const std::vector<double> fromModel = nearestDistances(model, measured);
    const std::vector<double> fromMeasured = nearestDistances(measured, model);
    Reconstruction r;
    r.accuracy_m = mean(fromModel);
    r.completeness_m = mean(fromMeasured);
    r.chamfer_m = 0.5 * (r.accuracy_m + r.completeness_m);
    r.precision = shareWithin(fromModel, threshold_m);
    r.recall = shareWithin(fromMeasured, threshold_m);
    const double sum = r.precision + r.recall;
    r.f1 = sum > 0.0 ? 2.0 * r.precision * r.recall / sum : 0.0;
    return r;
}

Points sampleSurface(const Mixture<3>& mixture, const Eigen::Vector3d& origin_map,
                     std::size_t n, std::uint64_t seed) {
    const std::vector<float> xyz_local = samplePoints(mixture, n, seed);
    Points points_map(n);
    for (std::size_t i = 0; i < n; ++i)
        points_map[i] = origin_map + Eigen::Vector3d(xyz_local[3 * i], xyz_local[3 * i + 1],
                                                     xyz_local[3 * i + 2]);
    return points_map;
}

}  // namespace hgmm::evaluation
