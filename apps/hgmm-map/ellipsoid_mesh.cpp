#include "ellipsoid_mesh.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace maptool {
namespace {

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

const Sphere& unitSphere() {
    static const Sphere sphere = subdivided(icosahedron());
    return sphere;
}

Ellipsoid ellipsoidOf(const hgmm::Gaussian<3>& component_local, double sigmas) {
    const Eigen::Matrix3d covariance = component_local.covariance;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    Ellipsoid e{component_local.mean, solver.eigenvectors(),
                sigmas * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt()};
    if (e.axes.determinant() < 0) e.axes.col(0) *= -1.0;  // keeps faces turned outwards
    return e;
}

void appendEllipsoid(const hgmm::Gaussian<3>& component_local,
                     const Eigen::Vector3d& origin_map, double sigmas, std::uint32_t id,
                     hgmm::evaluation::Ply& ply) {
    const Ellipsoid e = ellipsoidOf(component_local, sigmas);
    const auto first = static_cast<std::uint32_t>(ply.vertices.size());
    for (const Eigen::Vector3d& v : unitSphere().vertices) {
        ply.vertices.push_back(origin_map + e.centre_local +
                               e.axes * e.lengths.cwiseProduct(v));
        ply.colours.push_back(hgmm::evaluation::colourOf(id));
        ply.components.push_back(id);
    }
    for (const auto& [a, b, c] : unitSphere().faces)
        ply.faces.push_back({first + a, first + b, first + c});
}

}  // namespace maptool
