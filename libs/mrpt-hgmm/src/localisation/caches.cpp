#include <mrpt/maps/CHGMMOccupancyMap.h>

#include "localisation/observation_likelihood.h"
#include "localisation/surface_matching.h"

namespace mrpt::maps {

struct CHGMMOccupancyMap::Caches::Impl {
    ::hgmm::mrpt_bridge::ObservationLikelihood likelihood;
    ::hgmm::mrpt_bridge::SurfaceMatching matching;
};

CHGMMOccupancyMap::Caches::Caches() : impl_(std::make_unique<Impl>()) {}
CHGMMOccupancyMap::Caches::Caches(const Caches& o)
    : impl_(std::make_unique<Impl>(*o.impl_)) {}
CHGMMOccupancyMap::Caches& CHGMMOccupancyMap::Caches::operator=(const Caches& o) {
    *impl_ = *o.impl_;
    return *this;
}
CHGMMOccupancyMap::Caches::~Caches() = default;

void CHGMMOccupancyMap::Caches::invalidate() {
    impl_->likelihood.invalidate();
    impl_->matching.invalidate();
}

const ::hgmm::mrpt_bridge::ObservationLikelihood& CHGMMOccupancyMap::Caches::likelihood()
    const {
    return impl_->likelihood;
}

::hgmm::mrpt_bridge::ObservationLikelihood& CHGMMOccupancyMap::Caches::likelihood() {
    return impl_->likelihood;
}

const ::hgmm::mrpt_bridge::SurfaceMatching& CHGMMOccupancyMap::Caches::matching() const {
    return impl_->matching;
}

const ::hgmm::mrpt_bridge::SurfaceMatching& CHGMMOccupancyMap::neighboursSurfaces() const {
    return caches_.matching();
}

}  // namespace mrpt::maps
