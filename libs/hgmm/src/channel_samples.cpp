#include "channel_samples.h"

#include "channel_sums.h"
#include "leaf_table.h"

namespace hgmm {

namespace {

/// ChannelSums of a number of channels known when compiling, for the inner loop.
template <int J>
struct PointSums {
    std::array<double, ChannelSums::kPlace + ChannelSums::kChannel * J> v{};

    void add(double dx, double dy, double dz, const std::array<const float*, J>& values,
             std::size_t i) {
        v[0] += 1;
        v[1] += dx, v[2] += dy, v[3] += dz;
        v[4] += dx * dx, v[5] += dx * dy, v[6] += dx * dz;
        v[7] += dy * dy, v[8] += dy * dz, v[9] += dz * dz;
        double* at = v.data() + ChannelSums::kPlace;
        for (int c = 0; c < J; ++c, at += ChannelSums::kChannel) {
            const double l = values[c][i];
            at[0] += l, at[1] += l * l;
            at[2] += dx * l, at[3] += dy * l, at[4] += dz * l;
        }
    }
};

/// J is at least the number of channels; the last channel fills up.
template <int J>
ChannelSamples filterUpTo(const Scan& scan, const std::vector<const Channel*>& channels,
                          const FilterParams& filter, double noise) {
    std::array<const float*, J> values{};
    for (std::size_t c = 0; c < J; ++c)
        values[c] = channels[std::min(c, channels.size() - 1)]->values.data();
    FilterCounts counted;
    const auto table = sumLeaves<PointSums<J>>(
        scan, filter, counted,
        [&values](PointSums<J>& sums, std::size_t i, double dx, double dy, double dz) {
            if (isMeasured(values[0][i])) sums.add(dx, dy, dz, values, i);
        });
    ChannelSamples samples(static_cast<int>(channels.size()));
    for (const auto& leaf : table.leaves())
        if (leaf.sums.v[0] > 0)
            samples.pushBack(leaf.sums.v.data(), leaf.anchor, filter, noise);
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
    finer.minLeaf_m *= params.modalityLeafAtOneMetre_m / filter.leafAtOneMetre_m;
    finer.leafAtOneMetre_m = params.modalityLeafAtOneMetre_m;
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
