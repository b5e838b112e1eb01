#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hgmm/evaluation/pose_landscape.h"
#include "hgmm/evaluation/recording.h"
#include "hgmm/params.h"
#include "hgmm/scan.h"

namespace hgmm::evaluation {

/// Finds the pose of one scan in another.
class Aligner {
 public:
    virtual ~Aligner() = default;
    virtual std::string name() const = 0;
    /// Makes a scan ready to be aligned with; its T_map_sensor is right.
    virtual void setTarget(const Scan& target) = 0;
    /// Makes the scan ready that is to be aligned; its T_map_sensor must not be used.
    virtual void setSource(const Scan& source) = 0;
    /// T_map_sensor of the source.
    virtual Pose align(const Pose& T_map_sensor_guess) const = 0;
};

/// Ours: RegistrationTarget of a map of the target, with the samples (filterScan) of the
/// source.
std::unique_ptr<Aligner> makeMixtureAligner(const MapParams& params);

/// Pairs of scans i, i + gap, evenly over a recording.
struct RegistrationTrials {
    std::size_t gap = 5;        ///< [scans], >= 1
    std::size_t maxPairs = 40;  ///< [count], >= 1
    int guessesPerPair = 3;     ///< [count], >= 1
    double off_m = 0.5;         ///< of each guess, in a random direction
    double off_deg = 10.0;      ///< likewise
    double success_m = 0.1;     ///< an alignment that ends as near as this to the
    double success_deg = 1.0;   ///< recording's pose has succeeded
    std::uint64_t seed = 1;
};

/// The defaults; for lidars, whose scans are sparser, success is 0.3 m.
/// @param sensor class of the observations (Recording::sensor)
RegistrationTrials trialsFor(const std::string& sensor, std::uint64_t seed);

/// What an aligner did.
struct AlignerFigures {
    std::string name;
    std::vector<PoseError> errors;   ///< of each guess
    std::vector<double> prepare_ms;  ///< of each pair; processor time of all threads
    std::vector<double> align_ms;    ///< of each guess; likewise
};

/// Lets all aligners have the same pairs and guesses. Scans without points are left out.
std::vector<AlignerFigures> runTrials(Recording& recording,
                                      const std::vector<std::unique_ptr<Aligner>>& aligners,
                                      const RegistrationTrials& trials);

/// Share of successes, median errors and times, a line each.
std::string trialsTable(const std::vector<AlignerFigures>& figures,
                        const RegistrationTrials& trials);

}  // namespace hgmm::evaluation
