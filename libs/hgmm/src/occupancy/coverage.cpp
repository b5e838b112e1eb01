#include "occupancy/coverage.h"

#include <algorithm>
#include <cmath>

#include "base/dual.h"
#include "base/lattice_walk.h"

namespace hgmm {

namespace {

constexpr std::int32_t kInBlock = (1 << Coverage::kBlockShift) - 1;
constexpr unsigned kAllCorners = 255;
/// 1 - 2^-53: a share that rounding makes 1 is not that of all corners.
constexpr double kNearlyOne = 0.99999999999999988898;

/// Cells are at least this many spacings of rays wide, so that a sparse sensor leaves no
/// gaps, but for its sake no wider than the gap that is bridged: things hide in wider ones.
constexpr double kCellsPerSpacing = 2.0, kWidestGap_m = 0.5;
/// Nearer to the sensor cells get no smaller [m].
constexpr double kNearest_m = 0.5;
/// Octaves begin half an octave below their edge.
constexpr double kRoot2 = 1.4142135623730951;

/// Corners, bit dx + 2 dy + 4 dz, of the cells of a word whose lowest is bit 0.
unsigned cornersFrom(Coverage::Word cells) {
    return static_cast<unsigned>((cells & 3U) | (cells >> 2U & 12U) | (cells >> 12U & 48U) |
                                 (cells >> 14U & 192U));
}
/// Those that are not across any of a set of axes.
constexpr unsigned kWithoutAxes[8] = {0xFF, 0x55, 0x33, 0x11, 0x0F, 0x05, 0x03, 0x01};

Coverage::Word bitOf(std::int32_t x, std::int32_t y, std::int32_t z) {
    const auto bit = (x & kInBlock) | (y & kInBlock) << 2 | (z & kInBlock) << 4;
    return Coverage::Word{1} << static_cast<unsigned>(bit);
}

}  // namespace

void Coverage::note(int octave) {
    const auto place = std::lower_bound(octaves_.begin(), octaves_.end(), octave);
    if (place == octaves_.end() || *place != octave) octaves_.insert(place, octave);
}

void Coverage::mark(const LatticeCell& block, Word cells) {
    if (cells != 0 && blocks_.mark(block, cells)) note(block.octave);
}

void Coverage::mark(const LatticeCell& cell) {
    mark(CellBlocks::blockOf(cell), bitOf(cell.x, cell.y, cell.z));
}

void Coverage::markSegment(int octave, const Eigen::Vector3d& from,
                           const Eigen::Vector3d& to) {
    LatticeCell groupCell = LatticeCellKeys::unused();
    CellBlocks::Group* group = nullptr;
    bool areNew = false;
    const auto visit = [&](std::int32_t x, std::int32_t y, std::int32_t z, Word cells) {
        const LatticeCell block{octave, x, y, z}, own = CellBlocks::blockOf(block);
        if (!(own == groupCell)) group = &blocks_.groupToMark(groupCell = own);
        areNew |= blocks_.mark(*group, CellBlocks::placeOf(block), cells);
    };
    walkBlocks(from, to, powerOfTwo(-octave), visit);
    if (areNew) note(octave);
}

Coverage::Rays::Rays(const CoverageParams& params, double raySpacing_rad,
                     const Eigen::Vector3d& normalOfRays)
    : normal_(normalOfRays),
      spacing_rad_(raySpacing_rad),
      atOneMetre_m_(params.coverageCellAtOneMetre_m),
      perMetre_(kCellsPerSpacing * raySpacing_rad) {}

int Coverage::Rays::octaveAt(double w_m) const {
    const double edge = std::max(atOneMetre_m_ * std::sqrt(std::max(w_m, kNearest_m)),
                                 std::min(kWidestGap_m, perMetre_ * w_m));
    return octaveOf(kRoot2 * edge);
}

double Coverage::Rays::leftOut(double range_m) const {
    return powerOfTwo(octaveAt(range_m)) / 2;
}

double Coverage::Rays::endOf(int octave) const {
    const double edge = kRoot2 * powerOfTwo(octave), root = edge / atOneMetre_m_;
    const double end = root * root;
    return edge < kWidestGap_m ? std::min(end, edge / perMetre_) : end;
}

void Coverage::markStretch(int octave, const Eigen::Vector3d& from,
                           const Eigen::Vector3d& to, const Rays& rays) {
    // A planar laser marks a layer of cells, or two if it lies near their border.
    const Eigen::Vector3d aside = powerOfTwo(octave) / 4 * rays.normal();
    markSegment(octave, from + aside, to + aside);
    if (!rays.normal().isZero()) markSegment(octave, from - aside, to - aside);
}

void Coverage::markRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& end,
                       bool isHit, const Rays& rays) {
    const Eigen::Vector3d ray = end - origin;
    const double range = ray.norm();
    if (!(range > 0)) return;
    const double length = isHit ? range - rays.leftOut(range) : range;
    rays.forEachStretch(length, [&](const Stretch& stretch) {
        markStretch(stretch.octave, origin + (stretch.start_m() / range) * ray,
                    origin + (std::min(length, stretch.to_m) / range) * ray, rays);
    });
}

