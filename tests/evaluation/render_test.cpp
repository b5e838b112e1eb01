#include "hgmm/evaluation/render.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>

namespace hgmm::evaluation {
namespace {

Gaussian<3> ball(double x, double y, double z, double std_m) {
    Gaussian<3> g;
    g.support = 1;
    g.mean << x, y, z;
    g.covariance = std_m * std_m * Eigen::Matrix3d::Identity();
    return g;
}

/// Share of the picture's pixels that are not background.
double covered(const Picture& p) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < p.rgb.size(); i += 3)
        n += p.rgb[i] != 255 || p.rgb[i + 1] != 255 || p.rgb[i + 2] != 255;
    return 3.0 * double(n) / double(p.rgb.size());
}

TEST(Render, ABallCoversADisc) {
    Mixture<3> mixture;
    mixture.pushBack(ball(5, -3, 2, 0.7));
    View view;
    view.width_px = 400;
    const Picture p = renderEllipsoids(mixture, view);
    EXPECT_EQ(p.width_px, 400);
    EXPECT_NEAR(p.height_px, 400, 2);
    EXPECT_NEAR(covered(p), M_PI / 4 * 0.94 * 0.94, 0.01);
}

TEST(Render, TheNearerHidesTheFartherUnlessCut) {
    // Looking along +x: a small high ball behind a large low one of another height.
    Mixture<3> mixture;
    mixture.pushBack(ball(0, 0, 0, 1));
    mixture.pushBack(ball(10, 0, 0.5, 0.2));
    View view;
    view.yaw_deg = view.pitch_deg = 0;
    view.width_px = 100;
    const auto centre = [&](const View& v) {
        const Picture p = renderEllipsoids(mixture, v);
        const std::size_t at = 3 * (std::size_t(p.height_px * 3 / 8) * 100 + 50);
        return std::array<int, 3>{p.rgb[at], p.rgb[at + 1], p.rgb[at + 2]};
    };
    const auto hidden = centre(view);
    view.cut = 0.5;
    const auto revealed = centre(view);
    EXPECT_LT(hidden[1], hidden[2]);      // the low ball's dark blue
    EXPECT_GT(revealed[0], revealed[2]);  // the high ball's yellow
}

TEST(Render, WritesAPngOrSaysWhyNot) {
    Mixture<3> mixture;
    EXPECT_THROW(renderEllipsoids(mixture, {}), std::invalid_argument);
    mixture.pushBack(ball(0, 0, 0, 1));
    View view;
    view.cut = 1.5;
    EXPECT_THROW(renderEllipsoids(mixture, view), std::invalid_argument);
    const Picture p = renderEllipsoids(mixture, {});
    const auto file = std::filesystem::temp_directory_path() / "hgmm_render_test.png";
    writePng(p, file.string());
    EXPECT_GT(std::filesystem::file_size(file), 1000U);
    std::filesystem::remove(file);
    EXPECT_THROW(writePng(p, "/nowhere/at/all.png"), std::runtime_error);
}

/// Pixels that are not background: their mean position and number.
struct Blob {
    double x = 0, y = 0;
    int pixels = 0;
};
Blob blobOf(const Picture& p) {
    Blob blob;
    for (int y = 0; y < p.height_px; ++y)
        for (int x = 0; x < p.width_px; ++x) {
            const std::uint8_t* rgb = &p.rgb[3 * (std::size_t(y) * p.width_px + x)];
            if (rgb[0] == 255 && rgb[1] == 255 && rgb[2] == 255) continue;
            blob.x += x;
            blob.y += y;
            ++blob.pixels;
        }
    blob.x /= blob.pixels;
    blob.y /= blob.pixels;
    return blob;
}

View small(double yaw_deg, double pitch_deg) {
    View view;
    view.yaw_deg = yaw_deg;
    view.pitch_deg = pitch_deg;
    view.width_px = 200;
    return view;
}

/// Eight corners of a cube of this edge around (100, 200, 5).
Points cubeCorners(double edge_m) {
    Points corners;
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.5, 0.5})
            for (const double z : {-0.5, 0.5})
                corners.emplace_back(100 + edge_m * x, 200 + edge_m * y, 5 + edge_m * z);
    return corners;
}

