#include "ellipsoid_mesh.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace maptool {
namespace {

using Face = std::array<std::uint32_t, 3>;

struct Sphere {
    std::vector<Eigen::Vector3d> vertices;
    std::vector<Face> faces;
};

/// The icosahedron, counter-clockwise from outside: two poles and two rings of five.
Sphere icosahedron() {
    Sphere s;
    const double z = 1.0 / std::sqrt(5.0), r = 2.0 * z;
    s.vertices.emplace_back(0, 0, 1);
    for (int ring = 0; ring < 2; ++ring)
        for (int k = 0; k < 5; ++k) {
            const double angle = (2 * k + ring) * M_PI / 5.0;
            s.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle),
                                    ring ? -z : z);
        }
    s.vertices.emplace_back(0, 0, -1);
    for (std::uint32_t k = 0; k < 5; ++k) {
        const std::uint32_t next = (k + 1) % 5;
        const std::uint32_t a = 1 + k, b = 1 + next, c = 6 + k, d = 6 + next;
        s.faces.push_back({0, a, b});
        s.faces.push_back({a, c, b});
        s.faces.push_back({b, c, d});
        s.faces.push_back({11, d, c});
    }
    return s;
}

/// Each triangle in four, new vertices on the unit sphere.
Sphere subdivided(const Sphere& coarse) {
    Sphere fine{coarse.vertices, {}};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, isNew] =
            middles.try_emplace(std::minmax(a, b), std::uint32_t(fine.vertices.size()));
        if (isNew)
            fine.vertices.push_back((coarse.vertices[a] + coarse.vertices[b]).normalized());
        return at->second;
    };
    for (const auto& [a, b, c] : coarse.faces) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        fine.faces.insert(fine.faces.end(),
                          {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    return fine;
}

}  // namespace

void appendEllipsoid(const hgmm::Gaussian<3>& component_local,
                     const Eigen::Vector3d& origin_map, double sigmas, std::uint32_t id,
                     hgmm::evaluation::Ply& ply) {
    static const Sphere sphere = subdivided(icosahedron());
    const Eigen::Matrix3d covariance = component_local.covariance;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    Eigen::Matrix3d axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(0) *= -1.0;  // keeps the faces turned outwards
    const Eigen::Vector3d lengths = sigmas * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    const Eigen::Vector3d centre = origin_map + component_local.mean;

    const auto first = static_cast<std::uint32_t>(ply.vertices.size());
    for (const Eigen::Vector3d& v : sphere.vertices) {
        ply.vertices.push_back(centre + axes * lengths.cwiseProduct(v));
        ply.colours.push_back(hgmm::evaluation::colourOf(id));
        ply.components.push_back(id);
    }
    for (const auto& [a, b, c] : sphere.faces)
        ply.faces.push_back({first + a, first + b, first + c});
}

}  // namespace maptool
