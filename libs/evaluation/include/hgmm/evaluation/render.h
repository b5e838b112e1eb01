#pragma once
#include <array>
#include <optional>
#include <vector>

#include "hgmm/evaluation/picture.h"
#include "hgmm/evaluation/points.h"
#include "hgmm/mixture.h"

namespace hgmm::evaluation {

/// Red, green and blue, each in [0, 1].
using Rgb = std::array<double, 3>;

/// Dark blue at 0 to yellow at 1 by rising lightness: ordered for every kind of colour
/// vision. Shares beyond are those at the ends.
Rgb scaleColour(double share);

/// How to look at a map: an orthographic view from outside.
struct View {
    double yaw_deg = 30.0;    ///< of the viewing direction about z [deg]
    double pitch_deg = 30.0;  ///< of the viewing direction below the horizon [deg]
    double sigmas = 2.0;      ///< size of the ellipsoids [sigma], > 0
    double cut = 0.0;     ///< share of the depth, from the viewer on, left out, in [0, 1)
    int width_px = 1280;  ///< [px], the height follows
};

/// What is shown: pictures of one view and one frame have the same scale, cut and colours,
/// and can be compared pixel by pixel.
struct Frame {
    Eigen::Vector3d low, high;   ///< corners of a box in view axes (right, down, away) [m]
    double lowest_m, highest_m;  ///< heights of the first and the last colour [m]
};

/// Around points: as far as all but a share of them at either end of each axis reach, and a
/// third of that further, but no further than all do. Far points that are few do not shrink
/// the rest. Colours are spread over the heights of all but the same share. Points that are
/// not finite do not count. Throws std::invalid_argument if there is no finite point, the
/// share is not in [0, 0.5), or the view is outside its ranges.
Frame frameOf(const Points& points_map, const View& view, double strayShare = 0.05);

/// Draws each component as a shaded ellipsoid coloured by height, without a display: the
/// depth of an ellipsoid along a pixel's ray is the mean and spread of the Gaussian's depth
/// given the pixel.
/// @param origin_map origin of the mixture's local frame
/// @param frame in the map frame; without one, all ellipsoids are shown
/// Throws std::invalid_argument for an empty mixture without a frame or a view outside its
/// ranges.
Picture renderEllipsoids(const Mixture<3>& mixture, const View& view,
                         const Eigen::Vector3d& origin_map = Eigen::Vector3d::Zero(),
                         const std::optional<Frame>& frame = std::nullopt);

/// Draws each finite point as a small disc coloured by height, and darker before a gap in
/// depth, which brings out edges. Throws std::invalid_argument for a view outside its
/// ranges.
Picture renderPoints(const Points& points_map, const View& view, const Frame& frame);

/// The same with a colour for each point. Throws std::invalid_argument too if there are not
/// as many colours as points.
Picture renderPoints(const Points& points_map, const std::vector<Rgb>& colours,
                     const View& view, const Frame& frame);

/// Draws a cube around each finite point, its sides along the axes of the map, coloured by
/// height. Throws std::invalid_argument for a view outside its ranges or an edge that is
/// not positive.
/// @param edge_m of a cube
Picture renderVoxels(const Points& centres_map, double edge_m, const View& view,
                     const Frame& frame);

}  // namespace hgmm::evaluation
