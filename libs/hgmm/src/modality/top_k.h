#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace hgmm {

/// The components of largest weight of those offered, by falling weight; of equals, the
/// first.
class TopK {
 public:
    /// Candidate places of a prior: bounds the cost of a cross-modal query.
    static constexpr std::size_t kMost = 3;

    void offer(double weight, std::uint32_t component) {
        if (size_ == kMost && !(weight > weights_[kMost - 1])) return;
        std::size_t at = size_ < kMost ? size_++ : kMost - 1;
        for (; at > 0 && weights_[at - 1] < weight; --at) {
            weights_[at] = weights_[at - 1];
            components_[at] = components_[at - 1];
        }
        weights_[at] = weight;
        components_[at] = component;
    }
    const std::uint32_t* begin() const { return components_.data(); }
    const std::uint32_t* end() const { return components_.data() + size_; }

 private:
    std::array<double, kMost> weights_{};
    std::array<std::uint32_t, kMost> components_{};
    std::size_t size_ = 0;
};

}  // namespace hgmm
