#include "io/place_codec.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace hgmm {

namespace {

constexpr double kBlock_m = 16.0;

constexpr LogScale kSigma{5e-4, 500.0, 256};
/// The factor's other entries, in steps of a share of their row's diagonal entry, which is
/// their scale: so the error is a share of the component's thickness, and what rounding to
/// float does to them stays below half a step.
constexpr double kStepsPerDiagonal = 32.0;
constexpr double kMaxPerDiagonal = 950.0;
constexpr LogScale kSupport{1e-6, 1e12, 65536};

}  // namespace

int LogScale::encode(double v) const {
    const double position = std::log(v / low) / std::log(high / low) * (codes - 1);
    return position > 0 ? static_cast<int>(std::lround(std::min(position, codes - 1.0)))
                        : 0;
}

double LogScale::decode(int code) const {
    return low * std::exp(std::log(high / low) * code / (codes - 1));
}

Block blockOf(const Eigen::Vector3d& p) {
    Block b;
    for (int d = 0; d < 3; ++d)
        b[d] = static_cast<std::int32_t>(std::floor(p[d] / kBlock_m));
    return b;
}

void putPlace(Writer& out, const Block& block, const Eigen::Vector3d& mean,
              const Eigen::Matrix3d& covariance, double support) {
    for (int d = 0; d < 3; ++d) {
        const double inside = mean[d] / kBlock_m - block[d];
        out.put(static_cast<std::uint16_t>(std::clamp(inside * 65536, 0.0, 65535.0)));
    }
    const Eigen::Matrix3d L = covariance.llt().matrixL();
    std::array<double, 3> diagonal{};
    for (int d = 0; d < 3; ++d) {
        const double beside = L.row(d).head(d).cwiseAbs().sum();
        const int code = kSigma.encode(std::max(L(d, d), beside / kMaxPerDiagonal));
        diagonal[d] = kSigma.decode(code);
        out.put(static_cast<std::uint8_t>(code));
    }
    // Slopes of one axis over another, not the entries themselves: a slope must be good to
    // the thickness of the component over its length, whatever became of the diagonal.
    const auto putSlope = [&](int row, int col, double slope) {
        const double perStep = diagonal[row] / diagonal[col] / kStepsPerDiagonal;
        const auto steps = static_cast<std::int16_t>(
            std::lround(std::clamp(slope / perStep, -32767.0, 32767.0)));
        out.put(steps);
        return steps * perStep;
    };
    const double slope10 = L(1, 0) / L(0, 0), slope21 = L(2, 1) / L(1, 1);
    const double error10 = putSlope(1, 0, slope10) - slope10;
    // Axis 2 follows axis 1, and so what axis 1 lost on its way over axis 0.
    putSlope(2, 0, L(2, 0) / L(0, 0) + slope21 * error10);
    putSlope(2, 1, slope21);
    out.put(static_cast<std::uint16_t>(kSupport.encode(support)));
}

void getPlace(Reader& in, const Block& block, Gaussian<3>& g) {
    for (int d = 0; d < 3; ++d) {
        const auto mean = static_cast<float>(
            (block[d] + (in.get<std::uint16_t>() + 0.5) / 65536) * kBlock_m);
        // Rounded to the block's far face, it would be the next block's.
        g.mean[d] = mean < (block[d] + 1.0) * kBlock_m
                        ? mean
                        : std::nextafter(mean, std::numeric_limits<float>::lowest());
    }
    Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
    for (int d = 0; d < 3; ++d) L(d, d) = kSigma.decode(in.get<std::uint8_t>());
    for (int row = 1; row < 3; ++row)
        for (int col = 0; col < row; ++col)
            L(row, col) = in.get<std::int16_t>() / kStepsPerDiagonal * L(row, row);
    g.covariance = L * L.transpose();
    g.support = kSupport.decode(in.get<std::uint16_t>());
}

}  // namespace hgmm
