#include "hgmm/evaluation/modality_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "hgmm/evaluation/split.h"

namespace hgmm::evaluation {
namespace {

const Channel* findChannel(const Scan& scan, const std::string& name) {
    for (const Channel& channel : scan.channels)
        if (channel.name == name) return &channel;
    return nullptr;
}

double meanOf(const std::vector<double>& values, std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += values[i];
    return end > begin ? sum / static_cast<double>(end - begin) : 0.0;
}

/// Squared errors in the order of rising predicted variance.
std::vector<double> errorsByVariance(const std::vector<ModalityEstimate>& estimates,
                                     const std::vector<double>& measured) {
    std::vector<std::size_t> order(estimates.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return estimates[a].variance < estimates[b].variance;
    });
    std::vector<double> errors;
    errors.reserve(order.size());
    for (const std::size_t i : order)
        errors.push_back(std::pow(estimates[i].mean - measured[i], 2));
    return errors;
}

}  // namespace

void appendMeasured(const Scan& scan, const std::vector<std::size_t>& indices,
                    ModalityPoints& points) {
    points.values.resize(points.names.size());
    std::vector<const Channel*> channels;
    for (const std::string& name : points.names) {
        channels.push_back(findChannel(scan, name));
        if (!channels.back()) return;
    }
    for (const std::size_t i : indices) {
        const bool measured = std::all_of(
            channels.begin(), channels.end(),
            [i](const Channel* channel) { return std::isfinite(channel->values[i]); });
        if (!measured) continue;
        const std::size_t before = points.size();
        appendPoints(scan, {i}, points.points_map);
        if (points.size() == before) continue;
        for (std::size_t c = 0; c < channels.size(); ++c)
            points.values[c].push_back(channels[c]->values[i]);
    }
}

void keepShare(Scan& scan, const std::string& channel, double share, std::uint64_t seed,
               std::size_t scanIndex) {
    const auto count =
        static_cast<std::size_t>(std::llround(share * static_cast<double>(scan.size())));
    const std::vector<std::size_t> kept =
        chooseIndices(scan.size(), count, seed, scanIndex, Draw::modality);
    for (Channel& c : scan.channels) {
        if (c.name != channel) continue;
        std::vector<float> values(c.values.size(), std::numeric_limits<float>::quiet_NaN());
        for (const std::size_t i : kept) values[i] = c.values[i];
        c.values = std::move(values);
    }
}

ModalityScore scoreOf(const std::vector<ModalityEstimate>& estimates,
                      const std::vector<double>& measured) {
    if (estimates.size() != measured.size())
        throw std::invalid_argument("scoreOf: as many estimates as values are needed");
    ModalityScore score;
    score.points = measured.size();
    if (measured.empty()) return score;
    const std::size_t n = measured.size(), tenth = std::max<std::size_t>(1, n / 10);
    const double mean = meanOf(measured, 0, n);
    double total = 0.0;
    std::size_t known = 0;
    for (std::size_t i = 0; i < n; ++i) {
        total += std::pow(measured[i] - mean, 2);
        known += estimates[i].known ? 1 : 0;
    }
    const std::vector<double> errors = errorsByVariance(estimates, measured);
    score.knownShare = static_cast<double>(known) / static_cast<double>(n);
    score.mse = meanOf(errors, 0, n);
    const double unexplained = score.mse * static_cast<double>(n);
    score.r2 = total > 0.0 ? 1.0 - unexplained / total : (unexplained > 0.0 ? 0.0 : 1.0);
    score.mseOfSurest = meanOf(errors, 0, tenth);
    score.mseOfLeastSure = meanOf(errors, n - tenth, n);
    return score;
}

}  // namespace hgmm::evaluation
