#pragma once
#include "hgmm/evaluation/recording.h"
#include "options.h"

namespace replay {

/// Whether the likelihood of the test scans leads to the poses that they were taken from:
/// where its maximum lies within +-0.3 m and +-5 deg, and where hill climbing ends that
/// starts 0.3 m and 5 deg away. Recordings of planar lasers are searched in x, y and yaw,
/// others in all six dimensions. The likelihood is that of a converged filter, unless the
/// configuration fixes its kernel. Prints shares and medians and, with a report folder,
/// writes each scan's figures to landscape.csv. Throws std::runtime_error naming the
/// recording if no scan was left to build a map from, or to test.
void landscapeStudy(hgmm::evaluation::Recording& recording,
                    const hgmm::evaluation::RecordingOptions& recordingOptions,
                    const Options& options);

/// The same, each test scan in a map of its own: of the three scans before and the three
/// after it, of which others may be test scans. Poses that drift agree so far, but not over
/// a whole recording, and a maximum cannot be nearer to them than they are to each other.
void localLandscapeStudy(hgmm::evaluation::Recording& recording, const Options& options);

}  // namespace replay