TEST(RenderFrame, PutsPointsCubesAndEllipsoidsInTheSamePlace) {
    const View view = small(35, 20);
    const Frame frame = frameOf(cubeCorners(10), view, 0.0);
    const Eigen::Vector3d at(102, 198, 7), origin(95, 190, 1);
    Mixture<3> mixture;
    const Eigen::Vector3d local = at - origin;
    mixture.pushBack(ball(local.x(), local.y(), local.z(), 0.3));
    const Picture points = renderPoints({at}, view, frame);
    const Blob point = blobOf(points);
    const Blob cube = blobOf(renderVoxels({at}, 1.0, view, frame));
    const Blob ellipsoid = blobOf(renderEllipsoids(mixture, view, origin, frame));
    EXPECT_GE(point.pixels, 2);
    EXPECT_GT(cube.pixels, point.pixels);
    for (const Blob& blob : {cube, ellipsoid}) {
        EXPECT_NEAR(blob.x, point.x, 1.0);
        EXPECT_NEAR(blob.y, point.y, 1.0);
    }
    // Where it is, by hand: yaw and pitch turn the offset from the middle of the frame.
    const double yaw = 35 * M_PI / 180, pitch = 20 * M_PI / 180;
    const Eigen::Vector3d d = at - Eigen::Vector3d(100, 200, 5);
    const double right = std::sin(yaw) * d.x() - std::cos(yaw) * d.y();
    const double along = std::cos(yaw) * d.x() + std::sin(yaw) * d.y();
    const double down = -std::sin(pitch) * along - std::cos(pitch) * d.z();
    const double scale = 200 * 0.94 / (10 * (std::sin(yaw) + std::cos(yaw)));
    EXPECT_NEAR(point.x, 99.5 + scale * right, 1.0);
    EXPECT_NEAR(point.y, 0.5 * points.height_px - 0.5 + scale * down, 1.0);
}

TEST(RenderFrame, PointsHaveTheirOwnColours) {
    const View view = small(0, 0);
    const Frame frame = frameOf(cubeCorners(10), view, 0.0);
    const Eigen::Vector3d near(97, 203, 7), hidden(102, 203, 7), right(97, 197, 7);
    const Picture p = renderPoints({hidden, near, right},
                                   {{0, 0, 1}, {1, 0.5, 0}, {0, 1, 2}}, view, frame);
    std::array<int, 3> seen{};  // pixels of the three, by their colours
    for (std::size_t i = 0; i < p.rgb.size(); i += 3) {
        const std::array<int, 3> rgb{p.rgb[i], p.rgb[i + 1], p.rgb[i + 2]};
        seen[0] += rgb == std::array<int, 3>{0, 0, 255};
        seen[1] += rgb == std::array<int, 3>{255, 127, 0};
        seen[2] += rgb == std::array<int, 3>{0, 255, 255};
    }
    EXPECT_EQ(seen[0], 0) << "behind the nearer one";
    EXPECT_GE(seen[1], 2);
    EXPECT_EQ(seen[2], seen[1]) << "colours beyond 1 are as 1";
    EXPECT_THROW(renderPoints({near}, {}, view, frame), std::invalid_argument);
}

TEST(RenderScale, RisesInLightnessFromEndToEnd) {
    double before = -1;
    for (int i = 0; i <= 20; ++i) {
        const Rgb colour = scaleColour(i / 20.0);
        const double lightness =
            0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
        EXPECT_GT(lightness, before);
        before = lightness;
    }
    EXPECT_EQ(scaleColour(-3), scaleColour(0));
    EXPECT_EQ(scaleColour(3), scaleColour(1));
}

TEST(RenderFrame, AFewStrayPointsDoNotShrinkTheRest) {
    Points points = cubeCorners(10);
    for (int i = 0; i < 100; ++i) points.insert(points.end(), points[0]);
    points.emplace_back(1e6, -1e6, 1e6);
    points.emplace_back(std::nan(""), 0, 0);
    const Frame all = frameOf(cubeCorners(10), small(0, 0), 0.0);
    const Frame robust = frameOf(points, small(0, 0), 0.01);
    // Axes are those of -y, -z and x. It reaches a third further where there is more.
    EXPECT_TRUE(robust.high.isApprox(all.high + Eigen::Vector3d(10, 0, 10) / 3));
    EXPECT_TRUE(robust.low.isApprox(all.low - Eigen::Vector3d(0, 10, 0) / 3));
    EXPECT_EQ(robust.highest_m, 10.0);
    EXPECT_EQ(robust.lowest_m, 0.0);
    // What lies outside of the frame, however far, is simply not seen.
    const Picture p = renderPoints({{1e6, -1e6, 1e6}}, small(0, 0), robust);
    EXPECT_EQ(covered(p), 0.0);
    EXPECT_THROW(frameOf({}, small(0, 0)), std::invalid_argument);
    EXPECT_THROW(frameOf({{NAN, 0, 0}}, small(0, 0)), std::invalid_argument);
    EXPECT_THROW(frameOf(points, small(0, 0), 0.5), std::invalid_argument);
    EXPECT_THROW(frameOf(points, small(0, 100)), std::invalid_argument);
}

