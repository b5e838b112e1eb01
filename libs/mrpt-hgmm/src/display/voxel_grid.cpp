#include "hgmm/mrpt_bridge/voxel_grid.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "display/cell_set.h"
#include "hgmm/params.h"

namespace hgmm::mrpt_bridge {

namespace {

/// Beyond, the map has no answer that depends on the component.
constexpr double kSigmas = kReachSigmas;

/// Where a component lies in space, in the map's local frame.
struct Blob {
    Eigen::Vector3d mean;
    Eigen::Matrix3d covariance;
};

template <int D>
std::vector<Blob> blobsOf(const Mixture<D>& mixture) {
    std::vector<Blob> blobs;
    blobs.reserve(mixture.size());
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Gaussian<D> g = mixture[i];
        blobs.push_back(
            {g.mean.template head<3>(), g.covariance.template topLeftCorner<3, 3>()});
    }
    return blobs;
}

/// Where the surface components of a level say that there is free space before them (thesis
/// 4.1): from a component to the end of its band, as wide as the component.
std::vector<Blob> bandsOf(const Map& map, std::size_t level) {
    const OccupancyParams& params = map.params().occupancy;
    const Mixture<3>& surface = map.mixture(level);
    const ViewDirections& views = map.viewDirections(level);
    std::vector<Blob> bands;
    for (std::size_t i = 0; i < surface.size(); ++i) {
        const ViewDirection view = views[i];
        if (!view.known()) continue;
        // A quarter of the reach: within kSigmas lies all of the band that is beside the
        // component by less than sqrt(kSigmas^2 - 2^2) sigma.
        const Eigen::Vector3d half = 0.5 * params.band.reach(view.range_m) * view.direction;
        const Gaussian<3> g = surface[i];
        bands.push_back({g.mean + half, g.covariance + 0.25 * half * half.transpose()});
    }
    return bands;
}

/// Cubes in the local frame; cell (0, 0, 0) is the one nearest to its origin.
struct Lattice {
    double edge_m;
    Eigen::Vector3d corner_map;    // of cell (0, 0, 0)
    Eigen::Vector3d corner_local;  // the same point
    bool oneLayer;                 // cells with z = 0 only

