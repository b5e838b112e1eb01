#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "occupancy/band_kernels.h"
#include "occupancy/coverage_reader.h"
#include "occupancy/occupancy_model.h"

namespace hgmm {

namespace {

using bands::kBlock;
using bands::LaneSet;

/// Calls visit(k) for the lanes of a set, rising.
template <typename Visitor>
void forEachLane(LaneSet set, Visitor&& visit) {
    for (; set != 0; set &= set - 1) visit(__builtin_ctzll(set));
}

/// Components of the cell of one octave that holds the last point.
template <typename Block>
struct PackedCell {
    int octave;
    BoxCells::Cell cell;
    bool isFilled = false;
    std::size_t used = 0;       ///< of `blocks`
    std::vector<Block> blocks;  ///< in the order of the index

    explicit PackedCell(int ofOctave) : octave(ofOctave), cell() {}
    /// Adds a component. Returns its lane.
    std::pair<Block*, int> add(std::uint32_t id) {
        if (used == 0 || blocks[used - 1].n == kBlock) {
            if (used == blocks.size()) blocks.emplace_back();
            blocks[used++].clear();
        }
        Block& block = blocks[used - 1];
        block.ids[block.n] = id;
        return {&block, block.n++};
    }
};

/// The cells of a point, by the one of the smallest octave.
class FinestCell {
 public:
    FinestCell(const std::array<float, 3>& point, int octave)
        : point_(point), octave_(octave), cell_(BoxCells::cellOf(point, octave)) {
        // Where numbers of cells end, and where those of large cells would be denormal.
        for (int d = 0; d < 3; ++d)
            isSpecial_ |= std::abs(cell_[d]) >= BoxCells::kLimit ||
                          (std::abs(point[d]) < 1e-20F && point[d] != 0);
    }
    /// BoxCells::cellOf(point, octave), octave >= the smallest.
    BoxCells::Cell at(int octave) const {
        if (isSpecial_) return BoxCells::cellOf(point_, octave);
        const int doublings = std::min(octave - octave_, 31);  // what is left is the sign
        return {cell_[0] >> doublings, cell_[1] >> doublings, cell_[2] >> doublings};
    }

 private:
    const std::array<float, 3>& point_;
    int octave_;
    BoxCells::Cell cell_;
    bool isSpecial_ = false;
};

template <typename Block>
std::vector<PackedCell<Block>> cellsOf(const BoxIndex<0>& index) {
    std::vector<PackedCell<Block>> cells;
    for (const int octave : index.octaves()) cells.emplace_back(octave);
    return cells;
}

/// Makes cells those of a point.
/// @param pack pack(block, lane, id) fills the lane of a component
template <typename Block, typename Pack>
void follow(const BoxIndex<0>& index, const std::array<float, 3>& point,
            std::vector<PackedCell<Block>>& cells, Pack&& pack) {
    if (cells.empty()) return;
    const FinestCell finest(point, cells.front().octave);
    for (PackedCell<Block>& packed : cells) {
        const BoxCells::Cell cell = finest.at(packed.octave);
        if (packed.isFilled && cell == packed.cell) continue;
        packed.cell = cell;
        packed.isFilled = true;
        packed.used = 0;
        index.visitCell(packed.octave, cell, [&](std::uint32_t i) {
            const auto [block, lane] = packed.add(i);
            pack(*block, lane, i);
        });
    }
}

}  // namespace

/// Most of what a point costs is finding and gathering its components. Points of the same
/// cells have the same ones. Answers have the same bits as those of single points: lanes do
/// not depend on each other, and sums have the same order.
class OccupancyModel::Nearby {
 public:
    explicit Nearby(const OccupancyModel& model)
        : model_(model),
          bandCells_(cellsOf<BandBlock>(model.bandBoxes_)),
          freeCells_(cellsOf<FreeBlock>(model.freeBoxes_)) {}

    /// As OccupancyModel::sums(x).
    Sums<double> sums(const double* x);

 private:
    struct BandBlock {
        int n;
        LaneSet gathered;   ///< lanes whose bands are there: most are never asked
        LaneSet hasBeyond;  ///< lanes whose coverage beyond is there
        std::uint32_t ids[kBlock];
        bands::Boxes boxes;
        bands::Lanes lanes;
        float viewPrecision[kBlock];  ///< [1/m^2]
        double beyond[kBlock];        ///< C(x) beyond the surface

        void clear() { n = 0, gathered = hasBeyond = 0; }
    };
    struct FreeBlock {
        int n;
        std::uint32_t ids[kBlock];
        bands::Bodies bodies;

        void clear() { n = 0; }
    };
    /// A lane of a block.
    struct Felt {
        BandBlock* block;
        int lane;
    };

    void gather(BandBlock& block, LaneSet lanes) const;
    void feel(BandBlock& block, int lane);
    void addFelt(Sums<double>& sums);
    double coverageBeyond(const Felt& felt) const;
    void addFree(const double* x, const std::array<float, 3>& point, Sums<double>& sums);

