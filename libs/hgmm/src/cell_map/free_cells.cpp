#include "cell_map/free_cells.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mixture/regularized.h"

namespace hgmm {

namespace {

using Cell = CellSet::Cell;

/// The coarsest lattice of coverage: edges of half a metre, as scans mark at most.
constexpr int kCoarsest = -1;
/// The finest one has edges of at most this share of a free cell's: the nearest of its
/// centres beyond a border of free cells, seen from the centre of the last of these, weighs
/// so little that C > 1/2 here, and C < 1/2 beyond.
constexpr double kFinestShare = 0.7;
/// Free components gather cells that touch occupied ones in cubes of about so many cells
/// along an edge, and the others in larger ones.
constexpr double kSmallTile = 4.0, kLargeTile = 16.0;
/// Surfaces farther away than this are not looked for [cells].
constexpr std::int32_t kFarthestSurface = 128;

Eigen::Vector3d centreOf(const Cell& c, double edge_m) {
    return (Eigen::Vector3d(c[0], c[1], c[2]).array() + 0.5) * edge_m;
}

Cell cellAt(const Eigen::Vector3d& p_cells, double edge_m) {
    const LatticeCell cell = LatticeCell::at(p_cells / edge_m, 0);
    return {cell.x, cell.y, cell.z};
}

/// Sees lattices of coverage as cells of a set.
class FreeLattice {
 public:
    FreeLattice(const CellSet& free, double edge_m, const Pose& T_local_cells)
        : free_(free), edge_m_(edge_m), T_cells_local_(T_local_cells.inverse()) {}

    enum class Share { none, some, all };
    Share shareOf(const LatticeCell& cell) const {
        const double half_m = powerOfTwo(cell.octave) / 2;
        // The box around a cube that may be turned, less what rounding adds to it.
        const Eigen::Vector3d reach_m =
            T_cells_local_.R.cwiseAbs().rowwise().sum() * (half_m * (1 - 1e-9));
        const Eigen::Vector3d centre = centreIn(cell);
        const Cell low = cellAt(centre - reach_m, edge_m_),
                   high = cellAt(centre + reach_m, edge_m_);
        if (free_.containsAll(low, high)) return Share::all;
        return free_.containsAny(low, high) ? Share::some : Share::none;
    }
    bool hasCentreOf(const LatticeCell& cell) const {
        return free_.contains(cellAt(centreIn(cell), edge_m_));
    }

 private:
    Eigen::Vector3d centreIn(const LatticeCell& cell) const {
        return T_cells_local_.R *
                   centreOf({cell.x, cell.y, cell.z}, powerOfTwo(cell.octave)) +
               T_cells_local_.t;
    }

    const CellSet& free_;
    double edge_m_;
    Pose T_cells_local_;
};

/// The cells of a lattice that may hold a free cell.
std::vector<LatticeCell> around(const CellSet& free, double edge_m,
                                const Pose& T_local_cells, int octave) {
    const double reach_m = edge_m * std::sqrt(3.0) / 2;
    Coverage found;
    free.forEach([&](const Cell& c) {
        const Eigen::Vector3d centre =
            T_local_cells.R * centreOf(c, edge_m) + T_local_cells.t;
        const LatticeCell low = LatticeCell::at(centre.array() - reach_m, octave);
        const LatticeCell high = LatticeCell::at(centre.array() + reach_m, octave);
        for (std::int32_t z = low.z; z <= high.z; ++z)
            for (std::int32_t y = low.y; y <= high.y; ++y)
                for (std::int32_t x = low.x; x <= high.x; ++x)
                    found.mark(LatticeCell{octave, x, y, z});
    });
    std::vector<LatticeCell> cells;
    found.forEachBlock([&](const LatticeCell& block, Coverage::Word word) {
        for (; word != 0; word &= word - 1) {
            const int bit = __builtin_ctzll(word);
            cells.push_back({octave, block.x * 4 + (bit & 3), block.y * 4 + (bit >> 2 & 3),
                             block.z * 4 + (bit >> 4)});
        }
    });
    return cells;
}

/// Appends the eighths of a cell in which its lattice does not say C = 1 already.
void appendUncovered(const LatticeCell& cell, const Coverage& coverage,
                     std::vector<LatticeCell>& finer) {
    for (int k = 0; k < 8; ++k) {
        const LatticeCell part{cell.octave - 1, 2 * cell.x + (k & 1),
                               2 * cell.y + (k >> 1 & 1), 2 * cell.z + (k >> 2)};
        const Eigen::Vector3d centre =
            centreOf({part.x, part.y, part.z}, powerOfTwo(part.octave));
        if (coverage.at(centre.data()) < 1.0) finer.push_back(part);
    }
}

/// To the nearest occupied one of the 26 cells around a cell [cells]; 0 if none is.
double distanceToNeighbours(const Cell& c, const CellSet& occupied) {
    // Most cells have none.
    if (!occupied.containsAny({c[0] - 1, c[1] - 1, c[2] - 1},
                              {c[0] + 1, c[1] + 1, c[2] + 1}))
        return 0.0;
    int nearest = 4;
    for (int k = 0; k < 27; ++k) {
        const int x = k % 3 - 1, y = k / 3 % 3 - 1, z = k / 9 - 1;
        const int squared = x * x + y * y + z * z;
        if (squared < nearest && occupied.contains({c[0] + x, c[1] + y, c[2] + z}))
            nearest = squared;
    }
    return std::sqrt(nearest);
}

/// Half the edge of the first of growing cubes around a cell that holds an occupied one
/// [cells].
double distanceAround(const Cell& c, const CellSet& occupied) {
    std::int32_t reach = 2;
    for (; reach < kFarthestSurface; reach *= 2) {
        const Cell low{c[0] - reach, c[1] - reach, c[2] - reach};
        if (occupied.containsAny(low, {c[0] + reach, c[1] + reach, c[2] + reach})) break;
    }
    return reach;
}

/// Sums of cells by the cubes of lattices that they are in.
struct Tiles {
    LatticeTable<std::uint32_t> numbers;
    std::vector<LatticeCell> lattice;
    std::vector<Gaussian<4>> sums;
    std::vector<Cell> firstCells;

