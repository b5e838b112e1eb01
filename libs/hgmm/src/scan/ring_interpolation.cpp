#include "scan/ring_interpolation.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <unordered_map>

#include "base/lattice.h"

namespace hgmm {

namespace {

constexpr int kGapDoublings = 3;

/// Samples spread in a direction if they do so by at least this share of the cell's edge,
/// one standard deviation; evenly filled, it is 0.29.
constexpr double kLeastSpread = 0.1;

/// A plane is at most this thick, as a share of its second spread.
constexpr double kFlatness = 0.1;

/// Two lines of samples at a distance g spread by g / 2, three by 0.8 g; Gaussians that
/// meet spread by 0.29 g each.
constexpr double kBridge = 0.5;

/// A plane is seen at no less than this angle [rad]: the points of one that holds the
/// sensor lie in it because the rays do, as all those of a planar laser, not because they
/// hit it.
constexpr double kLeastIncidence = 0.01;

/// Scatter of the sample means in a cell.
struct Content {
    int count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d sumOuter = Eigen::Matrix3d::Zero();

    void add(const Eigen::Vector3d& p) {
        ++count;
        sum += p;
        sumOuter += p * p.transpose();
    }
    void add(const Content& o) {
        count += o.count;
        sum += o.sum;
        sumOuter += o.sumOuter;
    }
    Eigen::Vector3d mean() const { return sum / count; }
    Eigen::Matrix3d scatter() const {
        const Eigen::Vector3d centre = mean();
        return sumOuter / count - centre * centre.transpose();
    }
    /// Whether two of the standard deviations are at least `least`; without eigenvalues,
    /// for it is asked for every cell: the sum of the principal 2 x 2 minors is about the
    /// product of the two largest variances.
    bool spreadsTwice(double least) const {
        if (count < 3) return false;
        const Eigen::Matrix3d s = scatter();
        const double minors = s(0, 0) * s(1, 1) - s(0, 1) * s(0, 1) + s(0, 0) * s(2, 2) -
                              s(0, 2) * s(0, 2) + s(1, 1) * s(2, 2) - s(1, 2) * s(1, 2);
        return minors > least * least * s.trace();
    }
};

using Contents = std::unordered_map<LatticeCell, Content, LatticeCellHash>;
using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

/// Covariance that bridges the gaps around the samples of `own`, given the plane in
/// `around`; zero if that is no plane.
Eigen::Matrix3d bridge(const Content& own, const Content& around) {
    Solver plane;
    plane.computeDirect(around.scatter());
    const Eigen::Vector3d spread = plane.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    if (spread[0] > kFlatness * spread[1]) return Eigen::Matrix3d::Zero();
    const Eigen::Vector3d normal = plane.eigenvectors().col(0);
    const Eigen::Vector3d ray = around.mean();
    if (std::abs(normal.dot(ray)) < kLeastIncidence * ray.norm())
        return Eigen::Matrix3d::Zero();
    Eigen::Matrix3d wider = Eigen::Matrix3d::Zero();
    const auto widen = [&](const Eigen::Vector3d& direction) {
        wider += kBridge * kBridge * direction.dot(around.scatter() * direction) *
                 direction * direction.transpose();
    };
    Eigen::Vector3d line = Eigen::Vector3d::Zero();
    if (own.count >= 3) {
        Solver lines;
        lines.computeDirect(own.scatter());
        line = lines.eigenvectors().col(2);
    }
    const Eigen::Vector3d across = normal.cross(line);
    if (across.squaredNorm() > 0.25) {
        widen(across.normalized());
    } else {
        widen(plane.eigenvectors().col(1));
        widen(plane.eigenvectors().col(2));
    }
    return wider;
}

}  // namespace

void interpolateRings(Mixture<3>& samples, const CellParams& params) {
    std::array<Contents, kGapDoublings + 1> contents;
    std::vector<LatticeCell> cells(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector3d p(samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]);
        cells[i] = LatticeCell::at(p, octaveOf(params.edgeAt(p.norm())));
        contents[0][cells[i]].add(p);
    }
    std::unordered_map<LatticeCell, Eigen::Matrix3d, LatticeCellHash> bridges;
    for (const auto& [cell, own] : contents[0])
        if (!own.spreadsTwice(kLeastSpread * powerOfTwo(cell.octave)))
            bridges.emplace(cell, Eigen::Matrix3d::Zero());
    if (bridges.empty()) return;

    for (int d = 1; d <= kGapDoublings; ++d)
        for (const auto& [cell, content] : contents[d - 1])
            contents[d][cell.parent()].add(content);
    for (auto& [cell, wider] : bridges) {
        LatticeCell around = cell;
        for (int d = 1; d <= kGapDoublings; ++d) {
            around = around.parent();
            const Content& content = contents[d].at(around);
            if (!content.spreadsTwice(kLeastSpread * powerOfTwo(around.octave))) continue;
            wider = bridge(contents[0].at(cell), content);
            break;
        }
    }
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto found = bridges.find(cells[i]);
        if (found == bridges.end()) continue;
        Gaussian<3> g = samples[i];
        g.covariance += found->second;
        samples.set(i, g);
    }
}

}  // namespace hgmm
