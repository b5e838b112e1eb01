#include <mrpt/io/CFileGZInputStream.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "commands.h"
#include "load.h"

namespace maptool {
namespace {

/// The first version of the model's buffer with coverage: free space of older ones is a
/// guess.
constexpr std::uint32_t kWithCoverage = 4;
/// Farther away, metres are no longer told apart from one another.
constexpr double kFarthest_m = 1e8;

/// Version of the model's buffer in a map file that can be loaded.
std::uint32_t versionOf(const std::string& file) {
    mrpt::io::CFileGZInputStream stream(file);
    // The options before the buffer are some kilobytes.
    std::string head(std::size_t{1} << 16U, '\0');
    head.resize(stream.Read(head.data(), head.size()));
    const std::string className = "CHGMMOccupancyMap", magic = "HGMM";
    const std::size_t at = head.find(magic, head.find(className) + className.size());
    std::uint32_t version = 0;
    if (at == std::string::npos || at + magic.size() + sizeof(version) > head.size())
        throw std::runtime_error("does not say its version");
    std::memcpy(&version, head.data() + at + magic.size(), sizeof(version));
    return version;
}

/// @tparam D 3 for surfaces, 4 for free space; the first three axes are the place
template <int D>
void checkMixture(const hgmm::Mixture<D>& mixture, const Eigen::Vector3d& origin_map) {
    mixture.check();
    for (int axis = 0; axis < 3; ++axis)
        for (const float mean : mixture.mean[axis])
            if (!(std::abs(origin_map[axis] + static_cast<double>(mean)) < kFarthest_m))
                throw std::runtime_error("has a component farther than 1e8 m away");
}

/// Asks at some of the surfaces.
void checkAnswers(const hgmm::Map& map) {
    const hgmm::Mixture<3>& surfaces = map.mixture();
    constexpr std::size_t most = 1000;
    const std::size_t step = 1 + surfaces.size() / most;
    for (std::size_t i = 0; i < surfaces.size(); i += step) {
        const Eigen::Vector3d mean_local(surfaces.mean[0][i], surfaces.mean[1][i],
                                         surfaces.mean[2][i]);
        const hgmm::Occupancy answer = map.occupancy(map.origin() + mean_local);
        const bool isProbability =
            answer.occupied >= 0.F && answer.free >= 0.F && answer.unknown >= 0.F &&
            std::abs(answer.occupied + answer.free + answer.unknown - 1.F) < 1e-3F;
        if (!isProbability) throw std::runtime_error("gives answers that are none");
    }
}

/// One line of what the map is. Throws what is wrong with it.
std::string describe(const std::string& file) {
    const mrpt::maps::CHGMMOccupancyMap loaded = loadMap(file);
    const hgmm::Map& map = loaded.model();
    const std::uint32_t version = versionOf(file);
    if (version < kWithCoverage)
        throw std::runtime_error(
            file + ": is of format version " + std::to_string(version) +
            ", whose free space is a guess; make it anew from the recording");
    try {
        if (map.empty() && map.coverageBytes() == 0)
            throw std::runtime_error("the map is empty");
        for (std::size_t level = 0; level < map.levelCount(); ++level) {
            checkMixture(map.mixture(level), map.origin());
            checkMixture(map.freeMixture(level), map.origin());
        }
        checkAnswers(map);
    } catch (const std::exception& e) {
        throw std::runtime_error(file + ": " + e.what());
    }
    return file + ": good, format version " + std::to_string(version) + ", " +
           std::to_string(map.mixture().size()) + " components";
}

}  // namespace

bool check(const std::vector<std::string>& mapFiles) {
    bool allGood = true;
    for (const std::string& file : mapFiles) {
        try {
            std::printf("%s\n", describe(file).c_str());
        } catch (const std::exception& e) {
            std::fprintf(stderr, "hgmm-map: %s\n", e.what());
            allGood = false;
        }
    }
    return allGood;
}

}  // namespace maptool
