#pragma once
#include <mrpt/obs/CObservation.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "observation/observation_digest.h"

namespace hgmm::mrpt_bridge {

/// What was made of the last few observations, for all maps of the process: particles put
/// one scan into many maps, which are copies through serialisation and hold nothing in
/// common. An observation is recognised by address, time stamp, sensor pose and a digest of
/// its data, so that one that takes the place of another is not mistaken for it. Memory is
/// bounded. Thread-safe.
/// @tparam Params by what, besides the observation, values differ: compared by ==
template <typename Params, typename Value>
class RecentObservations {
 public:
    explicit RecentObservations(Digested digested) : digested_(digested) {}

    /// The value remembered, or make(), which several threads may call at once. Null is
    /// not remembered.
    template <typename Make>
    std::shared_ptr<const Value> get(const mrpt::obs::CObservation& observation,
                                     const Params& params, Make&& make) {
        return get(observation, digestOf(observation, digested_), params,
                   std::forward<Make>(make));
    }
    /// For callers who know the digest.
    template <typename Make>
    std::shared_ptr<const Value> get(const mrpt::obs::CObservation& observation,
                                     std::uint64_t digest, const Params& params,
                                     Make&& make) {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            for (const Entry& entry : entries_)
                if (entry.value && entry.address == &observation &&
                    entry.digest == digest && entry.params == params)
                    return entry.value;
        }
        std::shared_ptr<const Value> value = make();
        if (!value) return value;
        const std::lock_guard<std::mutex> lock(mutex_);
        entries_[next_] = {&observation, digest, params, value};
        next_ = (next_ + 1) % entries_.size();
        return value;
    }

    void forget() {
        const std::lock_guard<std::mutex> lock(mutex_);
        entries_.fill({});
    }

 private:
    struct Entry {
        const void* address = nullptr;
        std::uint64_t digest = 0;
        Params params{};
        std::shared_ptr<const Value> value;
    };

    const Digested digested_;
    std::mutex mutex_;
    std::array<Entry, 4> entries_;
    std::size_t next_ = 0;  // the oldest
};

}  // namespace hgmm::mrpt_bridge
