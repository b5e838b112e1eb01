#include "observation/shared_samples.h"

#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "observation/recent_observations.h"

namespace hgmm::mrpt_bridge {

namespace {

auto& recentSamples() {
    static RecentObservations<MapParams, ScanSamples> recent(Digested::whole);
    return recent;
}

}  // namespace

std::shared_ptr<const ScanSamples> sharedSamplesOf(
    const mrpt::obs::CObservation& observation, const MapParams& params) {
    return recentSamples().get(
        observation, params, [&]() -> std::shared_ptr<const ScanSamples> {
            const auto scan = observationToScan(observation, std::nullopt, Channels::none);
            if (!scan) return nullptr;
            return std::make_shared<const ScanSamples>(samplesOf(*scan, params));
        });
}

void forgetSharedSamples() {
    recentSamples().forget();
}

}  // namespace hgmm::mrpt_bridge
