#include "options/modality_warnings.h"

#include <algorithm>

#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "options/warnings.h"

namespace hgmm::mrpt_bridge {

namespace {

constexpr std::size_t kSlips = 2;  // edits that a misspelt name has, at most

/// Channels that observations have, as observationToScan names them.
const Names& observedChannels() {
    static const Names channels = {"r", "g", "b", "intensity"};
    return channels;
}

/// Other words for a channel, and what `modalities` calls it.
struct Synonym {
    const char *word, *meant;
};
constexpr Synonym kSynonyms[] = {{"color", "rgb"},
                                 {"colour", "rgb"},
                                 {"colors", "rgb"},
                                 {"rgba", "rgb"},
                                 {"bgr", "rgb"},
                                 {"red", "r"},
                                 {"green", "g"},
                                 {"blue", "b"},
                                 {"reflectivity", "intensity"},
                                 {"reflectance", "intensity"},
                                 {"remission", "intensity"},
                                 {"i", "intensity"}};

/// What a name probably means; empty if nothing is near.
std::string meantBy(const std::string& name) {
    for (const Synonym& synonym : kSynonyms)
        if (equalsIgnoringCase(name, synonym.word)) return synonym.meant;
    const std::string& nearest = nearestName(name, observedChannels());
    const bool isNear = editDistance(name, nearest) <= kSlips;
    return isNear && (nearest.size() > kSlips || equalsIgnoringCase(name, nearest))
               ? nearest
               : "";
}

bool contains(const Names& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

void warnOfForeignModalities(const Names& modalities, const std::string& section) {
    for (const std::string& name : modalities) {
        if (contains(observedChannels(), name)) continue;
        const std::string meant = meantBy(name);
        warn("[" + section + "] modalities: no observation of MRPT has a channel '" + name +
             "', they have " + listed(observedChannels()) +
             (meant.empty() ? "" : "; did you mean '" + meant + "'?"));
    }
}

void warnOfAbsentModalities(const Map& map, const Scan& scan) {
    const Names& wanted = map.params().modalities;
    if (wanted.empty() || scan.channels.empty()) return;
    Names there;
    for (const auto& channel : scan.channels) there.push_back(channel.name);
    for (const std::string& name : wanted) {
        const ModalityMap* known = map.modality(name);
        if (contains(there, name) || (known && known->size() > 0)) return;
    }
    warn("modalities: a scan has no channel " + listed(wanted) + "; it has " +
         listed(there));
}

void settleIntensityScale(const mrpt::obs::CObservation& observation,
                          ReadingParams& reading) {
    if (reading.intensityScale != 0.0) return;
    const std::optional<double> scale = intensityScaleOf(observation);
    if (!scale) return;
    reading.intensityScale = *scale;
    if (*scale != 1.0)
        warn("intensities are divided by " + numberText(*scale) +
             ", as the first scan tells; set intensityScale if that is wrong");
}

}  // namespace hgmm::mrpt_bridge