    Cell cellOf(const Eigen::Vector3d& point_map) const {
        const Eigen::Vector3d at = ((point_map - corner_map) / edge_m).array().floor();
        return {std::int32_t(at.x()), std::int32_t(at.y()), std::int32_t(at.z())};
    }
    Eigen::Vector3d centre_map(const Cell& c) const {
        return corner_map + edge_m * Eigen::Vector3d(c.x + 0.5, c.y + 0.5, c.z + 0.5);
    }
};

Lattice latticeOf(const Map& map, double edge_m, const std::optional<double>& height_m) {
    Lattice lattice{edge_m, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                    height_m.has_value()};
    lattice.corner_map = edge_m * (map.origin() / edge_m).array().floor();
    if (height_m) lattice.corner_map.z() = *height_m - 0.5 * edge_m;
    lattice.corner_local = lattice.corner_map - map.origin();
    return lattice;
}

/// The first and last cell whose centre is within `reach` of `middle`, in cells.
std::pair<double, double> cellsWithin(double middle, double reach) {
    return {std::ceil(middle - reach - 0.5), std::floor(middle + reach - 0.5)};
}

/// Calls visit(x, y, z0, z1) for the rows of cells of one blob, widened by half a cell so
/// that cells about a thin one are among them. Returns false, at once, if the blob reaches
/// beyond a CellSet or far more than `maxCells` would be looked at, and when visit does.
template <typename Visitor>
bool forEachLatticeRow(const Blob& blob, const Lattice& lattice, std::size_t maxCells,
                       Visitor&& visit) {
    const Eigen::Vector3d mean = (blob.mean - lattice.corner_local) / lattice.edge_m;
    const Eigen::Matrix3d C = blob.covariance / (lattice.edge_m * lattice.edge_m) +
                              0.25 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d reach = kSigmas * C.diagonal().cwiseSqrt();
    if (lattice.oneLayer && std::abs(mean.z() - 0.5) > reach.z()) return true;
    const Eigen::Vector3d farthest = mean.cwiseAbs() + reach;
    if (!(farthest.maxCoeff() < CellSet::kReach)) return false;
    const double volume =
        4.0 / 3.0 * M_PI * std::pow(kSigmas, 3) * std::sqrt(C.determinant());
    const double rows = 4.0 * reach.x() * reach.y();
    if (lattice.oneLayer ? rows > 4.0 * double(maxCells) : volume > 2.0 * double(maxCells))
        return false;

    const Eigen::Matrix3d P = C.inverse();
    const auto [x0, x1] = cellsWithin(mean.x(), reach.x());
    const auto [y0, y1] = cellsWithin(mean.y(), reach.y());
    for (double x = x0; x <= x1; ++x)
        for (double y = y0; y <= y1; ++y) {
            // d^T P d = kSigmas^2 is a quadratic in d_z.
            const double dx = x + 0.5 - mean.x(), dy = y + 0.5 - mean.y();
            const double b = P(0, 2) * dx + P(1, 2) * dy;
            const double c = P(0, 0) * dx * dx + 2 * P(0, 1) * dx * dy + P(1, 1) * dy * dy -
                             kSigmas * kSigmas;
            const double discriminant = b * b - P(2, 2) * c;
            if (discriminant < 0) continue;
            auto [z0, z1] =
                cellsWithin(mean.z() - b / P(2, 2), std::sqrt(discriminant) / P(2, 2));
            if (lattice.oneLayer) {
                if (z0 > 0 || z1 < 0) continue;
                z0 = z1 = 0;
            }
            if (z0 <= z1 && !visit(std::int32_t(x), std::int32_t(y), std::int32_t(z0),
                                   std::int32_t(z1)))
                return false;
        }
    return true;
}

/// Enters the cells of all blobs; false if there are more than maxCells.
bool enterCells(const std::vector<Blob>& blobs, const Lattice& lattice,
                std::size_t maxCells, CellSet& cells) {
    for (const Blob& blob : blobs) {
        const bool fits = forEachLatticeRow(
            blob, lattice, maxCells,
            [&](std::int32_t x, std::int32_t y, std::int32_t z0, std::int32_t z1) {
                cells.insertRow(x, y, z0, z1);
                return cells.size() <= maxCells;
            });
        if (!fits) return false;
    }
    return true;
}

/// 1, 2 or 5 times a power of ten: the nearest, or the next above.
double roundEdge(double edge_m, bool up) {
    const double decade = std::pow(10.0, std::floor(std::log10(edge_m)));
    for (const double step : {1.0, 2.0, 5.0}) {
        const double next = step == 2.0 ? 5.0 : 2.0 * step;
        if (up ? edge_m < step * decade * (1 - 1e-9)
               : edge_m * edge_m <= step * next * decade * decade)
            return step * decade;
    }
    return 10.0 * decade;
}

/// Median of the middle standard deviation: the extent of a flat component in its surface.
double typicalExtent_m(const std::vector<Blob>& surface) {
    std::vector<double> extents;
    extents.reserve(surface.size());
    for (const Blob& blob : surface)
        extents.push_back(
            std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(
                                        blob.covariance, Eigen::EigenvaluesOnly)
                                        .eigenvalues()[1])));
    const auto middle = extents.begin() + static_cast<std::ptrdiff_t>(extents.size() / 2);
    std::nth_element(extents.begin(), middle, extents.end());
    return std::max(*middle, 1e-3);
}

struct Region {
    Lattice lattice;
    CellSet cells;
};

/// The cells to ask about, at the resolution asked for or derived.
Region regionOf(const Map& map, const VoxelParams& params, const std::vector<Blob>& surface,
                const std::vector<Blob>& freeSpace) {
    const bool derived = params.resolution_m == 0.0;
    const std::size_t maxCells =
        derived ? VoxelParams::kMaxDerivedCells : VoxelParams::kMaxCells;
    double edge_m =
        derived ? roundEdge(typicalExtent_m(surface), false) : params.resolution_m;
    for (;; edge_m = roundEdge(1.01 * edge_m, true)) {
        Region region{latticeOf(map, edge_m, params.height_m), {}};
        if (enterCells(surface, region.lattice, maxCells, region.cells) &&
            enterCells(freeSpace, region.lattice, maxCells, region.cells))
            return region;
        if (!derived)
            throw std::invalid_argument("a resolution of " + std::to_string(edge_m) +
                                        " m makes more than " + std::to_string(maxCells) +
                                        " voxels of this map: choose a larger one");
    }
}

