#pragma once
#include <mrpt/maps/CSimpleMap.h>

#include <utility>
#include <vector>

#include "sources/source.h"

namespace hgmm::importer {

/// A simple map of MRPT (*.simplemap, *.simplemap.gz): the scans of its frames, with the
/// means of their poses. Stamps are those of the observations, or kDefaultPosePeriod apart
/// where some have none or they do not rise.
class SimpleMapSource : public Source {
 public:
    /// Throws std::runtime_error naming the file if it cannot be read or holds no scan.
    explicit SimpleMapSource(const std::string& file);

    std::size_t size() const override { return scans_.size(); }
    ImportedScan load(std::size_t index) const override { return scans_.at(index); }

 private:
    void readStamps();

    std::vector<ImportedScan> scans_;
};

}  // namespace hgmm::importer
