#include "hgmm/mrpt_bridge/ellipsoids.h"

#include <mrpt/img/color_maps.h>
#include <mrpt/opengl/CEllipsoid3D.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hgmm::mrpt_bridge {

namespace {

/// The components with most support, in their old order.
std::vector<std::size_t> heaviest(const std::vector<float>& support, std::size_t count) {
    std::vector<std::size_t> indices(support.size());
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    if (indices.size() <= count) return indices;
    std::nth_element(indices.begin(), indices.begin() + count, indices.end(),
                     [&](std::size_t a, std::size_t b) {
                         return std::make_pair(-support[a], a) <
                                std::make_pair(-support[b], b);
                     });
    indices.resize(count);
    std::sort(indices.begin(), indices.end());
    return indices;
}

std::size_t levelOf(const Map& map, const RenderParams& params) {
    return std::min(static_cast<std::size_t>(params.level), map.levelCount() - 1);
}

/// What the map says at the means of the drawn components.
std::vector<Occupancy> occupancyAtMeans(const Map& map, std::size_t level,
                                        const std::vector<std::size_t>& drawn) {
    const Mixture<3>& mixture = map.mixture(level);
    std::vector<Eigen::Vector3d> means_map;
    for (const std::size_t i : drawn) means_map.push_back(map.origin() + mixture[i].mean);
    std::vector<Occupancy> answers(drawn.size());
    map.occupancy(means_map.data(), means_map.size(), answers.data(), level);
    return answers;
}

/// The number that each drawn component's colour shows.
std::vector<float> shownValues(const Map& map, std::size_t level,
                               const std::vector<std::size_t>& drawn,
                               EllipsoidColour what) {
    const Mixture<3>& mixture = map.mixture(level);
    std::vector<float> values;
    values.reserve(drawn.size());
    if (what == EllipsoidColour::kHeight)
        for (const std::size_t i : drawn) values.push_back(mixture.mean[2][i]);
    else if (what == EllipsoidColour::kWeight)
        for (const std::size_t i : drawn) values.push_back(std::log(mixture.support[i]));
    else
        for (const Occupancy& answer : occupancyAtMeans(map, level, drawn))
            values.push_back(what == EllipsoidColour::kOccupied
                                 ? answer.occupied
                                 : std::sqrt(answer.variance_m2));
    return values;
}

/// From blue at `low` to red at `high`.
mrpt::img::TColorf colourOf(float value, float low, float high) {
    const float place = high > low ? (value - low) / (high - low) : 0.5F;
    mrpt::img::TColorf colour(0, 0, 0, 1);
    mrpt::img::colormap(mrpt::img::cmJET, place, colour.R, colour.G, colour.B);
    return colour;
}

mrpt::opengl::CEllipsoid3D::Ptr ellipsoid(const Eigen::Vector3d& mean_map,
                                          const Eigen::Matrix3d& C, double sigmas) {
    constexpr unsigned segments =
        10;  // a tenth of the default's vertices: maps have thousands
    auto shape = mrpt::opengl::CEllipsoid3D::Create();
    mrpt::math::CMatrixDouble33 covariance;
    for (int row = 0; row < 3; ++row)
        for (int col = 0; col < 3; ++col) covariance(row, col) = C(row, col);
    shape->setCovMatrix(covariance);
    shape->setLocation(mean_map.x(), mean_map.y(), mean_map.z());
    shape->set3DsegmentsCount(segments);
    shape->setQuantiles(static_cast<float>(sigmas));
    shape->enableDrawSolid3D(true);
    return shape;
}

}  // namespace

void appendEllipsoids(const Map& map, const RenderParams& params,
                      mrpt::opengl::CSetOfObjects& objects) {
    params.validate();
    if (!params.drawEllipsoids || map.empty()) return;
    const std::size_t level = levelOf(map, params);
    const Mixture<3>& mixture = map.mixture(level);
    const std::vector<std::size_t> drawn =
        heaviest(mixture.support, static_cast<std::size_t>(params.maxEllipsoids));
    const auto what = static_cast<EllipsoidColour>(params.colour);
    const std::vector<float> values = shownValues(map, level, drawn, what);
    float low = 0.F, high = 1.F;
    if (what != EllipsoidColour::kOccupied) {
        low = *std::min_element(values.begin(), values.end());
        high = *std::max_element(values.begin(), values.end());
    }
    for (std::size_t k = 0; k < drawn.size(); ++k) {
        const Gaussian<3> g = mixture[drawn[k]];
        const auto shape = ellipsoid(map.origin() + g.mean, g.covariance, params.sigmas);
        shape->setColor(colourOf(values[k], low, high));
        objects.insert(shape);
    }
}

void appendFreeSpace(const Map& map, const RenderParams& params,
                     mrpt::opengl::CSetOfObjects& objects) {
    params.validate();
    if (!params.drawFreeSpace) return;
    const Mixture<4>& mixture = map.freeMixture(levelOf(map, params));
    for (const std::size_t i :
         heaviest(mixture.support, static_cast<std::size_t>(params.maxEllipsoids))) {
        const Gaussian<4> g = mixture[i];
        const auto shape = ellipsoid(map.origin() + g.mean.head<3>(),
                                     g.covariance.topLeftCorner<3, 3>(), params.sigmas);
        shape->setColor(mrpt::img::TColorf(0.5F, 0.8F, 1.F, 0.15F));
        objects.insert(shape);
    }
}

}  // namespace hgmm::mrpt_bridge