TEST(RenderVoxels, ACubeCoversItsOutline) {
    // Face on it is a square; along the diagonal of space, a hexagon of sqrt(3) edge^2.
    const Points centre = {{100, 200, 5}};
    const double diagonal_deg = std::asin(1 / std::sqrt(3.0)) * 180 / M_PI;
    for (const auto& [yaw, pitch, area] :
         {std::array{0.0, 0.0, 1.0}, std::array{90.0, 0.0, 1.0}, std::array{0.0, 90.0, 1.0},
          std::array{45.0, 0.0, std::sqrt(2.0)},
          std::array{45.0, diagonal_deg, std::sqrt(3.0)}}) {
        const View view = small(yaw, pitch);
        const Frame frame = frameOf(cubeCorners(6), view, 0.0);
        const double pixelsPerMetre = 200 * 0.94 / (frame.high - frame.low).x();
        const Picture p = renderVoxels(centre, 3.0, view, frame);
        const double expected = area * std::pow(3.0 * pixelsPerMetre, 2);
        EXPECT_NEAR(blobOf(p).pixels, expected, 0.04 * expected) << yaw << " " << pitch;
    }
    const Frame frame = frameOf(cubeCorners(6), small(30, 30), 0.0);
    EXPECT_GE(blobOf(renderVoxels(centre, 1e-6, small(30, 30), frame)).pixels, 1)
        << "a cube smaller than a pixel is still seen";
    EXPECT_EQ(covered(renderVoxels({{NAN, 0, 0}}, 1.0, small(30, 30), frame)), 0.0);
    EXPECT_THROW(renderVoxels(centre, 0.0, small(30, 30), frame), std::invalid_argument);
    EXPECT_THROW(renderVoxels(centre, NAN, small(30, 30), frame), std::invalid_argument);
}

TEST(RenderPoints, TheNearerIsDrawnWhateverTheOrder) {
    // Looking along +x: the high yellow one of two points in one line of sight is nearer.
    const View view = small(0, 30);
    const double drop = std::tan(M_PI / 6);
    const Eigen::Vector3d near(100, 200, 5), far(104, 200, 5 - 4 * drop);
    const Frame frame = frameOf(cubeCorners(10), view, 0.0);
    const Picture one = renderPoints({near, far}, view, frame);
    EXPECT_EQ(one.rgb, renderPoints({far, near}, view, frame).rgb);
    EXPECT_EQ(blobOf(one).pixels, blobOf(renderPoints({near}, view, frame)).pixels);
    EXPECT_EQ(one.rgb, renderPoints({near}, view, frame).rgb);
    View cut = view;
    cut.cut = 0.55;
    EXPECT_EQ(blobOf(renderPoints({near, far}, cut, frame)).pixels, blobOf(one).pixels);
    EXPECT_NE(renderPoints({near, far}, cut, frame).rgb, one.rgb) << "the far one is seen";
}

TEST(Render, PicturesHaveFewEnoughColoursForAPalette) {
    Points points;
    Mixture<3> mixture;
    for (int i = 0; i < 4000; ++i) {
        points.emplace_back(std::cos(i) * i, std::sin(i) * i, 0.3 * i);
        mixture.pushBack(ball(std::cos(i) * i, std::sin(i) * i, 0.3 * i, 40));
    }
    const View view = small(10, 40);
    const Frame frame = frameOf(points, view);
    for (const Picture& p :
         {renderPoints(points, view, frame), renderVoxels(points, 50, view, frame),
          renderEllipsoids(mixture, view)})
        EXPECT_NE(pngOf(p).find("PLTE"), std::string::npos);
}

}  // namespace
}  // namespace hgmm::evaluation
