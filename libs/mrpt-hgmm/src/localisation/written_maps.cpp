#include "localisation/written_maps.h"

namespace hgmm::mrpt_bridge {

WrittenMaps& WrittenMaps::ofProcess() {
    static WrittenMaps written;
    return written;
}

void WrittenMaps::remember(std::uint64_t digest,
                           const ObservationLikelihood::Heritage& heritage) {
    const std::lock_guard<std::mutex> lock(mutex_);
    written_[next_] = {std::this_thread::get_id(), digest, heritage};
    next_ = (next_ + 1) % written_.size();
}

std::optional<ObservationLikelihood::Heritage> WrittenMaps::heritageOf(
    std::uint64_t digest) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t k = 1; k <= written_.size(); ++k) {
        const Written& w = written_[(next_ + written_.size() - k) % written_.size()];
        if (w.digest == digest && w.thread == std::this_thread::get_id()) return w.heritage;
    }
    return std::nullopt;
}

}  // namespace hgmm::mrpt_bridge
