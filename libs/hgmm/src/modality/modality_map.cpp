#include "hgmm/modality.h"

#include <stdexcept>

#include "modality/modality_group.h"

namespace hgmm {

ModalityMap::ModalityMap(const ModalityGroup& group, int channel,
                         const HierarchyParams& hierarchy)
    : group_(&group), channel_(channel), hierarchy_(hierarchy) {}

const std::string& ModalityMap::name() const {
    return group_->names()[static_cast<std::size_t>(channel_)];
}

std::size_t ModalityMap::size() const {
    return group_->mixture().size();
}

const Mixture<4>& ModalityMap::mixture(std::size_t level) const {
    if (level >= static_cast<std::size_t>(hierarchy_.levels))
        throw std::out_of_range("ModalityMap: no level " + std::to_string(level) +
                                ", only 0 to " + std::to_string(hierarchy_.levels - 1));
    return group_->level(channel_, level, hierarchy_);
}

ModalityEstimate ModalityMap::at(const Eigen::Vector3d& point) const {
    return group_->at(channel_, point);
}

double ModalityMap::density(double value, const Eigen::Vector3d& point) const {
    const ChannelValue asked{channel_, value};
    return group_->density(&asked, 1, point);
}

}  // namespace hgmm
