#include "hgmm/evaluation/render.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hgmm::evaluation
