#include "io/modality_codec.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "hgmm/modality.h"
#include "io/component_codec.h"
#include "io/place_codec.h"
#include "modality/modality_group.h"

namespace hgmm {

namespace {

constexpr LogScale kResidualSigma{1e-6, 1e6, 256};
constexpr LogScale kLargestChange{1e-9, 1e9, 65536};
constexpr double kMeanSteps = 65535, kChangeSteps = 127;

/// Change of the channel per standard deviation along each axis of the Cholesky factor.
Eigen::Vector3d whitened(const Gaussian<3>& place, const Eigen::Vector3d& slope) {
    const Eigen::Matrix3d C = place.covariance;
    return C.llt().matrixL().transpose() * slope;
}

Eigen::Vector3d unwhitened(const Gaussian<3>& place, const Eigen::Vector3d& change) {
    const Eigen::Matrix3d C = place.covariance;
    return C.llt().matrixL().transpose().solve(change);
}

/// What the codes of one channel are relative to.
struct ChannelScale {
    float low = 0, high = 0;          ///< of the means
    std::uint16_t largestChange = 0;  ///< code of kLargestChange

    /// The last code is the highest mean itself.
    double meanOf(std::uint16_t code) const {
        return code == kMeanSteps ? high : low + code * perMeanStep();
    }
    double perMeanStep() const { return (double(high) - low) / kMeanSteps; }
    double perChangeStep() const {
        return kLargestChange.decode(largestChange) / kChangeSteps;
    }
};

ChannelScale scaleOf(const ChannelMixture& mixture, int channel) {
    ChannelScale scale;
    double change = 0;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const float mean = mixture.mean(channel, i);
        scale.low = i == 0 ? mean : std::min(scale.low, mean);
        scale.high = i == 0 ? mean : std::max(scale.high, mean);
        const ChannelGaussian g = mixture[i];
        change = std::max(
            change, whitened(g.place, g.fits[channel].slope).lpNorm<Eigen::Infinity>());
    }
    scale.largestChange = static_cast<std::uint16_t>(kLargestChange.encode(change));
    return scale;
}

struct ChannelRecord {
    Gaussian<3> g;
    std::array<ChannelFit, kMaxModalities> fits{};
    const std::vector<ChannelScale>* scales;
};

void putRecord(Writer& out, const Block& block, const ChannelRecord& record) {
    const Gaussian<3>& g = record.g;
    putPlace(out, block, g.mean, g.covariance, g.support);
    for (std::size_t c = 0; c < record.scales->size(); ++c) {
        const ChannelScale& scale = (*record.scales)[c];
        const ChannelFit& fit = record.fits[c];
        const double step = std::max(scale.perMeanStep(), 1e-300);
        out.put(static_cast<std::uint16_t>(
            std::lround(std::clamp((fit.mean - scale.low) / step, 0.0, kMeanSteps))));
        const Eigen::Vector3d change = whitened(g, fit.slope) / scale.perChangeStep();
        for (int d = 0; d < 3; ++d)
            out.put(static_cast<std::int8_t>(
                std::lround(std::clamp(change[d], -kChangeSteps, kChangeSteps))));
        out.put(static_cast<std::uint8_t>(kResidualSigma.encode(std::sqrt(fit.residual))));
    }
}

void getRecord(Reader& in, const Block& block, ChannelRecord& record) {
    getPlace(in, block, record.g);
    record.g = asStored(record.g);
    for (std::size_t c = 0; c < record.scales->size(); ++c) {
        const ChannelScale& scale = (*record.scales)[c];
        ChannelFit& fit = record.fits[c];
        fit.mean = scale.meanOf(in.get<std::uint16_t>());
        Eigen::Vector3d change;
        for (int d = 0; d < 3; ++d)
            change[d] = in.get<std::int8_t>() * scale.perChangeStep();
        fit.slope = unwhitened(record.g, change);
        const double sigma = kResidualSigma.decode(in.get<std::uint8_t>());
        fit.residual = sigma * sigma;
    }
}

/// Scales are those of the channels as they are.
std::vector<std::uint8_t> encodedOnce(const ChannelMixture& mixture) {
    std::vector<std::uint8_t> bytes;
    std::vector<ChannelScale> scales;
    Writer out(bytes);
    for (int c = 0; c < mixture.channels(); ++c) {
        scales.push_back(scaleOf(mixture, c));
        out.put(scales.back().low);
        out.put(scales.back().high);
        out.put(scales.back().largestChange);
    }
    const Mixture<3>& places = mixture.places();
    forEachBlock(places, blockOrder(places), bytes, [&](const Block& block, std::size_t i) {
        const ChannelGaussian g = mixture[i];
        putStable(bytes, block, ChannelRecord{g.place, g.fits, &scales});
    });
    return bytes;
}

}  // namespace

std::size_t decodeChannels(const std::uint8_t* data, std::size_t size,
                           ChannelMixture& mixture) {
    Reader in(data, size);
    std::vector<ChannelScale> scales(static_cast<std::size_t>(mixture.channels()));
    for (ChannelScale& scale : scales) {
        scale.low = in.get<float>();
        scale.high = in.get<float>();
        scale.largestChange = in.get<std::uint16_t>();
    }
    mixture = ChannelMixture(mixture.channels());
    readBlocks(in, [&](const Block& block) {
        ChannelRecord record{{}, {}, &scales};
        getRecord(in, block, record);
        mixture.pushBack({record.g, record.fits});
    });
    return size - in.left();
}

void encodeChannels(const ChannelMixture& mixture, std::vector<std::uint8_t>& bytes) {
    // Scales of what is read may be others: they are followed until they stay.
    constexpr int kFollow = 8;
    std::vector<std::uint8_t> encoded = encodedOnce(mixture);
    for (int round = 0; round < kFollow; ++round) {
        ChannelMixture read(mixture.channels());
        decodeChannels(encoded.data(), encoded.size(), read);
        std::vector<std::uint8_t> again = encodedOnce(read);
        if (again == encoded) break;
        encoded = std::move(again);
    }
    bytes.insert(bytes.end(), encoded.begin(), encoded.end());
}

std::size_t ModalityMap::savedBytes() const {
    std::vector<std::uint8_t> bytes;
    encodeChannels(group_->mixture(), bytes);
    return bytes.size() / group_->names().size();
}

}  // namespace hgmm
