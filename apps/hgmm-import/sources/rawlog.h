#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sources/source.h"

namespace hgmm::importer {

/// The 2D range scans of a rawlog of either format, with the poses of a file or of the
/// log's odometry: to write them anew with what the log has wrong put right, or in the
/// other format.
class RawlogSource : public Source {
 public:
    /// @param posesFile TUM lines of the robot; if empty, the odometry
    /// @param aperture_deg of the scans, from first to last ray [deg]; as they say if not
    /// given
    /// Throws std::runtime_error naming the file if it cannot be read, or holds no 2D range
    /// scan with a pose.
    RawlogSource(const std::string& file, const std::string& posesFile,
                 std::optional<double> aperture_deg);

    std::size_t size() const override { return scans_.size(); }
    ImportedScan load(std::size_t index) const override { return scans_.at(index); }

 private:
    std::vector<ImportedScan> scans_;
};

}  // namespace hgmm::importer
