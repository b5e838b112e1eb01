#include <algorithm>

#include "hgmm/evaluation/split.h"
#include "hgmm/evaluation/unseen_points.h"

namespace hgmm::evaluation {
namespace {

/// Draws until there are enough points that count, or tries are used up.
template <class Draw>
Points drawUnseen(const SeenCells& cells, const Draw& draw) {
    Points points_map;
    for (std::size_t tries = 0;
         tries < 20 * UnseenPoints::kOfEach && points_map.size() < UnseenPoints::kOfEach;
         ++tries) {
        const Eigen::Vector3d p_map = draw();
        if (cells.isUnseen(p_map)) points_map.push_back(p_map);
    }
    return points_map;
}

template <class IsSo>
std::size_t numberThat(const std::vector<Occupancy>& answers, const IsSo& isSo) {
    return static_cast<std::size_t>(std::count_if(answers.begin(), answers.end(), isSo));
}

double ratio(std::size_t part, std::size_t all) {
    return all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

void SeenSpace::add(const Scan& scan, std::size_t scanIndex) {
    if (!cells_ && scan.size() > 0) cells_.emplace(seenCellEdge_m(scan));
    if (!cells_) return;
    cells_->add(scan);
    const Pose& T = scan.T_map_sensor;
    for (const std::size_t i :
         chooseIndices(scan.size(), kRaysPerScan, seed_, scanIndex, Draw::unseen)) {
        const Eigen::Vector3d p_sensor(scan.x[i], scan.y[i], scan.z[i]);
        if (p_sensor.allFinite() && !p_sensor.isZero())
            rays_.push_back({T.t, T.R * p_sensor + T.t});
    }
}

UnseenPoints SeenSpace::draw(const FreeBand& free) const {
    UnseenPoints points;
    if (rays_.empty()) return points;
    points.edge_m = cells_->edge_m();
    std::mt19937_64 stream = randomStream(seed_, rays_.size(), Draw::unseen);
    const auto anyRay = [&] {
        const double share = nextUniform(stream);
        return rays_[static_cast<std::size_t>(share * static_cast<double>(rays_.size()))];
    };
    points.behindHits_map = drawUnseen(*cells_, [&]() -> Eigen::Vector3d {
        const Ray ray = anyRay();
        const double least_m = UnseenPoints::kBehind_m[0];
        const double behind_m =
            least_m + nextUniform(stream) * (UnseenPoints::kBehind_m[1] - least_m);
        return ray.hit_map + behind_m * (ray.hit_map - ray.origin_map).normalized();
    });
    Points hits_map;
    for (const Ray& ray : rays_) hits_map.push_back(ray.hit_map);
    const Box box = boundingBox(hits_map);
    points.inBox_map = drawUnseen(*cells_, [&] {
        Eigen::Vector3d p_map;
        for (int axis = 0; axis < 3; ++axis)
            p_map[axis] =
                box.low[axis] + nextUniform(stream) * (box.high[axis] - box.low[axis]);
        return p_map;
    });
    for (std::size_t i = 0; i < UnseenPoints::kOfEach; ++i) {
        const Ray ray = anyRay();
        const Eigen::Vector3d along = ray.hit_map - ray.origin_map;
        if (const auto range_m = rangeIn(free, along.norm(), nextUniform(stream)))
            points.free_map.push_back(ray.origin_map + *range_m * along.normalized());
    }
    return points;
}

OccupancyQuery occupancyQueryOf(const Map& map) {
    return [&map](const Points& points_map) {
        std::vector<Occupancy> answers(points_map.size());
        map.occupancy(points_map.data(), points_map.size(), answers.data());
        return answers;
    };
}

Occupancy occupancyOfAnswer(const Answer& answer) {
    Occupancy occupancy;
    if (answer.unknown) return occupancy;
    occupancy.occupied = static_cast<float>(answer.probability);
    occupancy.free = 1.0F - occupancy.occupied;
    occupancy.unknown = 0.0F;
    return occupancy;
}

UnseenFigures evaluateUnseen(const OccupancyQuery& query, const UnseenPoints& points) {
    const auto isFree = [](const Occupancy& o) { return o.free > 0.5F; };
    const auto isOccupied = [](const Occupancy& o) { return o.occupied > 0.5F; };
    const std::vector<Occupancy> behind = query(points.behindHits_map);
    const std::vector<Occupancy> inBox = query(points.inBox_map);
    const std::vector<Occupancy> free = query(points.free_map);
    UnseenFigures f;
    f.behindHits = behind.size();
    f.inBox = inBox.size();
    f.free = free.size();
    f.calledFreeBehindHits = ratio(numberThat(behind, isFree), f.behindHits);
    f.calledFreeInBox = ratio(numberThat(inBox, isFree), f.inBox);
    const std::size_t all = f.behindHits + f.inBox;
    f.calledOccupied =
        ratio(numberThat(behind, isOccupied) + numberThat(inBox, isOccupied), all);
    double unknown = 0.0;
    for (const auto* answers : {&behind, &inBox})
        for (const Occupancy& o : *answers) unknown += o.unknown;
    f.meanUnknown = all == 0 ? 0.0 : unknown / static_cast<double>(all);
    f.seenCalledUnknown = ratio(
        numberThat(free, [](const Occupancy& o) { return o.unknown > 0.5F; }), f.free);
    return f;
}

}  // namespace hgmm::evaluation
