#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "base/lazy.h"
#include "index/component_index.h"
#include "modality/modality_group.h"
#include "modality/value_index.h"

namespace hgmm {

struct ModalityGroup::Overall {
    double mean = 0;      ///< [unit of the channel]
    double variance = 0;  ///< [unit squared]
};

/// Components by place, each with the logarithm of its support and normaliser: no component
/// is likelier anywhere.
class ModalityGroup::PlaceIndex {
 public:
    /// Components farther than this from a point say nothing of it [sigma].
    static constexpr float kReachSigmas = 3.F;

    explicit PlaceIndex(const Mixture<3>& places) : components_(kReachSigmas) {
        components_.reserve(places.size());
        logPeak_.reserve(places.size());
        for (std::uint32_t i = 0; i < places.size(); ++i) update(places, i);
    }

    /// Enters or re-enters component i, which must be < size or the next one.
    void update(const Mixture<3>& places, std::uint32_t i) {
        components_.update(places, i);
        if (i == logPeak_.size()) logPeak_.emplace_back();
        logPeak_[i] = std::log(places.support[i]) + components_.factor(i).logNormalizer();
    }

    const ComponentIndex& components() const { return components_; }
    float logPeak(std::uint32_t i) const { return logPeak_[i]; }
    std::size_t liveBytes() const {
        return components_.liveBytes() + logPeak_.capacity() * sizeof(float);
    }

 private:
    ComponentIndex components_;
    std::vector<float> logPeak_;
};

/// What is computed from the components of a group. A copied or loaded group starts without
/// it; the first reader, possibly one of several threads, makes it.
struct ModalityGroup::Cache {
    Lazy<PlaceIndex> index;
    std::array<Lazy<Overall>, kMaxModalities> overall;
    std::array<Lazy<Mixture<4>>, kMaxModalities> base;
    std::array<Lazy<std::vector<Mixture<4>>>, kMaxModalities> upper;
    std::array<Lazy<ValueIndex>, kMaxModalities> byValue;

    /// Follows changes other than those of the index, which is updated.
    void changed() {
        for (auto& lazy : overall) lazy.reset();
        for (auto& lazy : base) lazy.reset();
        for (auto& lazy : upper) lazy.reset();
        for (auto& lazy : byValue) lazy.reset();
    }
};

}  // namespace hgmm
