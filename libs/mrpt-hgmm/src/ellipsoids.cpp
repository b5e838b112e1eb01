#include "hgmm/mrpt_bridge/ellipsoids.h"

#include <mrpt/img/color_maps.h>
#include <mrpt/opengl/CEllipsoid3D.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hgmm::mrpt_bridge {

namespace {

/// The components with most support, in their old order.
std::vector<std::size_t> heaviest(const Mixture<3>& mixture, std::size_t count) {
    std::vector<std::size_t> indices(mixture.size());
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    if (indices.size() <= count) return indices;
    std::nth_element(indices.begin(), indices.begin() + count, indices.end(),
                     [&](std::size_t a, std::size_t b) {
                         return std::make_pair(-mixture.support[a], a) <
                                std::make_pair(-mixture.support[b], b);
                     });
    indices.resize(count);
    std::sort(indices.begin(), indices.end());
    return indices;
}

/// Maps the values of the drawn components to colours, from the smallest to the largest.
class ColourScale {
 public:
    ColourScale(const Mixture<3>& mixture, const std::vector<std::size_t>& drawn,
                bool byWeight)
        : mixture_(mixture), byWeight_(byWeight) {
        for (const std::size_t i : drawn) {
            low_ = std::min(low_, value(i));
            high_ = std::max(high_, value(i));
        }
    }
    mrpt::img::TColorf operator()(std::size_t i) const {
        const float place = high_ > low_ ? (value(i) - low_) / (high_ - low_) : 0.5F;
        mrpt::img::TColorf colour(0, 0, 0, 1);
        mrpt::img::colormap(mrpt::img::cmJET, place, colour.R, colour.G, colour.B);
        return colour;
    }

 private:
    float value(std::size_t i) const {
        return byWeight_ ? std::log(mixture_.support[i]) : mixture_.mean[2][i];
    }

    const Mixture<3>& mixture_;
    bool byWeight_;
    float low_ = std::numeric_limits<float>::max();
    float high_ = std::numeric_limits<float>::lowest();
};

mrpt::opengl::CEllipsoid3D::Ptr ellipsoid(const Gaussian<3>& g,
                                          const Eigen::Vector3d& origin) {
    constexpr unsigned segments =
        10;  // a tenth of the default's vertices: maps have thousands
    auto shape = mrpt::opengl::CEllipsoid3D::Create();
    mrpt::math::CMatrixDouble33 covariance;
    for (int row = 0; row < 3; ++row)
        for (int col = 0; col < 3; ++col) covariance(row, col) = g.covariance(row, col);
    shape->setCovMatrix(covariance);
    shape->setLocation(origin.x() + g.mean[0], origin.y() + g.mean[1],
                       origin.z() + g.mean[2]);
    shape->set3DsegmentsCount(segments);
    shape->enableDrawSolid3D(true);
    return shape;
}

}  // namespace

void appendEllipsoids(const Map& map, const RenderParams& params,
                      mrpt::opengl::CSetOfObjects& objects) {
    params.validate();
    const std::size_t level =
        std::min(static_cast<std::size_t>(params.level), map.levelCount() - 1);
    const Mixture<3>& mixture = map.mixture(level);
    const std::vector<std::size_t> drawn =
        heaviest(mixture, static_cast<std::size_t>(params.maxEllipsoids));
    const ColourScale colour(mixture, drawn, params.colourByWeight);
    for (const std::size_t i : drawn) {
        const auto shape = ellipsoid(mixture[i], map.origin());
        shape->setQuantiles(static_cast<float>(params.sigmas));
        shape->setColor(colour(i));
        objects.insert(shape);
    }
}

}  // namespace hgmm::mrpt_bridge
