#include "studies/modality_evaluation.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <random>
#include <utility>

#include "hgmm/evaluation/split.h"

namespace replay {

using namespace hgmm::evaluation;

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kInferences = 5000;  // at most

/// The values of all modalities but one at a point.
std::vector<hgmm::ModalityValue> othersAt(const ModalityPoints& points, std::size_t target,
                                          std::size_t i) {
    std::vector<hgmm::ModalityValue> values;
    for (std::size_t c = 0; c < points.names.size(); ++c)
        if (c != target) values.push_back({points.names[c], points.values[c][i]});
    return values;
}

}  // namespace

ModalityEstimates estimatesAt(const hgmm::Map& map, const ModalityPoints& points) {
    ModalityEstimates estimates;
    for (const std::string& name : points.names) {
        estimates.emplace_back(points.size());
        map.modality(name, points.points_map.data(), points.size(),
                     estimates.back().data());
    }
    return estimates;
}

hgmm::Map savedAndLoaded(const hgmm::Map& map) {
    const std::vector<std::uint8_t> bytes = map.save();
    return hgmm::Map::load(bytes.data(), bytes.size());
}

ModalityMapResult evaluateModalities(const hgmm::Map& map, const ModalityPoints& test,
                                     const ModalityEstimates& estimates) {
    ModalityMapResult result;
    result.mapBytes = map.save().size();
    for (std::size_t i = 0; i < test.names.size(); ++i) {
        ModalityResult of;
        of.name = test.names[i];
        of.score = scoreOf(estimates[i], test.values[i]);
        if (const hgmm::ModalityMap* modality = map.modality(of.name)) {
            of.components = modality->size();
            of.bytes = modality->savedBytes();
        }
        result.modalityBytes += of.bytes;
        result.modalities.push_back(of);
    }
    return result;
}

CrossModalResult inferAt(const hgmm::Map& map, const ModalityPoints& test,
                         std::size_t target) {
    const std::size_t n = std::min(kInferences, test.size());
    const std::string& name = test.names[target];
    std::vector<hgmm::ModalityEstimate> inferred(n), regressed(n);
    std::vector<double> measured(n);
    map.infer(name, othersAt(test, target, 0), test.points_map[0]);  // builds the index
    const Clock::time_point start = Clock::now();
    for (std::size_t i = 0; i < n; ++i) {
        const hgmm::CrossModalEstimate answer =
            map.infer(name, othersAt(test, target, i), test.points_map[i]);
        inferred[i] = {answer.mean, answer.variance, answer.known};
    }
    const std::chrono::duration<double, std::micro> taken = Clock::now() - start;
    map.modality(name, test.points_map.data(), n, regressed.data());
    std::copy_n(test.values[target].begin(), n, measured.begin());
    return {name, scoreOf(inferred, measured).r2, scoreOf(regressed, measured).r2,
            taken.count() / static_cast<double>(n)};
}

ModalityPoints shuffled(const ModalityPoints& points, std::uint64_t seed) {
    std::mt19937_64 stream = randomStream(seed, 0, Draw::modalityQueries);
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = order.size(); i > 1; --i)
        std::swap(order[i - 1],
                  order[static_cast<std::size_t>(nextUniform(stream) * double(i))]);
    ModalityPoints result{points.names, {}, {}};
    for (const std::size_t i : order) result.points_map.push_back(points.points_map[i]);
    for (const std::vector<double>& values : points.values) {
        result.values.emplace_back();
        for (const std::size_t i : order) result.values.back().push_back(values[i]);
    }
    return result;
}

}  // namespace replay
