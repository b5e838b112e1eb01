#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>

#include "localisation/observation_likelihood.h"

namespace hgmm::mrpt_bridge {

/// What the maps that were last written to archives hand on, by the digest of the bytes:
/// MRPT copies maps through archives, and a copy is of the family of its original. Memory
/// is bounded. Thread-safe.
class WrittenMaps {
 public:
    static WrittenMaps& ofProcess();

    void remember(std::uint64_t digest, const ObservationLikelihood::Heritage& heritage);
    /// Of a map that this thread wrote.
    std::optional<ObservationLikelihood::Heritage> heritageOf(std::uint64_t digest);

 private:
    struct Written {
        std::thread::id thread;
        std::uint64_t digest = 0;
        ObservationLikelihood::Heritage heritage;
    };

    std::mutex mutex_;
    std::array<Written, 16> written_;
    std::size_t next_ = 0;  ///< the oldest
};

}  // namespace hgmm::mrpt_bridge
