#include "modality/channel_samples.h"

#include <algorithm>

#include "base/simd.h"
#include "modality/channel_sums.h"
#include "scan/voxel_table.h"

namespace hgmm {

namespace {

/// Sums over the points of a leaf, in floats, four at a time, about the leaf's first point
/// and its first values, so that floats keep their digits. Channels go in blocks of four
/// lanes; the last lane of all is 1, whose moments are those of the places.
template <int J>
struct PointSums {
    static constexpr int kBlocks = (J + 1 + 3) / 4;
    static constexpr int kLast = kBlocks - 1;

    /// Of lanes v.
    struct Block {
        Float4 sum{}, x{}, y{}, z{};  ///< v, v dx, v dy, v dz
        Float4 square{};              ///< v^2
        Float4 first{};               ///< what v is about
    };
    std::array<Block, kBlocks> blocks{};
    std::array<Float4, 3> outer{};  ///< dx d, dy d, dz d with d = (dx, dy, dz, 0)

    float count() const { return blocks[kLast].sum[3]; }

    void add(double dx, double dy, double dz, const std::array<const float*, J>& values,
             std::size_t i) {
        const float x = float(dx), y = float(dy), z = float(dz);
        const bool isFirst = count() == 0.F;
        for (int b = 0; b < kBlocks; ++b) {
            Block& block = blocks[b];
            Float4 v = valuesOf(b, values, i);
            if (isFirst) {
                block.first = v;
                if (b == kLast) block.first[3] = 0.F;
            }
            v -= block.first;
            block.sum += v;
            block.x += v * x;
            block.y += v * y;
            block.z += v * z;
            block.square += v * v;
        }
        const Float4 d = {x, y, z, 0.F};
        outer[0] += d * x;
        outer[1] += d * y;
        outer[2] += d * z;
    }

    /// The layout of ChannelSums, about the leaf's first point.
    void write(int channels, double* v) const {
        const Block& places = blocks[kLast];
        const double n = count(), sums[3] = {places.x[3], places.y[3], places.z[3]};
        *v++ = n;
        for (const double sum : sums) *v++ = sum;
        for (int row = 0; row < 3; ++row)
            for (int col = row; col < 3; ++col) *v++ = outer[row][col];
        for (int c = 0; c < channels; ++c, v += ChannelSums::kChannel) {
            const Block& block = blocks[c / 4];
            const int lane = c % 4;
            const double f = block.first[lane], sum = block.sum[lane];
            v[0] = sum + f * n;
            v[1] = block.square[lane] + f * (2.0 * sum + f * n);
            v[2] = block.x[lane] + f * sums[0];
            v[3] = block.y[lane] + f * sums[1];
            v[4] = block.z[lane] + f * sums[2];
        }
    }

 private:
    static Float4 valuesOf(int block, const std::array<const float*, J>& values,
                           std::size_t i) {
        const auto value = [&](int lane) {
            const int c = 4 * block + lane;
            return c < J ? values[c][i] : 0.F;
        };
        return Float4{value(0), value(1), value(2), block == kLast ? 1.F : value(3)};
    }
};

/// J is at least the number of channels; the last channel fills up.
template <int J>
ChannelSamples filterUpTo(const Scan& scan, const std::vector<const Channel*>& channels,
                          const FilterParams& filter, double noise) {
    std::array<const float*, J> values{};
    for (std::size_t c = 0; c < J; ++c)
        values[c] = channels[std::min(c, channels.size() - 1)]->values.data();
    const auto add = [&values](PointSums<J>& sums, std::size_t i, double dx, double dy,
                               double dz) {
        if (isMeasured(values[0][i])) sums.add(dx, dy, dz, values, i);
    };
    const auto table = leavesOf<PointSums<J>>(scan, filter, add);
    const auto count = static_cast<int>(channels.size());
    ChannelSamples samples(count);
    samples.reserve(table.leaves().size());
    std::array<double, ChannelSums::kMax> sums{};
    for (const auto& leaf : table.leaves()) {
        if (leaf.sums.count() == 0.F) continue;
        leaf.sums.write(count, sums.data());
        samples.pushBack(sums.data(), leaf.anchor, filter, noise);
    }
    return samples;
}

}  // namespace

std::size_t ChannelSamples::stride() const {
    return static_cast<std::size_t>(ChannelSums::sizeFor(channels_));
}

ChannelSamples ChannelSamples::withChannels(const std::vector<int>& channels) const {
    ChannelSamples some(static_cast<int>(channels.size()));
    some.mean_ = mean_;
    for (std::size_t i = 0; i < size(); ++i) {
        const double* v = sums(i);
        some.sums_.insert(some.sums_.end(), v, v + ChannelSums::kPlace);
        for (const int c : channels) {
            const double* channel = v + ChannelSums::sizeFor(c);
            some.sums_.insert(some.sums_.end(), channel, channel + ChannelSums::kChannel);
        }
    }
    return some;
}

void ChannelSamples::reserve(std::size_t n) {
    sums_.reserve(n * stride());
    for (auto& axis : mean_) axis.reserve(n);
}

void ChannelSamples::pushBack(const double* sums, const std::array<float, 3>& anchor,
                              const FilterParams& filter, double channelNoise) {
    const std::size_t first = sums_.size();
    sums_.insert(sums_.end(), sums, sums + stride());
    double* v = sums_.data() + first;
    const double n = v[0];
    const double local[3] = {v[1], v[2], v[3]};
    double range2 = 0;
    for (int d = 0; d < 3; ++d) {
        v[1 + d] += n * anchor[d];
        const double m = v[1 + d] / n;
        mean_[d].push_back(static_cast<float>(m));
        range2 += m * m;
    }
    const double noise = filter.noiseAt(std::sqrt(range2));
    for (int row = 0, k = 4; row < 3; ++row)
        for (int col = row; col < 3; ++col, ++k)
            v[k] += anchor[row] * local[col] + local[row] * anchor[col] +
                    n * anchor[row] * double(anchor[col]) +
                    (row == col ? n * noise * noise : 0.0);
    for (double* c = v + ChannelSums::kPlace; c != v + stride();
         c += ChannelSums::kChannel) {
        for (int d = 0; d < 3; ++d) c[2 + d] += anchor[d] * c[0];
        c[1] += n * channelNoise * channelNoise;
    }
}

ChannelSamples filterChannels(const Scan& scan, const std::vector<const Channel*>& channels,
                              const FilterParams& filter, const ModalityParams& params) {
    FilterParams finer = filter;
    finer.minLeaf_m *= params.modalityLeafAtOneMetre_m / filter.resolution_m;
    finer.resolution_m = params.modalityLeafAtOneMetre_m;
    switch (channels.size()) {
        case 1:
            return filterUpTo<1>(scan, channels, finer, params.modalityNoise);
        case 2:
        case 3:
            return filterUpTo<3>(scan, channels, finer, params.modalityNoise);
        default:
            return filterUpTo<kMaxModalities>(scan, channels, finer, params.modalityNoise);
    }
}

}  // namespace hgmm
