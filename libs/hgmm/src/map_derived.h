#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "hgmm/clearance.h"
#include "hgmm/contradiction.h"
#include "hgmm/level_blocks.h"
#include "hgmm/map.h"
#include "hgmm/occupancy_model.h"

namespace hgmm {

/// What is computed from the model. A copied or loaded map starts without it; the first
/// reader, const and possibly one of several threads, builds it.
class Map::Derived {
 public:
    /// Components that contain a point, by their 4 sigma ellipsoids.
    const ComponentIndex& index(const Map& map);
    const CoarseGrid& grid(const Map& map);
    const Clearance& clearance(const Map& map);
    double logTotalSupport(const Map& map);
    /// Upper levels, level >= 1.
    const Mixture<3>& mixture(const Map& map, std::size_t level);
    const Views& views(const Map& map, std::size_t level);
    const Mixture<4>& freeMixture(const Map& map, std::size_t level);
    const OccupancyModel& occupancy(const Map& map, std::size_t level);

    /// @name Follow the model's changes. Not for concurrent use.
    /// @{
    void updateSurface(const Map& map, std::uint32_t i);
    void removeSurface(std::uint32_t i);
    void updateFree(const Map& map, std::uint32_t i);
    void removeFree(std::uint32_t i);
    /// After the last of them.
    void finish(const Map& map);
    /// @}

    std::size_t liveBytes() const;

 private:
    struct Level {
        Views views;
        Mixture<4> free;
        std::unique_ptr<OccupancyModel> occupancy;
        bool hasFeatures = false;  ///< views and free are there; upper levels only
        std::atomic<const OccupancyModel*> ready{nullptr};  ///< occupancy, once it is there

        void clear();
    };

    void prepare(const Map& map);
    void enterSurface(const Map& map, std::uint32_t i);
    Level& upperLevel(const Map& map, std::size_t level);

    std::atomic<bool> ready_{false};
    mutable std::mutex mutex_;
    ComponentIndex index_;
    CoarseGrid grid_;
    Clearance clearance_;
    LevelBlocks blocks_;
    std::unique_ptr<Level[]> levels_;
    std::size_t levelCount_ = 0;
    double logTotal_ = 0;
};

}  // namespace hgmm
