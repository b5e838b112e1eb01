#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "hgmm/modality.h"
#include "modality/modality_group.h"

namespace hgmm {

/// All modalities of a map. Those that were always measured at the same points, as the
/// colours of a camera are, form a group. A scan with only some of them splits the group.
class Modalities {
 public:
    Modalities() = default;
    Modalities(const Modalities& o);
    Modalities(Modalities&& o) noexcept = default;
    Modalities& operator=(const Modalities& o);
    Modalities& operator=(Modalities&& o) noexcept = default;
    ~Modalities() = default;

    /// Learns the channels of a scan that params.modalities names. Values that are not
    /// finite, or beyond 1e6, count as not measured at their point.
    void insert(const Scan& scan, const Pose& T_local_sensor, const MapParams& params);
    /// Adds what another map knows of params.modalities.
    void merge(const Modalities& other, const Pose& T_local_other, const MapParams& params);
    /// Forgets modalities that params.modalities does not name, and takes over the number
    /// and sizes of levels.
    void configure(const MapParams& params);

    /// What is known of points of a box, in the local frame.
    Modalities within(const Eigen::AlignedBox3f& box) const;

    /// Null if it was never measured.
    const ModalityMap* find(const std::string& name) const;
    const std::vector<ModalityGroup>& groups() const { return groups_; }
    /// For loading.
    void add(ModalityGroup group);

    std::size_t liveBytes() const;
    bool operator==(const Modalities& o) const { return groups_ == o.groups_; }

 private:
    /// `names` by the group that they are in, those in none last.
    std::vector<std::vector<std::string>> parts(
        const std::vector<std::string>& names) const;
    /// Makes `names` a group of its own: new, or taken out of the one that holds them
    /// all.
    ModalityGroup& isolate(const std::vector<std::string>& names);
    void relink();

    std::vector<ModalityGroup> groups_;
    HierarchyParams hierarchy_;
    std::vector<ModalityMap> maps_;  ///< of all names of all groups
};

}  // namespace hgmm
