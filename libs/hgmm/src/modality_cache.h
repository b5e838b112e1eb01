#pragma once
#include <array>
#include <vector>

#include "hgmm/modality_group.h"
#include "lazy.h"
#include "value_index.h"

namespace hgmm {

struct ModalityGroup::Overall {
    double mean = 0;      ///< [unit of the channel]
    double variance = 0;  ///< [unit squared]
};

/// What is computed from the components of a group. A copied or loaded group starts without
/// it; the first reader, possibly one of several threads, makes it.
struct ModalityGroup::Cache {
    Lazy<ComponentIndex> index;
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
