#include "scan/ring_interpolation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "base/lattice_table.h"
#include "scan/ray_image.h"

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

/// Rays between a line and the next are within so many standard deviations of a bridge: the
/// next of three lines lies 2.5 from the one in the middle. Rays of the line itself are
/// within the last [sigma].
constexpr double kBetweenLines = 2.4, kOwnLine = 0.3;

/// The next of two lines is within so many of its own [sigma].
constexpr double kNextLines = 4.5;

/// A bridge leads nowhere if so many times more rays cross it than end on its plane.
constexpr int kCrossings = 4;

/// A ray ends behind a plane if it does so by this share of the cell's edge: far more than
/// a plane may be thick.
constexpr double kBehind = 0.25;

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

using Contents = LatticeTable<Content>;
using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

/// What the samples of a cell say of the surface between its line and the next.
struct Bridge {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the plane, unit
    Eigen::Matrix3d wider = Eigen::Matrix3d::Zero();   ///< added to covariances [m^2]
    Eigen::Vector3d line = Eigen::Vector3d::Zero();    ///< of the own samples; zero: none
    double halfLength_m = 0.0;                         ///< of the line [m]
};

/// The bridge over the gaps around the samples of `own`, given the plane in `around`;
/// nothing wider if that is no plane.
Bridge bridge(const Content& own, const Content& around) {
    Solver plane;
    plane.computeDirect(around.scatter());
    const Eigen::Vector3d spread = plane.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    if (spread[0] > kFlatness * spread[1]) return {};
    Bridge result;
    result.normal = plane.eigenvectors().col(0);
    const Eigen::Vector3d ray = around.mean();
    if (std::abs(result.normal.dot(ray)) < kLeastIncidence * ray.norm()) return {};
    const auto widen = [&](const Eigen::Vector3d& direction) {
        result.wider += kBridge * kBridge * direction.dot(around.scatter() * direction) *
                        direction * direction.transpose();
    };
    if (own.count >= 3) {
        Solver lines;
        lines.computeDirect(own.scatter());
        result.line = lines.eigenvectors().col(2);
        result.halfLength_m = std::sqrt(3 * std::max(lines.eigenvalues()[2], 0.0));
    }
    const Eigen::Vector3d across = result.normal.cross(result.line);
    if (across.squaredNorm() > 0.25) {
        widen(across.normalized());
    } else {
        result.line.setZero();
        widen(plane.eigenvectors().col(1));
        widen(plane.eigenvectors().col(2));
    }
    return result;
}

/// Where a ray meets the plane of a bridge.
struct Crossing {
    bool isBeside = false;  ///< beside the line, rather than its ends
    double sigmas2 = 0.0;   ///< squared distance from the line [sigma of the bridge]
};

class BridgedPlane {
 public:
    BridgedPlane(const Bridge& bridge, const Eigen::Vector3d& mean)
        : bridge_(bridge),
          mean_(mean),
          variance_(bridge.wider.trace()),
          offset_(bridge.normal.dot(mean)),
          outwards_(offset_ < 0 ? -bridge.normal : bridge.normal) {}

    double sigma_m() const { return std::sqrt(variance_); }

    /// How far behind the plane a ray ends; before it: negative.
    double behind_m(const RayImage::Ray& ray) const {
        return ray.length_m * outwards_.dot(ray.direction) - std::abs(offset_);
    }

    Crossing at(const RayImage::Ray& ray) const {
        const double towards = bridge_.normal.dot(ray.direction), t = offset_ / towards;
        if (!(t > 0)) return {};
        const Eigen::Vector3d beside = t * ray.direction - mean_;
        if (std::abs(bridge_.line.dot(beside)) > bridge_.halfLength_m) return {};
        // The covariance of a bridge is degenerate.
        return {true, beside.dot(bridge_.wider * beside) / (variance_ * variance_)};
    }

 private:
    const Bridge& bridge_;
    const Eigen::Vector3d& mean_;
    double variance_, offset_;
    Eigen::Vector3d outwards_;  ///< normal, away from the sensor
};

