#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sources/source.h"

namespace hgmm::importer {

/// What an import did, scan by scan, for the line that closes it.
class ImportTally {
 public:
    void add(const ImportedScan& scan);
    /// Counts a scan that cannot be read, and warns of the first ones.
    void addDamaged(const std::string& problem);

    std::size_t scans() const { return scans_; }
    /// Throws std::runtime_error if there are no scans, or if their median range is not
    /// possible; warns if it is not usual.
    void check(const ExpectedRange& expected) const;
    /// "; order ...; fields ..." and so on.
    std::string describe(const SourceSummary& summary) const;

 private:
    void addRanges(const mrpt::obs::CObservation& observation);
    std::optional<double> medianRange_m() const;

    std::size_t scans_ = 0, damaged_ = 0, droppedPoints_ = 0;
    std::string firstProblem_;
    std::vector<std::string> used_, unused_;  ///< names of fields, each once
    std::vector<float> ranges_m_;             ///< a sample of all scans'
};

}  // namespace hgmm::importer