unsigned Coverage::corners(const LatticeCell& low, LastGroup& last) const {
    const LatticeCell block = CellBlocks::blockOf(low);
    // Axes along which the upper cells lie in the next block.
    const unsigned crossed = ((low.x & kInBlock) == kInBlock ? 1U : 0U) |
                             ((low.y & kInBlock) == kInBlock ? 2U : 0U) |
                             ((low.z & kInBlock) == kInBlock ? 4U : 0U);
    unsigned found = 0, across = 0;
    do {  // for all subsets of the axes: blocks that hold corners
        const auto x = std::int32_t(across & 1U), y = std::int32_t(across >> 1U & 1U),
                   z = std::int32_t(across >> 2U);
        const Word cells =
            word({block.octave, block.x + x, block.y + y, block.z + z}, last) >>
            CellBlocks::placeOf(
                {0, x != 0 ? 0 : low.x, y != 0 ? 0 : low.y, z != 0 ? 0 : low.z});
        found |= (cornersFrom(cells) & kWithoutAxes[crossed]) << across;
        across = (across - crossed) & crossed;
    } while (across != 0);
    return found;
}

void Coverage::unmark(const LatticeCell& block, Word cells) {
    blocks_.unmark(block, cells);
    if (blocks_.size() == 0) octaves_.clear();
}

template <typename T>
T Coverage::shareAt(const T* x, int octave, LastGroup& last) const {
    const double edge = powerOfTwo(octave);
    const Eigen::Vector3d p(valueOf(x[0]), valueOf(x[1]), valueOf(x[2]));
    const LatticeCell low = LatticeCell::at(p.array() - edge / 2, octave);
    const unsigned marked = corners(low, last);
    if (marked == 0) return 0.0;
    if (marked == kAllCorners) return 1.0;
    const Eigen::Vector3d centre = low.centre();
    T share = 0.0, upper[3];
    for (int d = 0; d < 3; ++d) upper[d] = (x[d] - centre[d]) / edge;
    for (int k = 0; k < 8; ++k) {
        if ((marked >> k & 1U) == 0) continue;
        T weight = 1.0;
        for (int d = 0; d < 3; ++d)
            weight = weight * ((k >> d & 1) != 0 ? upper[d] : 1.0 - upper[d]);
        share += weight;
    }
    return valueOf(share) < 1.0 ? share : T(kNearlyOne);
}

