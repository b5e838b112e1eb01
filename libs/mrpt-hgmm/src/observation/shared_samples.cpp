#include "observation/shared_samples.h"

#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "observation/recent_observations.h"

namespace hgmm::mrpt_bridge {

namespace {

/// By what the samples of one observation differ.
struct SampleParams {
    MapParams map;
    ReadingParams reading;

    bool operator==(const SampleParams& o) const {
        return map == o.map && reading == o.reading;
    }
};

auto& recentSamples() {
    static RecentObservations<SampleParams, ScanSamples> recent(Digested::whole);
    return recent;
}

}  // namespace

std::shared_ptr<const ScanSamples> sharedSamplesOf(
    const mrpt::obs::CObservation& observation, const MapParams& params,
    const ReadingParams& reading) {
    return recentSamples().get(
        observation, {params, reading}, [&]() -> std::shared_ptr<const ScanSamples> {
            const auto scan =
                observationToScan(observation, std::nullopt, Channels::none, reading);
            if (!scan) return nullptr;
            return std::make_shared<const ScanSamples>(samplesOf(*scan, params));
        });
}

void forgetSharedSamples() {
    recentSamples().forget();
}

}  // namespace hgmm::mrpt_bridge