/// Answers at many points, keeping the highest P(occ) of each cell.
class CellAnswers {
 public:
    struct Best {
        Occupancy answer;
        Eigen::Vector3d place_map;
    };

    CellAnswers(const Map& map, std::size_t level, std::size_t cells)
        : map_(map), level_(level), best_(cells) {
        for (Best& best : best_) best.answer.occupied = -1.F;
    }
    void ask(std::size_t cell, const Eigen::Vector3d& point_map) {
        cells_.push_back(cell);
        points_.push_back(point_map);
        if (points_.size() == kBatch) flush();
    }
    std::vector<Best> take() {
        flush();
        return std::move(best_);
    }

 private:
    static constexpr std::size_t kBatch = std::size_t{1} << 16U;

    void flush() {
        answers_.resize(points_.size());
        map_.occupancy(points_.data(), points_.size(), answers_.data(), level_);
        for (std::size_t i = 0; i < cells_.size(); ++i)
            if (answers_[i].occupied > best_[cells_[i]].answer.occupied)
                best_[cells_[i]] = {answers_[i], points_[i]};
        cells_.clear();
        points_.clear();
    }

    const Map& map_;
    std::size_t level_;
    std::vector<Best> best_;
    std::vector<Occupancy> answers_;
    std::vector<std::size_t> cells_;
    std::vector<Eigen::Vector3d> points_;
};

/// Asks where one component may slip between the centres of cells: at its mean, and where
/// its mid-plane comes nearest to the centres of the cells that it crosses.
void askMidPlane(const Blob& blob, const Region& region, CellAnswers& answers) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(blob.covariance);
    const Lattice& lattice = region.lattice;
    const double thickness_m = std::sqrt(std::max(0.0, axes.eigenvalues()[0]));
    if (thickness_m > lattice.edge_m) return;
    const Eigen::Vector3d normal = axes.eigenvectors().col(0);
    const Eigen::Vector3d mean_map = blob.mean + lattice.corner_map - lattice.corner_local;
    const std::size_t meansCell = region.cells.indexOf(lattice.cellOf(mean_map));
    if (meansCell < region.cells.size()) answers.ask(meansCell, mean_map);
    forEachLatticeRow(
        blob, lattice, VoxelParams::kMaxCells,
        [&](std::int32_t x, std::int32_t y, std::int32_t z0, std::int32_t z1) {
            for (std::int32_t z = z0; z <= z1; ++z) {
                const Eigen::Vector3d centre = lattice.centre_map({x, y, z});
                const Eigen::Vector3d shift = normal.dot(mean_map - centre) * normal;
                if (shift.cwiseAbs().maxCoeff() <= 0.5 * lattice.edge_m)
                    answers.ask(region.cells.indexOf({x, y, z}), centre + shift);
            }
            return true;
        });
}

}  // namespace

void VoxelParams::validate() const {
    if (resolution_m != 0.0) requireInRange("resolution_m", resolution_m, 1e-4, 1e4);
    requireInRange("minOccupied", minOccupied, 0.01, 0.99);
    if (height_m) requireInRange("height_m", *height_m, -1e7, 1e7);
}

VoxelGrid voxelise(const Map& map, const VoxelParams& params) {
    params.validate();
    const std::vector<Blob> surface = blobsOf(map.mixture(params.level));
    if (surface.empty()) return {};
    std::vector<Blob> freeSpace;
    if (params.free) {
        freeSpace = blobsOf(map.freeMixture(params.level));
        const std::vector<Blob> bands = bandsOf(map, params.level);
        freeSpace.insert(freeSpace.end(), bands.begin(), bands.end());
    }
    Region region = regionOf(map, params, surface, freeSpace);

    const std::vector<Cell> cells = region.cells.enumerate();
    CellAnswers answers(map, params.level, cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
        answers.ask(i, region.lattice.centre_map(cells[i]));
    for (const Blob& blob : surface) askMidPlane(blob, region, answers);

    const std::vector<CellAnswers::Best> best = answers.take();
    VoxelGrid grid{region.lattice.edge_m, {}};
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Occupancy& answer = best[i].answer;
        const bool occupied = answer.occupied >= params.minOccupied;
        if (occupied ? params.occupied : params.free && answer.free > 0.5F)
            grid.voxels.push_back(
                {region.lattice.centre_map(cells[i]), answer, best[i].place_map, occupied});
    }
    return grid;
}

}  // namespace hgmm::mrpt_bridge
