#include "import_tally.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <stdexcept>

#include "hgmm/mrpt_bridge/observation_to_scan.h"

namespace hgmm::importer {
namespace {

constexpr std::size_t kRangesOfAScan = 200;
constexpr std::size_t kWarnings = 5;

void addNew(const std::vector<std::string>& names, std::vector<std::string>& all) {
    for (const auto& name : names)
        if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "" : " ") + name;
    return text;
}

std::string metres(double length_m) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3g m", length_m);
    return text;
}

}  // namespace

void ImportTally::add(const ImportedScan& scan) {
    ++scans_;
    droppedPoints_ += scan.droppedPoints;
    addNew(scan.usedFields, used_);
    addNew(scan.unusedFields, unused_);
    addRanges(*scan.observation);
}

void ImportTally::addRanges(const mrpt::obs::CObservation& observation) {
    const auto points = mrpt_bridge::observationToScan(observation, std::nullopt,
                                                       mrpt_bridge::Channels::none);
    if (!points) return;
    const std::size_t stride = points->size() / kRangesOfAScan + 1;
    for (std::size_t i = 0; i < points->size(); i += stride)
        ranges_m_.push_back(std::hypot(points->x[i], points->y[i], points->z[i]));
}

void ImportTally::addDamaged(const std::string& problem) {
    if (damaged_++ == 0) firstProblem_ = problem;
    if (damaged_ <= kWarnings)
        std::cerr << "warning: " << problem << "; the scan is skipped\n";
}

std::optional<double> ImportTally::medianRange_m() const {
    if (ranges_m_.empty()) return std::nullopt;
    auto sorted = ranges_m_;
    const auto middle = sorted.begin() + static_cast<long>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
}

void ImportTally::check(const ExpectedRange& expected) const {
    if (scans_ == 0) throw std::runtime_error(firstProblem_);
    const auto median_m = medianRange_m();
    if (!median_m) return;
    const std::string text = "the median range is " + metres(*median_m) + "; ";
    if (*median_m < expected.possibleLeast_m || *median_m > expected.possibleMost_m)
        throw std::runtime_error(text + expected.advice);
    if (*median_m < expected.usualLeast_m || *median_m > expected.usualMost_m)
        std::cerr << "warning: " << text << expected.advice << "\n";
}

std::string ImportTally::describe(const SourceSummary& summary) const {
    std::string text;
    if (!summary.order.empty()) text += "; order " + summary.order;
    if (!used_.empty()) text += "; fields used " + joined(used_);
    if (!unused_.empty()) text += "; fields not used " + joined(unused_);
    if (!summary.scale.empty()) text += "; scale " + summary.scale;
    if (const auto median_m = medianRange_m())
        text += "; median range " + metres(*median_m);
    if (droppedPoints_ > 0)
        text += "; left out " + std::to_string(droppedPoints_) + " points without a return";
    const std::size_t skipped = damaged_ + summary.withoutPose;
    if (skipped > 0)
        text += "; skipped " + std::to_string(skipped) + " scans (" +
                std::to_string(damaged_) + " unreadable, " +
                std::to_string(summary.withoutPose) + " without a pose)";
    return text;
}

}  // namespace hgmm::importer
