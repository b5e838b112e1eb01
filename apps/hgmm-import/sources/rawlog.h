#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sources/source.h"

namespace hgmm::importer {

/// The range scans of a rawlog of either format (those that observationToScan knows), with
/// the poses of a file or of the log's odometry: to write them anew with what the log has
/// wrong put right, or in the other format.
class RawlogSource : public Source {
 public:
    /// @param posesFile TUM lines of the robot; if empty, the odometry
    /// @param aperture_deg of 2D scans, from first to last ray [deg]; as they say if not
    /// given
    /// Throws std::runtime_error naming the file if it cannot be read, holds no range scan,
    /// does not say where scans were taken, or has no 2D scan for the aperture.
    RawlogSource(const std::string& file, const std::string& posesFile,
                 std::optional<double> aperture_deg);

    std::size_t size() const override { return scans_.size(); }
    ImportedScan load(std::size_t index) const override;

 private:
    std::vector<ImportedScan> scans_;
};

}  // namespace hgmm::importer
