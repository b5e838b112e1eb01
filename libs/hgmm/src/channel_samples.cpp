#include "channel_samples.h"

#include "channel_sums.h"
#include "leaf_table.h"

namespace hgmm {

namespace {

/// Sums over the points of a leaf, in floats, four at a time: u = (1, dx, dy, dz), about
/// the leaf's first point, and l, about its first value, so that floats keep their digits.
template <int J>
struct PointSums {
    using Four = Eigen::Array4f;

    std::array<Four, 4> outer = zeros<4>();    ///< u u^T
    std::array<Four, J> channel = zeros<J>();  ///< l u
    std::array<float, J> square{};             ///< l^2
    std::array<float, J> first{};              ///< values that l is about

    float count() const { return outer[0][0]; }

    void add(double dx, double dy, double dz, const std::array<const float*, J>& values,
             std::size_t i) {
        if (count() == 0.F)
            for (int c = 0; c < J; ++c) first[c] = values[c][i];
        const Four u(1.F, float(dx), float(dy), float(dz));
        for (int row = 0; row < 4; ++row) outer[row] += u[row] * u;
        for (int c = 0; c < J; ++c) {
            const float l = values[c][i] - first[c];
            channel[c] += l * u;
            square[c] += l * l;
        }
    }

    /// The layout of ChannelSums, about the leaf's first point.
    void write(int channels, double* v) const {
        for (int row = 0, k = 0; row < 4; ++row)
            for (int col = row; col < 4; ++col, ++k) v[k] = outer[row][col];
        v += ChannelSums::kPlace;
        for (int c = 0; c < channels; ++c, v += ChannelSums::kChannel) {
            const double f = first[c], n = count();
            v[0] = channel[c][0] + f * n;
            v[1] = square[c] + f * (2.0 * channel[c][0] + f * n);
            for (int d = 0; d < 3; ++d) v[2 + d] = channel[c][1 + d] + f * outer[0][1 + d];
        }
    }

 private:
    template <int N>
    static std::array<Four, N> zeros() {
        std::array<Four, N> all;
        all.fill(Four::Zero());
        return all;
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