    void add(const Gaussian<4>& cell, int octave, const Cell& c) {
        const LatticeCell tile = LatticeCell::at(cell.mean.head<3>(), octave);
        const auto [number, isNew] =
            numbers.tryEmplace(tile, static_cast<std::uint32_t>(sums.size()));
        if (!isNew) {
            sums[*number] = mergeMoments(sums[*number], cell);
            return;
        }
        lattice.push_back(tile);
        sums.push_back(cell);
        firstCells.push_back(c);
    }
};

}  // namespace

Coverage coverageOf(const CellSet& free, double edge_m, const Pose& T_local_cells) {
    const int finest = octaveOf(kFinestShare * edge_m);
    const FreeLattice lattice(free, edge_m, T_local_cells);
    Coverage coverage;
    int octave = std::max(finest, kCoarsest);
    std::vector<LatticeCell> cells = around(free, edge_m, T_local_cells, octave);
    for (; octave > finest; --octave) {
        std::vector<LatticeCell> reaching;
        for (const LatticeCell& cell : cells) {
            const FreeLattice::Share share = lattice.shareOf(cell);
            if (share != FreeLattice::Share::none) reaching.push_back(cell);
            if (share == FreeLattice::Share::all) coverage.mark(cell);
        }
        cells.clear();
        for (const LatticeCell& cell : reaching) appendUncovered(cell, coverage, cells);
    }
    for (const LatticeCell& cell : cells)
        if (lattice.hasCentreOf(cell)) coverage.mark(cell);
    return coverage;
}

FreeSpace freeComponents(const CellSet& occupied, const CellSet& free, double edge_m,
                         const Pose& T_local_cells) {
    Tiles tiles;
    const int small = octaveOf(kSmallTile * edge_m), large = octaveOf(kLargeTile * edge_m);
    free.forEach([&](const Cell& c) {
        const double distance = distanceToNeighbours(c, occupied);
        Gaussian<4> cell;
        cell.support = 1.0;
        cell.mean.head<3>() = T_local_cells.R * centreOf(c, edge_m) + T_local_cells.t;
        cell.mean[3] = edge_m * distance;
        cell.covariance = Eigen::Matrix4d::Identity() * (edge_m * edge_m / 12);
        tiles.add(cell, distance > 0 ? small : large, c);
    });
    FreeSpace space;
    space.reserve(tiles.sums.size());
    for (std::size_t i = 0; i < tiles.sums.size(); ++i) {
        Gaussian<4> sum = tiles.sums[i];
        if (sum.mean[3] == 0) {
            sum.mean[3] = edge_m * distanceAround(tiles.firstCells[i], occupied);
            sum.covariance(3, 3) = sum.mean[3] * sum.mean[3] / 4;
        }
        space.pushBack(regularized(sum), tiles.lattice[i].octave);
    }
    return space;
}

}  // namespace hgmm
