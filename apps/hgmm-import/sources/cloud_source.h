#pragma once
#include <optional>

#include "cloud_observation.h"
#include "sources/source.h"

namespace hgmm::importer {

/// How clouds are to be read.
struct CloudOptions {
    std::optional<double> unitsPerMetre;   ///< of coordinates; otherwise 1, and doubted
    std::optional<double> intensityScale;  ///< otherwise told by the largest value
    CloudChannel channel = CloudChannel::color;
};

/// A recording of point clouds with channels, one file a scan.
class CloudSource : public Source {
 public:
    /// Reads all clouds, for the scales of their channels. Those that cannot be read are
    /// left to load().
    void prepare() override;

 protected:
    explicit CloudSource(const CloudOptions& options);

    /// Cloud number index in the file's own units.
    virtual RecordedCloud readCloud(std::size_t index) const = 0;
    /// The scan of a cloud, without stamp and pose.
    ImportedScan makeScan(RecordedCloud cloud, const Pose& T_frame_sensor) const;
    double unitsPerMetre() const { return options_.unitsPerMetre.value_or(1); }

 private:
    CloudOptions options_;
    ChannelScales scales_;
};

}  // namespace hgmm::importer
