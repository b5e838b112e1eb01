#include "hgmm/slam/appearance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace hgmm::slam {
namespace {

constexpr int kRings = 6;      // of distance, in octaves
constexpr int kShapes = 5;     // line, plane in three slants, blob
constexpr int kHeadings = 36;  // of normals, over half a turn
constexpr int kHarmonics = 8;  // of headings that are kept
constexpr double kFirstRing_m = 1.0;

int ringOf(double distance_m) {
    const int octave =
        static_cast<int>(std::floor(std::log2(std::max(distance_m, 1e-6) / kFirstRing_m))) +
        1;
    return std::clamp(octave, 0, kRings - 1);
}

struct Shape {
    explicit Shape(const Gaussian<3>& component) {
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(
            Eigen::Matrix3d(component.covariance));
        const Eigen::Vector3d sigma = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
        const Eigen::Vector3d normal = axes.eigenvectors().col(0);
        weight = std::sqrt(sigma.y() * sigma.z());
        heading = std::atan2(normal.y(), normal.x());
        upright = std::abs(normal.z()) < 0.5;
        if (sigma.y() < 0.25 * sigma.z())
            kind = 0;
        else if (sigma.x() > 0.5 * sigma.y())
            kind = 4;
        else
            kind = upright ? 1 : std::abs(normal.z()) < 0.87 ? 2 : 3;
    }

    double weight = 0.0;   // [m]
    double heading = 0.0;  // of the normal [rad]
    bool upright = false;  // the surface
    int kind = 0;
};

/// Magnitudes of the harmonics of a histogram over half a turn.
std::vector<double> spectrumOf(const std::array<double, kHeadings>& histogram) {
    std::vector<double> magnitudes;
    for (int k = 1; k <= kHarmonics; ++k) {
        std::complex<double> sum = 0;
        for (int b = 0; b < kHeadings; ++b)
            sum += histogram[b] * std::polar(1.0, 2.0 * M_PI * k * b / kHeadings);
        magnitudes.push_back(std::abs(sum));
    }
    return magnitudes;
}

}  // namespace

Appearance::Appearance(const Mixture<3>& mixture, const Eigen::Vector3d& centre)
    : bins(kRings * kShapes) {
    std::array<double, kHeadings> headings{};
    double total = 0;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Gaussian<3> component = mixture[i];
        const Shape shape(component);
        const double distance_m = (Eigen::Vector3d(component.mean) - centre).norm();
        bins[ringOf(distance_m) * kShapes + shape.kind] += shape.weight;
        total += shape.weight;
        if (!shape.upright) continue;
        const double halfTurns = shape.heading / M_PI + 1.0;
        const int bin = static_cast<int>((halfTurns - std::floor(halfTurns)) * kHeadings);
        headings[std::min(bin, kHeadings - 1)] += shape.weight;
    }
    const std::vector<double> spectrum = spectrumOf(headings);
    bins.insert(bins.end(), spectrum.begin(), spectrum.end());
    for (const double magnitude : spectrum) total += magnitude;
    if (total > 0)
        for (double& bin : bins) bin /= total;
}

double Appearance::similarity(const Appearance& other) const {
    double common = 0;
    for (std::size_t b = 0; b < std::min(bins.size(), other.bins.size()); ++b)
        common += std::sqrt(bins[b] * other.bins[b]);
    return std::min(common, 1.0);
}

}  // namespace hgmm::slam
