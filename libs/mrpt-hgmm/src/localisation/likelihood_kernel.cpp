#include "localisation/likelihood_kernel.h"

#include <algorithm>
#include <cmath>

namespace hgmm::mrpt_bridge {

namespace {

constexpr LikelihoodKernel kNarrow{0.02, 0.05, 60, 1}, kWide{0.2, 0.3, 15, 0.5};
/// Up to which spread the kernel is the narrow one, and from which it is the wide one.
constexpr PoseSpread kConverged{0.2, 0.1}, kSearching{0.6, 0.3};

/// Kernels between the narrow and the wide one: each takes the map's surfaces made anew.
constexpr double kSteps = 16;

/// 0 for `low`, 1 for `high`, and between them by the logarithm.
double between(double low, double high, double value) {
    return value <= low ? 0.0 : std::min(1.0, std::log(value / low) / std::log(high / low));
}

double mixed(double narrow, double wide, double share) {
    return narrow * std::pow(wide / narrow, share);
}

}  // namespace

std::optional<LikelihoodKernel> fixedKernel(const LikelihoodParams& params) {
    if (params.kernelWidth_m == 0 && params.outlierRatio == 0 &&
        params.independentPoints == 0)
        return std::nullopt;
    const auto orNarrow = [](double value, double narrow) {
        return value == 0 ? narrow : value;
    };
    return LikelihoodKernel{orNarrow(params.kernelWidth_m, kNarrow.kernelWidth_m),
                            orNarrow(params.outlierRatio, kNarrow.outlierRatio),
                            orNarrow(params.independentPoints, kNarrow.independentPoints),
                            kNarrow.shareOfPoints};
}

LikelihoodKernel kernelWithoutSearch() {
    LikelihoodKernel kernel = kNarrow;
    kernel.kernelWidth_m = kWide.kernelWidth_m;
    return kernel;
}

LikelihoodKernel kernelFor(const std::optional<PoseSpread>& spread) {
    if (!spread) return kWide;
    const double share = std::max(
        between(kConverged.position_m, kSearching.position_m, spread->position_m),
        between(kConverged.rotation_rad, kSearching.rotation_rad, spread->rotation_rad));
    const double step = std::round(share * kSteps) / kSteps;
    return {mixed(kNarrow.kernelWidth_m, kWide.kernelWidth_m, step),
            mixed(kNarrow.outlierRatio, kWide.outlierRatio, step),
            mixed(kNarrow.independentPoints, kWide.independentPoints, step),
            mixed(kNarrow.shareOfPoints, kWide.shareOfPoints, step)};
}

}  // namespace hgmm::mrpt_bridge
