#include "studies/sample_pool.h"

#include <cmath>

namespace replay {

std::size_t SamplePool::CellHash::operator()(const Cell& cell) const {
    std::uint64_t h = 0;
    for (const std::int64_t v : cell)
        h = (h ^ static_cast<std::uint64_t>(v)) * 0x9E3779B97F4A7C15ULL, h ^= h >> 29U;
    return static_cast<std::size_t>(h);
}

void SamplePool::add(const hgmm::Mixture<3>& samples) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
        add(samples[i]);
        while (size() > capacity_) *this = coarser();
    }
}

void SamplePool::add(const hgmm::Gaussian<3>& sample) {
    Cell cell;
    for (int d = 0; d < 3; ++d)
        cell[static_cast<std::size_t>(d)] =
            static_cast<std::int64_t>(std::floor(sample.mean[d] / edge_m_));
    const auto [entry, isNew] = leafOf_.emplace(cell, leaves_.size());
    if (isNew)
        leaves_.push_back(sample);
    else
        leaves_[entry->second] = mergeMoments(leaves_[entry->second], sample);
}

hgmm::Mixture<3> SamplePool::samples() const {
    hgmm::Mixture<3> samples;
    samples.reserve(leaves_.size());
    for (const hgmm::Gaussian<3>& leaf : leaves_) samples.pushBack(leaf);
    return samples;
}

SamplePool SamplePool::coarser() const {
    SamplePool pool(2 * edge_m_, capacity_);
    for (const hgmm::Gaussian<3>& leaf : leaves_) pool.add(leaf);
    return pool;
}

}  // namespace replay