/// Whether rays between the line of a bridge and the next end behind its plane, and few on
/// it: what lies beyond the gap is another surface. The edge of a table top and the floor
/// behind it are no plane.
bool isCrossed(const Bridge& bridge, const Content& own, double edge_m,
               const RayImage& rays) {
    const Eigen::Vector3d mean = own.mean();
    const double range = mean.norm();
    if (!(range > 0)) return false;
    const Eigen::Vector3d u = mean / range;
    const BridgedPlane plane(bridge, mean);
    const auto isWithin = [](const Crossing& c, double sigmas) {
        return c.isBeside && c.sigmas2 <= sigmas * sigmas &&
               c.sigmas2 >= kOwnLine * kOwnLine;
    };
    // Most rays end on the plane.
    const auto crosses = [&](const RayImage::Ray& ray) {
        return plane.behind_m(ray) >= kBehind * edge_m &&
               isWithin(plane.at(ray), kBetweenLines);
    };
    const auto endsOn = [&](const RayImage::Ray& ray) {
        return std::abs(plane.behind_m(ray)) < kBehind * edge_m &&
               isWithin(plane.at(ray), kNextLines);
    };
    const auto coneOf = [&](double sigmas) {
        const double across_m = sigmas * plane.sigma_m(), along_m = bridge.halfLength_m;
        return RayImage::Cone::ofTangent(
            std::sqrt(across_m * across_m + along_m * along_m) / range);
    };
    // Most planes are surfaces. Few rays are long enough to cross them.
    const double nearest = range - kBetweenLines * std::sqrt(u.dot(bridge.wider * u)) -
                           std::abs(bridge.line.dot(u)) * bridge.halfLength_m;
    if (!rays.anyAround(u, coneOf(kBetweenLines), nearest + kBehind * edge_m, crosses))
        return false;
    int crossing = 0, ending = 0;
    rays.visitAround(u, coneOf(kNextLines), 0.0, [&](const RayImage::Ray& ray) {
        crossing += crosses(ray) ? 1 : 0;
        ending += endsOn(ray) ? 1 : 0;
    });
    return crossing > kCrossings * ending;
}

/// Sums of all cells of up to kGapDoublings doublings.
std::array<Contents, kGapDoublings + 1> contentsOf(const Mixture<3>& samples,
                                                   const std::vector<LatticeCell>& cells) {
    std::array<Contents, kGapDoublings + 1> contents;
    contents[0].reserve(samples.size() / 2);
    for (std::size_t i = 0; i < samples.size(); ++i)
        contents[0]
            .tryEmplace(cells[i], {})
            .first->add({samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]});
    for (int d = 1; d <= kGapDoublings; ++d)
        contents[d - 1].forEach([&](const LatticeCell& cell, const Content& content) {
            contents[d].tryEmplace(cell.parent(), {}).first->add(content);
        });
    return contents;
}

/// The bridge of a cell by the smallest cell around it that spreads twice.
Bridge bridgeOf(const LatticeCell& cell,
                const std::array<Contents, kGapDoublings + 1>& contents) {
    LatticeCell around = cell;
    for (int d = 1; d <= kGapDoublings; ++d) {
        around = around.parent();
        const Content& content = *contents[d].find(around);
        if (content.spreadsTwice(kLeastSpread * powerOfTwo(around.octave)))
            return bridge(*contents[0].find(cell), content);
    }
    return {};
}

}  // namespace

void interpolateRings(Mixture<3>& samples, const CellParams& params) {
    std::vector<LatticeCell> cells(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector3d p(samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]);
        cells[i] = LatticeCell::at(p, octaveOf(params.edgeAt(p.norm())));
    }
    const auto contents = contentsOf(samples, cells);
    std::optional<RayImage> rays;  // made when first asked, for dense scans have no gaps
    LatticeTable<Eigen::Matrix3d> wider;
    contents[0].forEach([&](const LatticeCell& cell, const Content& own) {
        const double edge_m = powerOfTwo(cell.octave);
        if (own.spreadsTwice(kLeastSpread * edge_m)) return;
        const Bridge found = bridgeOf(cell, contents);
        if (found.wider.isZero()) return;
        if (!rays) rays.emplace(samples, Eigen::Vector3d::Zero());
        if (!isCrossed(found, own, edge_m, *rays)) wider.tryEmplace(cell, found.wider);
    });
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Matrix3d* found = wider.find(cells[i]);
        if (found == nullptr) continue;
        Gaussian<3> g = samples[i];
        g.covariance += *found;
        samples.set(i, g);
    }
}

}  // namespace hgmm
