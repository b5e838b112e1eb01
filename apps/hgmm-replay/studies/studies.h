#pragma once
#include <functional>
#include <string>
#include <vector>

#include "hgmm/evaluation/recording.h"
#include "options.h"

namespace replay {

/// A question that one command answers.
struct Study {
    std::string name;
    std::string text;  ///< what it does, for --list-studies
    /// What it must be given.
    enum class Needs { nothing, scans, posedScans, testPoints, testScans } needs;
    /// For Needs::nothing, `alone` is run instead.
    std::function<void(hgmm::evaluation::Recording&,
                       const hgmm::evaluation::RecordingOptions&, const Options&)>
        run;
    std::function<void(const Options&)> alone;
};

/// All studies, in the order of the thesis.
const std::vector<Study>& studies();

/// Nothing if there is none of that name.
const Study* findStudy(const std::string& name);

/// What --list-studies prints.
std::string studyList();

}  // namespace replay