    const OccupancyModel& model_;
    const bands::Kernel& kernel_ = bands::kernel();
    std::vector<PackedCell<BandBlock>> bandCells_;
    std::vector<PackedCell<FreeBlock>> freeCells_;
    int felt_ = 0;  ///< lanes in use
    Felt feltOf_[kBlock];
    bands::Lanes feltLanes_{};
    bands::Places feltPlaces_{}, places_{};
    bands::Densities densities_{};
};

void OccupancyModel::Nearby::gather(BandBlock& block, LaneSet lanes) const {
    forEachLane(lanes & ~block.gathered, [&](int k) {
        const float precision = model_.gatherPlace(block.ids[k], block.lanes, k);
        block.viewPrecision[k] = precision;
        model_.gatherBand(model_.bandOf(block.ids[k], precision), block.lanes, k);
    });
    block.gathered |= lanes;
}

/// Takes a band for addFelt(). places_ has where the point is seen from it.
void OccupancyModel::Nearby::feel(BandBlock& block, int lane) {
    const bands::Lanes& from = block.lanes;
    const int k = felt_++;
    feltOf_[k] = {&block, lane};
    feltPlaces_.beside[k] = places_.beside[lane];
    feltPlaces_.height[k] = places_.height[lane];
    feltLanes_.tau[k] = from.tau[lane];
    feltLanes_.peak[k] = from.peak[lane];
    feltLanes_.sharpness[k] = from.sharpness[lane];
    feltLanes_.reach[k] = from.reach[lane];
    feltLanes_.width[k] = from.width[lane];
    feltLanes_.freePerMetre[k] = from.freePerMetre[lane];
}

double OccupancyModel::Nearby::coverageBeyond(const Felt& felt) const {
    BandBlock& block = *felt.block;
    const LaneSet lane = LaneSet{1} << felt.lane;
    if ((block.hasBeyond & lane) == 0) {
        block.beyond[felt.lane] = model_.coverageBeyond(block.ids[felt.lane]);
        block.hasBeyond |= lane;
    }
    return block.beyond[felt.lane];
}

void OccupancyModel::Nearby::addFelt(Sums<double>& sums) {
    kernel_.evaluate(feltLanes_, feltPlaces_, felt_, float(kCutDensity), densities_);
    for (int k = 0; k < felt_; ++k) {
        const Felt& felt = feltOf_[k];
        addDensities(densities_, k, sums);
        const std::uint32_t id = felt.block->ids[felt.lane];
        const Side<double> side =
            model_.sideOf(id, felt.block->viewPrecision[felt.lane],
                          double(feltPlaces_.height[k]), double(feltPlaces_.beside[k]));
        if (!(side.share > 0)) continue;
        if (side.isFront)
            sums.sides.addFront(side.share);
        else
            sums.sides.addBehind(side.share, model_.viewOf(id), coverageBeyond(felt));
    }
    felt_ = 0;
}

OccupancyModel::Sums<double> OccupancyModel::Nearby::sums(const double* x) {
    std::array<float, 3> point{}, rest{};
    for (int d = 0; d < 3; ++d) {
        point[d] = static_cast<float>(x[d]);
        rest[d] = static_cast<float>(x[d] - double(point[d]));
    }
    follow(model_.bandBoxes_, point, bandCells_,
           [&](BandBlock& block, int lane, std::uint32_t i) {
               for (int d = 0; d < 3; ++d) {
                   block.boxes.centre[d][lane] = model_.boxes_[i].centre[d];
                   block.boxes.halfExtent[d][lane] = model_.boxes_[i].halfExtent[d];
               }
           });
    Sums<double> sums;
    for (PackedCell<BandBlock>& cell : bandCells_)
        for (std::size_t b = 0; b < cell.used; ++b) {
            BandBlock& block = cell.blocks[b];
            const LaneSet inside = kernel_.inside(block.boxes, block.n, point.data());
            if (inside == 0) continue;
            gather(block, inside);
            forEachLane(kernel_.placeNear(block.lanes, inside, point.data(), rest.data(),
                                          float(kReach2), places_),
                        [&](int lane) {
                            feel(block, lane);
                            if (felt_ == kBlock) addFelt(sums);
                        });
        }
    addFelt(sums);
    addFree(x, point, sums);
    return sums;
}

void OccupancyModel::Nearby::addFree(const double* x, const std::array<float, 3>& point,
                                     Sums<double>& sums) {
    follow(model_.freeBoxes_, point, freeCells_,
           [&](FreeBlock& block, int lane, std::uint32_t i) {
               const WhitenedGaussian<3, float>& place = model_.freeJoints_[i].place;
               for (int row = 0, entry = 0; row < 3; ++row) {
                   block.bodies.mean[row][lane] = place.mean(row);
                   for (int col = 0; col <= row; ++col)
                       block.bodies.factor[entry++][lane] = place.factor(row, col);
               }
           });
    std::uint32_t ids[kBlock];
    alignas(32) float squared[kBlock] = {}, near[kBlock] = {};
    int n = 0;
    for (const PackedCell<FreeBlock>& cell : freeCells_)
        for (std::size_t b = 0; b < cell.used; ++b) {
            const FreeBlock& block = cell.blocks[b];
            const LaneSet found = kernel_.within(block.bodies, block.n, point.data(),
                                                 float(kReach2), squared);
            forEachLane(found, [&](int lane) {
                ids[n] = block.ids[lane];
                near[n++] = squared[lane];
                if (n < kBlock) return;
                model_.addFree(ids, near, n, x, sums);
                n = 0;
            });
        }
    model_.addFree(ids, near, n, x, sums);
}

void OccupancyModel::at(const Eigen::Vector3d* points, const std::uint32_t* which,
                        std::size_t n, Occupancy* answers) const {
    Nearby nearby(*this);
    Coverage::Reader coverage(coverage_), open(openings_.cells());
    for (std::size_t k = 0; k < n; ++k) {
        const Eigen::Vector3d& point = points[which[k]];
        const double* const x = point.data();
        answers[which[k]] =
            point.allFinite()
                ? occupancyOf(answer(nearby.sums(x), Openings::ofShare(open.shareAt(x)),
                                     coverage.at(x)))
                : Occupancy{};
    }
}

}  // namespace hgmm
