#include "display/ellipsoids.h"

#include <mrpt/opengl/CEllipsoid3D.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hgmm/mrpt_bridge/modality_colours.h"

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

/// Where the components of a modality are in space; they are smaller than those of the
/// surface where colours change.
Mixture<3> placesOf(const ModalityMap& modality, std::size_t level) {
    const Mixture<4>& joint = modality.mixture(level);
    Mixture<3> places;
    for (std::size_t i = 0; i < joint.size(); ++i) {
        const Gaussian<4> g = joint[i];
        places.pushBack({g.support, g.mean.head<3>(), g.covariance.topLeftCorner<3, 3>()});
    }
    return places;
}

/// The components that are drawn: of the modality if its colour is shown and it was
/// measured, else of the surface.
Mixture<3> shapesOf(const Map& map, const RenderParams& params) {
    if (static_cast<EllipsoidColour>(params.colour) == EllipsoidColour::kModality)
        for (const std::string& name : shownModalities(map, params.modality))
            if (const ModalityMap* modality = map.modality(name))
                return placesOf(*modality, levelOf(map, params));
    return map.mixture(levelOf(map, params));
}

std::vector<Eigen::Vector3d> meansOf(const Map& map, const Mixture<3>& mixture,
                                     const std::vector<std::size_t>& drawn) {
    std::vector<Eigen::Vector3d> means_map;
    means_map.reserve(drawn.size());
    for (const std::size_t i : drawn) means_map.push_back(map.origin() + mixture[i].mean);
    return means_map;
}

/// The number that the colour of each drawn component of the surface shows.
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
    else {
        const std::vector<Eigen::Vector3d> means_map = meansOf(map, mixture, drawn);
        std::vector<Occupancy> answers(drawn.size());
        map.occupancy(means_map.data(), means_map.size(), answers.data(), level);
        for (const Occupancy& answer : answers)
            values.push_back(what == EllipsoidColour::kOccupied
                                 ? answer.occupied
                                 : std::sqrt(answer.variance_m2));
    }
    return values;
}

std::vector<mrpt::img::TColorf> coloursOf(const Map& map, const RenderParams& params,
                                          const Mixture<3>& shapes,
                                          const std::vector<std::size_t>& drawn) {
    const auto what = static_cast<EllipsoidColour>(params.colour);
    if (what == EllipsoidColour::kModality)
        return modalityColours(map, params.modality, meansOf(map, shapes, drawn));
    const std::vector<float> values = shownValues(map, levelOf(map, params), drawn, what);
    float low = 0.F, high = 1.F;
    if (what != EllipsoidColour::kOccupied) {
        low = *std::min_element(values.begin(), values.end());
        high = *std::max_element(values.begin(), values.end());
    }
    std::vector<mrpt::img::TColorf> colours;
    for (const float value : values) colours.push_back(jetColour(value, low, high));
    return colours;
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
    const Mixture<3> shapes = shapesOf(map, params);
    const std::vector<std::size_t> drawn =
        heaviest(shapes.support, static_cast<std::size_t>(params.maxEllipsoids));
    const std::vector<mrpt::img::TColorf> colours = coloursOf(map, params, shapes, drawn);
    for (std::size_t k = 0; k < drawn.size(); ++k) {
        const Gaussian<3> g = shapes[drawn[k]];
        const auto shape = ellipsoid(map.origin() + g.mean, g.covariance, params.sigmas);
        shape->setColor(colours[k]);
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
