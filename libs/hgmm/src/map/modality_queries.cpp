#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hgmm/map.h"
#include "map/model.h"
#include "modality/cross_modal.h"

namespace hgmm {

namespace {

/// Points handled by one task.
constexpr std::size_t kPointsPerTask = 256;

void requireModelled(const std::string& name, const std::vector<std::string>& modalities) {
    if (std::find(modalities.begin(), modalities.end(), name) != modalities.end()) return;
    std::string known;
    for (const std::string& other : modalities)
        known += (known.empty() ? "" : ", ") + other;
    throw std::invalid_argument("Map: no modality '" + name + "', it models " +
                                (known.empty() ? "none" : known));
}

}  // namespace

const std::vector<std::string>& Map::modalities() const {
    return params().modalities;
}

const ModalityMap* Map::modality(const std::string& name) const {
    return state_->model.modalities.find(name);
}

ModalityEstimate Map::modality(const std::string& name,
                               const Eigen::Vector3d& point_map) const {
    ModalityEstimate answer;
    modality(name, &point_map, 1, &answer);
    return answer;
}

void Map::modality(const std::string& name, const Eigen::Vector3d* points_map,
                   std::size_t n, ModalityEstimate* answers) const {
    requireModelled(name, modalities());
    const ModalityMap* map = modality(name);
    if (map == nullptr) {
        std::fill(answers, answers + n, ModalityEstimate{});
        return;
    }
    const auto tasks =
        static_cast<std::ptrdiff_t>((n + kPointsPerTask - 1) / kPointsPerTask);
#pragma omp parallel for schedule(dynamic) if (tasks > 1)
    for (std::ptrdiff_t task = 0; task < tasks; ++task) {
        const std::size_t first = static_cast<std::size_t>(task) * kPointsPerTask;
        for (std::size_t i = first; i < std::min(n, first + kPointsPerTask); ++i)
            answers[i] = map->at(points_map[i] - origin());
    }
}

CrossModalEstimate Map::infer(const std::string& target,
                              const std::vector<ModalityValue>& priors,
                              const std::optional<Eigen::Vector3d>& point_map) const {
    requireModelled(target, modalities());
    if (priors.empty()) throw std::invalid_argument("Map::infer: needs a prior");
    if (point_map && !point_map->allFinite())
        throw std::invalid_argument("Map::infer: the point is not finite");
    std::vector<Prior> known;
    for (const ModalityValue& prior : priors) {
        requireModelled(prior.name, modalities());
        if (!std::isfinite(prior.value))
            throw std::invalid_argument("Map::infer: the value of '" + prior.name +
                                        "' is not finite");
        if (const ModalityMap* map = modality(prior.name))
            known.push_back({map, prior.value});
    }
    const ModalityMap* map = modality(target);
    if (map == nullptr || known.empty()) return {};
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    if (point_map) point = *point_map - origin();
    CrossModalEstimate estimate = inferModality(*map, known, point_map ? &point : nullptr);
    if (estimate.known) {
        estimate.place_map += origin();
    } else if (point_map) {
        const ModalityEstimate there = map->at(point);
        estimate.mean = there.mean;
        estimate.variance = there.variance;
    }
    return estimate;
}

}  // namespace hgmm
