#include "earlier.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace hgmm::slam_app {

using mrpt::maps::CHGMMOccupancyMap;

std::string earlierMapFile(const Options& options) {
    const std::filesystem::path path(*options.earlier);
    return std::filesystem::is_directory(path) ? (path / "map.hgmm").string()
                                               : path.string();
}

CHGMMOccupancyMap::Ptr loadEarlier(const Options& options) {
    const std::string file = earlierMapFile(options);
    auto map = CHGMMOccupancyMap::Create();
    map->loadFromFile(file);
    if (std::as_const(*map).model().empty())
        throw std::runtime_error(file + ": the map is empty");
    return map;
}

void goOnFrom(const CHGMMOccupancyMap& earlier, SlamRun& run, const Options& options) {
    if (!options.quiet)
        std::fprintf(stderr, "looking for the recording in %s\n",
                     earlierMapFile(options).c_str());
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    run.continuation = run.slam->continueFrom(std::make_shared<const Map>(earlier.model()));
    run.seconds += std::chrono::duration<double>(Clock::now() - start).count();
    const std::vector<Pose> poses = run.slam->trajectory();
    for (std::size_t i = 0; i < poses.size(); ++i)
        run.trajectory[i].T_world_frame = poses[i];
}

std::string notFound(const slam::Continuation& c, const Options& options) {
    const std::string counts =
        std::to_string(c.agreeing) + " of " + std::to_string(c.searched) + " submaps";
    return options.log + ": is not known to be where " + earlierMapFile(options) + " is: " +
           (c.elsewhere > 0 ? counts + " agree on one place there, " +
                                  std::to_string(c.elsewhere) + " on another"
                            : "only " + counts + " agree on a place there") +
           ". Nothing was written; without --continue, it makes a map of its own";
}

}  // namespace hgmm::slam_app
