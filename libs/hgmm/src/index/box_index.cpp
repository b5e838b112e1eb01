#include "index/box_index.h"

#include <stdexcept>

#include "base/growth.h"

namespace hgmm {

template <int kBlockShift>
auto BoxIndex<kBlockShift>::reachOf(const Point& centre, const BoxCells& cells) -> Reach {
    const Cell middle = BoxCells::cellOf(centre, cells.octave);
    Reach reach;
    reach.octave = static_cast<std::int8_t>(cells.octave);
    for (int d = 0; d < 3; ++d)
        reach.belowAndAbove[d] = static_cast<std::uint8_t>(
            (middle[d] - cells.low[d]) | (cells.high[d] - middle[d]) << 4);
    return reach;
}

template <int kBlockShift>
BoxCells BoxIndex<kBlockShift>::cellsOf(const Point& centre, const Reach& reach) const {
    const Cell middle = BoxCells::cellOf(centre, reach.octave);
    BoxCells cells;
    cells.octave = reach.octave;
    for (int d = 0; d < 3; ++d) {
        cells.low[d] = middle[d] - (reach.belowAndAbove[d] & 15);
        cells.high[d] = middle[d] + (reach.belowAndAbove[d] >> 4);
    }
    return cells;
}

template <int kBlockShift>
template <typename Visitor>
void BoxIndex<kBlockShift>::forEachBlock(const BoxCells& cells, Visitor&& visit) const {
    const auto blockOf = [](std::int32_t c) { return c >> kBlockShift; };
    constexpr std::int32_t edge = 1 << kBlockShift;
    // Cells of a block that lie in the range, along an axis.
    const auto bits = [&](int d, std::int32_t block) {
        const std::int32_t first = std::max(cells.low[d] - block * edge, 0);
        const std::int32_t last = std::min(cells.high[d] - block * edge, edge - 1);
        return (2U << unsigned(last)) - (1U << unsigned(first));
    };
    const Cell &a = cells.low, &b = cells.high;
    for (std::int32_t x = blockOf(a[0]); x <= blockOf(b[0]); ++x)
        for (std::int32_t y = blockOf(a[1]); y <= blockOf(b[1]); ++y)
            for (std::int32_t z = blockOf(a[2]); z <= blockOf(b[2]); ++z)
                visit(keyOf(cells.octave, {x * edge, y * edge, z * edge}),
                      bits(0, x) | bits(1, y) << 8U | bits(2, z) << 16U);
}

template <int kBlockShift>
std::uint32_t BoxIndex<kBlockShift>::placeOf(std::uint32_t i, const PoolRun& run) const {
    const Entry* const first = entries_.data(run);
    return static_cast<std::uint32_t>(
        std::partition_point(first, first + run.count,
                             [i](const Entry& entry) { return entry.box < i; }) -
        first);
}

template <int kBlockShift>
void BoxIndex<kBlockShift>::enter(std::uint32_t i, const BoxCells& cells) {
    forEachBlock(cells, [&](std::uint64_t key, std::uint32_t touched) {
        PoolRun& run = *blocks_.tryEmplace(key, PoolRun{}).first;
        entries_.insert(run, placeOf(i, run), entryOf(i, touched));
    });
    octaves_.add(cells.octave);
}

template <int kBlockShift>
void BoxIndex<kBlockShift>::leave(std::uint32_t i, const Point& centre) {
    const BoxCells cells = cellsOf(centre, reaches_[i]);
    forEachBlock(cells, [&](std::uint64_t key, std::uint32_t) {
        PoolRun& run = *blocks_.tryEmplace(key, PoolRun{}).first;
        const std::uint32_t place = placeOf(i, run);
        if (place == run.count || entries_.data(run)[place].box != i)
            throw std::logic_error("BoxIndex: a box is not where its centre was");
        entries_.erase(run, place);
        if (run.count == 0) blocks_.erase(key);
    });
    octaves_.remove(cells.octave);
}

template <int kBlockShift>
void BoxIndex<kBlockShift>::update(std::uint32_t i, const Box& box,
                                   const Point& formerCentre) {
    if (i > size()) throw std::out_of_range("BoxIndex::update: a gap before it");
    const BoxCells cells = BoxCells::of(box);
    if (i < size()) {
        const BoxCells former = cellsOf(formerCentre, reaches_[i]);
        if (former == cells) {
            reaches_[i] = reachOf(box.centre, cells);
            return;
        }
        leave(i, formerCentre);
    } else {
        growTo(reaches_, i + std::size_t{1});
    }
    reaches_[i] = reachOf(box.centre, cells);
    enter(i, cells);
}

template class BoxIndex<0>;
template class BoxIndex<3>;

}  // namespace hgmm
