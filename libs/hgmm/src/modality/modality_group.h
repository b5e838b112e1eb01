#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hgmm/modality.h"
#include "hgmm/scan.h"
#include "modality/channel_mixture.h"

namespace hgmm {

struct HierarchyParams;
struct MapParams;
class ChannelSamples;
class TopK;
class ValueIndex;

/// A value of one of the modalities of a group.
struct ChannelValue {
    int channel = 0;
    double value = 0.0;  ///< [unit of the channel]
};

/// Modalities that were always measured at the same points, as the colours of a camera are:
/// one mixture over (X, Lambda) for each (thesis 5.1), with common places, so that these
/// are found, refined and saved once.
class ModalityGroup {
 public:
    /// @param names one for each channel of `mixture`
    ModalityGroup(std::vector<std::string> names, ChannelMixture mixture);
    ModalityGroup(const ModalityGroup& o);
    ModalityGroup(ModalityGroup&& o) noexcept;
    ModalityGroup& operator=(const ModalityGroup& o);
    ModalityGroup& operator=(ModalityGroup&& o) noexcept;
    ~ModalityGroup();

    const std::vector<std::string>& names() const { return names_; }
    /// In the local frame of the map.
    const ChannelMixture& mixture() const { return mixture_; }
    /// The same with some of the modalities only.
    ModalityGroup withNames(const std::vector<std::string>& names) const;

    /// The components that say something of points of a box.
    ModalityGroup within(const Eigen::AlignedBox3f& box) const;

    /// Learns from one scan: samples near a component are known to it, the others novel.
    /// Known ones are added to their component, novel ones to cells of the lattice; where
    /// the modalities are not linear over one of these, it is split (splitWhereNotLinear).
    /// @param T_local_sensor pose of the sensor, whose frame the samples are in
    void insert(const ChannelSamples& samples, const Pose& T_local_sensor,
                const MapParams& params);
    /// Adds the components of a group of the same names in the same order: each to the most
    /// similar one, or by itself.
    /// @param T_local_other pose of its local frame in this one
    void merge(const ModalityGroup& other, const Pose& T_local_other,
               const MapParams& params);

    /// @name Questions; `point` is in the local frame.
    /// @{
    ModalityEstimate at(int channel, const Eigen::Vector3d& point) const;
    /// Sum of p(Lambda_c = value | x), thesis eq. (5.2), over `n` channels and values: the
    /// score of thesis eq. (5.12) and (5.14) [sum of 1/unit]. Zero where nothing is known.
    double density(const ChannelValue* values, std::size_t n,
                   const Eigen::Vector3d& point) const;
    /// The terms of thesis eq. (5.8) that weigh most at a place: those of the largest
    /// density of place and value.
    TopK likeliest(const ChannelValue& value, const Eigen::Vector3d& point) const;
    /// The mixture over (X, Lambda) of a level < params.levels, 0 being the base.
    const Mixture<4>& level(int channel, std::size_t level,
                            const HierarchyParams& params) const;
    /// Components by the values that they hold.
    const ValueIndex& byValue(int channel) const;
    /// @}

    std::size_t liveBytes() const;
    bool operator==(const ModalityGroup& o) const {
        return names_ == o.names_ && mixture_ == o.mixture_;
    }

 private:
    class PlaceIndex;
    struct Cache;    ///< index, levels, values: built when first needed
    struct Overall;  ///< what all that was measured of a channel has together

    /// Calls visit(k, pi_k phi(x; mu_kX, Sigma_kXX)), unnormalised, for the components
    /// around a point.
    template <typename Visitor>
    void visitAround(const Eigen::Vector3d& point, Visitor&& visit) const;
    /// m_k(x), thesis eq. (5.4).
    double regressed(int channel, std::uint32_t k, const Eigen::Vector3d& point) const;

    const Overall& overall(int channel) const;
    const PlaceIndex& index() const;
    /// The likeliest component within `maxMahalanobis` of each place, or
    /// LinearRegion::kNone.
    std::vector<std::uint32_t> assignKnown(const std::array<std::vector<float>, 3>& means,
                                           double maxMahalanobis) const;
    /// For writers, who are alone.
    PlaceIndex& writableIndex();

    std::vector<std::string> names_;
    ChannelMixture mixture_;
    std::unique_ptr<Cache> cache_;
};

}  // namespace hgmm
