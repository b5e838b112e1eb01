#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "hgmm/map.h"

namespace hgmm::testing {

/// What a channel shows at (y, z) of a wall.
using Painting = std::function<double(double y, double z)>;

/// A wall 2 m in front of the sensor, 1.2 m x 0.8 m, seen by `columns` x `rows` rays with
/// range noise; y and z are across it, from -0.6 to 0.6 and from -0.4 to 0.4.
inline Scan paintedWall(const std::vector<std::pair<std::string, Painting>>& channels,
                        std::uint64_t seed = 1, int columns = 240, int rows = 160) {
    std::mt19937_64 random(seed);
    std::normal_distribution<float> noise(0.F, 0.003F);
    Scan scan;
    for (const auto& channel : channels) scan.channels.push_back({channel.first, {}});
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double y = -0.6 + 1.2 * (column + 0.5) / columns;
            const double z = -0.4 + 0.8 * (row + 0.5) / rows;
            scan.pushBack(2.F + noise(random), static_cast<float>(y),
                          static_cast<float>(z));
            for (std::size_t c = 0; c < channels.size(); ++c)
                scan.channels[c].values.push_back(
                    static_cast<float>(channels[c].second(y, z)));
        }
    return scan;
}

/// Models these channels, finer than by default.
inline MapParams modelling(const std::vector<std::string>& names) {
    MapParams params;
    params.modality.modalityUnexplained = 0.02;
    params.modalities = names;
    return params;
}

inline Map mapOf(const Scan& scan, const std::vector<std::string>& names) {
    Map map(modelling(names));
    map.insert(scan);
    return map;
}

/// A channel that is the same everywhere.
inline Painting plain(double value) {
    return [value](double, double) { return value; };
}

/// Patches side by side along y, of equal width.
inline Painting patches(std::vector<double> values) {
    return [values](double y, double) {
        const auto n = static_cast<double>(values.size());
        const double at = std::min(std::max((y + 0.6) / 1.2 * n, 0.0), n - 1);
        return values[static_cast<std::size_t>(at)];
    };
}

}  // namespace hgmm::testing
