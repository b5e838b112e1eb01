#include "modality/channel_mixture.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mixture/regularized.h"

namespace hgmm {

namespace {

/// Smallest residual variance: floats hold it, and densities stay far from overflow.
constexpr double kLeastFitVariance = 1e-12;

}  // namespace

Gaussian<4> ChannelGaussian::joint(int channel) const {
    const ChannelFit& fit = fits[static_cast<std::size_t>(channel)];
    const Eigen::Matrix3d covariance = place.covariance;
    const Eigen::Vector3d cross = covariance * fit.slope;
    Gaussian<4> g;
    g.support = place.support;
    g.mean << place.mean, fit.mean;
    g.covariance.topLeftCorner<3, 3>() = covariance;
    g.covariance.topRightCorner<3, 1>() = cross;
    g.covariance.bottomLeftCorner<1, 3>() = cross.transpose();
    g.covariance(3, 3) = fit.residual + fit.slope.dot(cross);
    return g;
}

ChannelMixture::ChannelMixture(int channels) {
    if (channels < 1 || channels > kMaxModalities)
        throw std::invalid_argument("ChannelMixture: channels must be in [1, 8]");
    fits_.resize(static_cast<std::size_t>(channels));
}

void ChannelMixture::pushBack(const ChannelGaussian& component) {
    places_.pushBack(component.place);
    for (Fits& fits : fits_)
        fits.forEachArray([](std::vector<float>& array) { array.push_back(0.F); });
    set(size() - 1, component);
}

void ChannelMixture::set(std::size_t i, const ChannelGaussian& component) {
    places_.set(i, regularized(component.place));
    for (std::size_t c = 0; c < fits_.size(); ++c) {
        const ChannelFit& fit = component.fits[c];
        fits_[c].mean[i] = static_cast<float>(fit.mean);
        fits_[c].residual[i] =
            static_cast<float>(std::max(fit.residual, kLeastFitVariance));
        for (int d = 0; d < 3; ++d) fits_[c].slope[d][i] = static_cast<float>(fit.slope[d]);
    }
}

ChannelGaussian ChannelMixture::operator[](std::size_t i) const {
    ChannelGaussian g;
    g.place = places_[i];
    for (std::size_t c = 0; c < fits_.size(); ++c) {
        g.fits[c].mean = fits_[c].mean[i];
        g.fits[c].residual = fits_[c].residual[i];
        for (int d = 0; d < 3; ++d) g.fits[c].slope[d] = fits_[c].slope[d][i];
    }
    return g;
}

Mixture<4> ChannelMixture::joint(int channel) const {
    Mixture<4> mixture;
    mixture.reserve(size());
    for (std::size_t i = 0; i < size(); ++i)
        mixture.pushBack(regularized((*this)[i].joint(channel)));
    return mixture;
}

ChannelMixture ChannelMixture::withChannels(const std::vector<int>& channels) const {
    ChannelMixture some(static_cast<int>(channels.size()));
    some.places_ = places_;
    for (std::size_t c = 0; c < channels.size(); ++c)
        some.fits_[c] = fits_.at(static_cast<std::size_t>(channels[c]));
    return some;
}

ChannelMixture ChannelMixture::rows(const std::vector<std::size_t>& rows) const {
    ChannelMixture some(channels());
    for (const std::size_t row : rows) some.places_.pushBack(places_[row]);
    const auto gather = [&](const std::vector<float>& from, std::vector<float>& to) {
        for (const std::size_t row : rows) to.push_back(from[row]);
    };
    for (std::size_t c = 0; c < fits_.size(); ++c) {
        gather(fits_[c].mean, some.fits_[c].mean);
        gather(fits_[c].residual, some.fits_[c].residual);
        for (std::size_t d = 0; d < 3; ++d)
            gather(fits_[c].slope[d], some.fits_[c].slope[d]);
    }
    return some;
}

void ChannelMixture::check() const {
    places_.check();
    for (const Fits& fits : fits_) {
        fits.forEachArray([this](const std::vector<float>& array) {
            if (array.size() != size())
                throw std::logic_error("ChannelMixture: arrays differ in length");
            for (const float v : array)
                if (!std::isfinite(v))
                    throw std::logic_error("ChannelMixture: a parameter is not finite");
        });
        for (const float v : fits.residual)
            if (!(v > 0))
                throw std::logic_error("ChannelMixture: a residual is not positive");
    }
}

std::size_t ChannelMixture::liveBytes() const {
    constexpr std::size_t perPlace = 1 + 3 + Mixture<3>::packed, perFit = 5;
    return places_.support.capacity() * sizeof(float) * (perPlace + perFit * fits_.size());
}

void ChannelMixture::assignPlaces(Mixture<3> places) {
    places_ = std::move(places);
    for (Fits& fits : fits_)
        fits.forEachArray([this](std::vector<float>& array) { array.resize(size()); });
}

}  // namespace hgmm
