#include "index/component_index.h"

#include <cmath>
#include <stdexcept>

#include "base/growth.h"

namespace hgmm {

BoxCells::Box ComponentIndex::boxOf(const Gaussian<3>& inflated) const {
    BoxCells::Box box;
    for (int d = 0; d < 3; ++d) {
        box.centre[d] = static_cast<float>(inflated.mean[d]);
        box.halfExtent[d] =
            sigmas_ * static_cast<float>(std::sqrt(inflated.covariance(d, d)));
    }
    return box;
}

bool ComponentIndex::reaches(const Gaussian<3>& component,
                             const Eigen::AlignedBox3f& box) const {
    Gaussian<3> inflated = component;
    inflated.covariance.diagonal().array() += inflationVariance_;
    return BoxCells::of(boxOf(inflated)).meet(box.min().data(), box.max().data());
}

void ComponentIndex::update(const Mixture<3>& mixture, std::uint32_t i) {
    if (i > factors_.size())
        throw std::out_of_range("ComponentIndex::update: a gap before it");
    Gaussian<3> g = mixture[i];
    g.covariance.diagonal().array() += inflationVariance_;
    if (i == factors_.size()) {
        growTo(factors_, i + std::size_t{1});
        boxes_.add(boxOf(g));
    } else {
        boxes_.update(i, boxOf(g), centreOf(i));
    }
    factors_[i] = Factor(g);
}

void ComponentIndex::rebuild(const Mixture<3>& mixture) {
    clear();
    reserve(mixture.size());
    for (std::uint32_t i = 0; i < mixture.size(); ++i) update(mixture, i);
}

void ComponentIndex::truncate(std::size_t n) {
    boxes_.truncate(n, [this](std::uint32_t i) { return centreOf(i); });
    if (factors_.size() > n) factors_.resize(n);
}

void ComponentIndex::reserve(std::size_t n) {
    factors_.reserve(n);
    boxes_.reserve(n);
}

void ComponentIndex::clear() {
    factors_.clear();
    boxes_.clear();
}

std::size_t ComponentIndex::liveBytes() const {
    return factors_.capacity() * sizeof(Factor) + boxes_.liveBytes();
}

}  // namespace hgmm
