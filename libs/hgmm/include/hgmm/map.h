#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "hgmm/filter.h"
#include "hgmm/map_params.h"
#include "hgmm/mixture.h"
#include "hgmm/scan.h"

namespace hgmm {

/// What one scan did to the map.
struct InsertReport {
    FilterCounts points;
    std::size_t samples = 0;            ///< after the filter
    std::size_t novelSamples = 0;       ///< not explained by the map before this scan
    std::size_t componentsUpdated = 0;  ///< that absorbed known samples
    std::size_t componentsAdded = 0;    ///< for novel samples
};

/// A buffer that Map::load cannot use: truncated, corrupt, foreign, or of a newer version.
class FormatError : public std::runtime_error {
 public:
    using std::runtime_error::runtime_error;
};

/// A hierarchy of Gaussian mixtures over what range sensors saw (thesis chapter 3), updated
/// scan by scan.
///
/// Components are floats in a local frame whose axes are those of the map and whose origin
/// is fixed, on a lattice of whole metres, by the first scan; poses and points cross this
/// interface in double. Const member functions may be called from several threads at once.
class Map {
 public:
    /// Throws std::invalid_argument naming the field that is out of range.
    explicit Map(const MapParams& params = {});
    Map(const Map& o);
    Map(Map&& o) noexcept;
    Map& operator=(const Map& o);
    Map& operator=(Map&& o) noexcept;
    ~Map();

    const MapParams& params() const { return params_; }
    /// For scans inserted from now on. Throws like the constructor.
    void setParams(const MapParams& params);

    /// filter -> novelty split -> { known: update | novel: EM, hierarchy, append }.
    /// Throws std::invalid_argument for a malformed scan (Scan::validate), leaving the map
    /// as it was; a scan without usable points changes nothing.
    InsertReport insert(const Scan& scan);

    bool empty() const { return base_.empty(); }
    void clear();

    /// Origin of the local frame in the map frame [m].
    const Eigen::Vector3d& origin() const { return origin_; }
    /// Number of levels, base included: params().hierarchy.levels.
    std::size_t levelCount() const {
        return static_cast<std::size_t>(params_.hierarchy.levels);
    }
    /// Mixture of a level in the local frame; 0 is the base. Upper levels are brought up to
    /// date here, where the base changed. The reference holds until the next non-const
    /// call. Throws std::out_of_range for a level that does not exist.
    const Mixture<3>& mixture(std::size_t level = 0) const;

    /// log p(point) under the base level [nat], components farther than
    /// ComponentIndex::kSigmas left out: -infinity where there are none within. Throws
    /// nothing.
    double logDensity(const Eigen::Vector3d& point_map) const;

    /// Versioned, little-endian, self-describing; parameters included. Derived data (index,
    /// upper levels) is left out and rebuilt when first needed.
    std::vector<std::uint8_t> save() const;
    /// Throws FormatError.
    static Map load(const std::uint8_t* data, std::size_t size);

    /// Heap held by the map, index and levels included [bytes].
    std::size_t liveBytes() const;

    /// Same parameters, origin and base components, bit for bit.
    bool operator==(const Map& o) const;
    bool operator!=(const Map& o) const { return !(*this == o); }

 private:
    class Derived;  // index and upper levels: rebuilt when first needed, never saved

    MapParams params_;
    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
    Mixture<3> base_;
    std::unique_ptr<Derived> derived_;
};

}  // namespace hgmm