template <typename T>
T Coverage::shareAt(const T* x) const {
    T best = 0.0;
    for (const int octave : octaves_) {
        LastGroup last;
        const T share = shareAt(x, octave, last);
        if (valueOf(share) > valueOf(best)) best = share;
        if (valueOf(best) == 1.0) break;
    }
    return best;
}
template double Coverage::shareAt(const double*, int, LastGroup&) const;
template double Coverage::shareAt(const double*) const;
template Dual Coverage::shareAt(const Dual*) const;

void Coverage::merge(const Coverage& other, const Pose& T_local_other) {
    if (T_local_other.R.isIdentity(0.0) && T_local_other.t.isZero(0.0)) {
        other.forEachBlock(
            [this](const LatticeCell& block, Word cells) { mark(block, cells); });
        return;
    }
    const Pose T_other_local = T_local_other.inverse();
    other.forEachBlock([&](const LatticeCell& block, Word word) {
        forEachCell(block, word, [&](const LatticeCell& cell) {
            const Eigen::Vector3d centre =
                T_local_other.R * cell.centre() + T_local_other.t;
            const LatticeCell near = LatticeCell::at(centre, cell.octave);
            for (int k = 0; k < 27; ++k) {
                const LatticeCell mine{cell.octave, near.x + k % 3 - 1,
                                       near.y + k / 3 % 3 - 1, near.z + k / 9 - 1};
                const Eigen::Vector3d theirs =
                    T_other_local.R * mine.centre() + T_other_local.t;
                if (LatticeCell::at(theirs, cell.octave) == cell) mark(mine);
            }
        });
    });
}

void Coverage::copyAround(const Eigen::AlignedBox3d& box, Coverage& part) const {
    for (const int octave : octaves_) {
        const double half = powerOfTwo(octave) / 2;
        const LatticeCell low = LatticeCell::at(box.min().array() - half, octave);
        LatticeCell high = LatticeCell::at(box.max().array() - half, octave);
        ++high.x, ++high.y, ++high.z;
        const CellRange range(low, high);
        if (range.blockCount() < double(blockCount())) {
            range.forEachBlock([&](const LatticeCell& block) {
                part.mark(block, word(block) & range.cellsIn(block));
            });
            continue;
        }
        forEachBlock([&](const LatticeCell& block, Word cells) {
            if (block.octave == octave) part.mark(block, cells & range.cellsIn(block));
        });
    }
}

Coverage Coverage::coarsened(int times) const {
    if (times == 0) return *this;
    LatticeTable<std::uint8_t> children;
    forEachBlock([&](const LatticeCell& block, Word word) {
        forEachCell(block, word, [&](const LatticeCell& cell) {
            ++*children.tryEmplace(cell.parent(), 0).first;
        });
    });
    Coverage coarse;
    children.forEach([&](const LatticeCell& cell, std::uint8_t marked) {
        if (marked >= 4) coarse.mark(cell);
    });
    return coarse.coarsened(times - 1);
}

Coverage::Word Coverage::withoutCovered(const LatticeCell& block, Word word) const {
    Word kept = 0;
    LastGroup last;
    forEachCell(block, word, [&](const LatticeCell& cell) {
        const Eigen::Vector3d p = cell.centre();
        for (auto octave = octaves_.rbegin(); octave != octaves_.rend(); ++octave) {
            if (*octave <= cell.octave) break;
            const Eigen::Vector3d corner = p.array() - powerOfTwo(*octave) / 2;
            if (corners(LatticeCell::at(corner, *octave), last) == kAllCorners) return;
        }
        kept |= bitOf(cell.x, cell.y, cell.z);
    });
    return kept;
}

Coverage Coverage::pruned() const {
    Coverage kept;
    forEachBlock([&](const LatticeCell& block, Word word) {
        kept.mark(block, withoutCovered(block, word));
    });
    return kept;
}

bool Coverage::operator==(const Coverage& o) const {
    bool same = blockCount() == o.blockCount();
    forEachBlock([&](const LatticeCell& block, Word cells) {
        same = same && o.word(block) == cells;
    });
    return same;
}

}  // namespace hgmm
