#include "cell_map/cell_surfaces.h"

#include "hgmm/em.h"
#include "scan/cells.h"

namespace hgmm {

namespace {

using Cell = CellSet::Cell;

/// Edge of a tile of the first guess [cells]: between the 2.75 and 5.5 leaves that the
/// cells of a scan's guess have.
constexpr int kTileShift = 2;

/// Standard deviation of a face's hit [cells]: knownSigmas of it end between the border of
/// the cell and the middle of the next, which may be unknown.
constexpr double kHitSigma = 0.2;

LatticeCell tileOf(const Cell& c) {
    return {0, c[0] >> kTileShift, c[1] >> kTileShift, c[2] >> kTileShift};
}

LatticeCell keyOf(const Cell& c) {
    return {0, c[0], c[1], c[2]};
}

/// The part of its tile that each sample belongs to: parts are sets of cells that touch at
/// least at a corner.
std::vector<std::uint32_t> partsOfTiles(const std::vector<Cell>& cells) {
    constexpr auto kNone = ~std::uint32_t{0};
    LatticeTable<std::uint32_t> sampleAt;
    sampleAt.reserve(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
        sampleAt.tryEmplace(keyOf(cells[i]), static_cast<std::uint32_t>(i));
    std::vector<std::uint32_t> partOf(cells.size(), kNone), open;
    std::uint32_t parts = 0;
    for (std::size_t first = 0; first < cells.size(); ++first) {
        if (partOf[first] != kNone) continue;
        partOf[first] = parts;
        open.assign(1, static_cast<std::uint32_t>(first));
        while (!open.empty()) {
            const Cell c = cells[open.back()];
            open.pop_back();
            for (int k = 0; k < 27; ++k) {
                const Cell next{c[0] + k % 3 - 1, c[1] + k / 3 % 3 - 1, c[2] + k / 9 - 1};
                if (!(tileOf(next) == tileOf(c))) continue;
                const std::uint32_t* const found = sampleAt.find(keyOf(next));
                if (found == nullptr || partOf[*found] != kNone) continue;
                partOf[*found] = parts;
                open.push_back(*found);
            }
        }
        ++parts;
    }
    return partOf;
}

}  // namespace

std::vector<CellSamples> outerFaces(const CellSet& occupied, const CellSet& free,
                                    double edge_m, const Pose& T_local_cells) {
    std::vector<CellSamples> sides(7);
    for (int side = 0; side < 6; ++side)
        sides[side].direction =
            T_local_cells.R.col(side / 2) * (side % 2 == 0 ? 1.0 : -1.0);
    occupied.forEach([&](const Cell& cell) {
        Gaussian<3> sample;
        sample.support = 1.0;
        sample.mean =
            T_local_cells.R *
                ((Eigen::Vector3d(cell[0], cell[1], cell[2]).array() + 0.5) * edge_m)
                    .matrix() +
            T_local_cells.t;
        sample.covariance =
            Eigen::Matrix3d::Identity() * (kHitSigma * kHitSigma * edge_m * edge_m);
        bool isOuter = false;
        for (int side = 0; side < 7; ++side) {
            Cell beside = cell;
            if (side < 6) beside[side / 2] += side % 2 == 0 ? 1 : -1;
            if (side == 6 ? isOuter : !free.contains(beside)) continue;
            isOuter = true;
            sides[side].samples.pushBack(sample);
            sides[side].cells.push_back(cell);
        }
    });
    return sides;
}

CellSamples pointSamples(const std::vector<Eigen::Vector3d>& points_local, double edge_m,
                         double noise_m) {
    CellSamples result;
    std::vector<Gaussian<3>> moments;
    LatticeTable<std::uint32_t> numbers;
    for (const Eigen::Vector3d& p : points_local) {
        Gaussian<3> point;
        point.support = 1.0;
        point.mean = p;
        point.covariance = Eigen::Matrix3d::Identity() * (noise_m * noise_m);
        const Eigen::Vector3d inCells = p / edge_m;
        const Cell cell{floorToInt(inCells.x()), floorToInt(inCells.y()),
                        floorToInt(inCells.z())};
        const auto [number, isNew] =
            numbers.tryEmplace(keyOf(cell), static_cast<std::uint32_t>(moments.size()));
        if (isNew) {
            moments.push_back(point);
            result.cells.push_back(cell);
        } else {
            moments[*number] = mergeMoments(moments[*number], point);
        }
    }
    for (const Gaussian<3>& g : moments) result.samples.pushBack(g);
    return result;
}

Mixture<3> fitSurfaces(const CellSamples& surfaces, const EmParams& params) {
    if (surfaces.samples.empty()) return {};
    CellMoments guess;
    guess.componentOf = partsOfTiles(surfaces.cells);
    for (std::size_t i = 0; i < surfaces.samples.size(); ++i) {
        const std::uint32_t c = guess.componentOf[i];
        if (c == guess.components.size())
            guess.components.push_back(surfaces.samples[i]);
        else
            guess.components[c] = mergeMoments(guess.components[c], surfaces.samples[i]);
    }
    const InitialMixture initial = initialMixture(surfaces.samples, guess);
    return fitSparse(surfaces.samples, initial.mixture, initial.neighbourhoods, params)
        .mixture;
}

}  // namespace hgmm
