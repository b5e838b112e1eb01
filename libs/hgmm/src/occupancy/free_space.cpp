#include "occupancy/free_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/growth.h"
#include "base/portable_math.h"
#include "hgmm/params.h"
#include "mixture/regularized.h"

namespace hgmm {

namespace {

/// A sensor's own surroundings are left out: rays start there [m].
constexpr double kSensorSurroundings_m = 0.05;

/// A slab is at most this share of its cell's edge.
constexpr double kSlabPerCell = 0.5;

/// As a mixture holds it: a component's cell is that of its mean as it is saved.
Eigen::Vector3d rounded(const Eigen::Vector3d& mean) {
    return mean.cast<float>().cast<double>();
}

/// The component with its mean inside its cell, where rounding to float would put it on the
/// far faces, which are the next cells'.
Gaussian<4> keptInside(Gaussian<4> component, const LatticeCell& cell) {
    const std::int32_t axes[3] = {cell.x, cell.y, cell.z};
    for (int d = 0; d < 3; ++d) {
        const double end = (axes[d] + 1.0) * powerOfTwo(cell.octave);
        const auto mean = static_cast<float>(component.mean[d]);
        if (mean >= end)
            component.mean[d] = std::nextafter(mean, std::numeric_limits<float>::lowest());
    }
    return component;
}

/// What one scan adds to the lattice, in order of first touch.
class ScanCells {
 public:
    ScanCells(const Eigen::Vector3d& sensorOrigin, const SurfacePyramid& pyramid,
              const FreeSpaceBandParams& band, double cellAtOneMetre_m)
        : sensorOrigin_(sensorOrigin),
          pyramid_(pyramid),
          band_(band),
          cellAtOneMetre_m_(cellAtOneMetre_m) {}

    void add(const RayBundle& bundle) {
        const Eigen::Vector3d ray = sensorOrigin_ - bundle.mean;
        const double range = ray.norm(), end = range - kSensorSurroundings_m;
        const double reach = band_.reach(range);
        const int smallest = octaveOf(cellAtOneMetre_m_ * std::sqrt(range));
        const double density =
            bundle.support * band_.freePerMetre(range) * band_.width(range);
        for (double w = reach; w < end;) {
            const LatticeCell cell =
                cellFor(bundle.mean + ray * (w / range), octaveOf(w), smallest);
            const double to = std::min(end, w + kSlabPerCell * powerOfTwo(cell.octave));
            Gaussian<4> slab = raySegmentMoments(bundle, sensorOrigin_, w, to);
            slab.support = density * portable::log(to / w);
            slab.mean.head<3>() = rounded(slab.mean.head<3>());
            add(slab, LatticeCell::at(slab.mean.head<3>(), cell.octave));
            w = to;
        }
    }

    const std::vector<LatticeCell>& cells() const { return cells_; }
    const std::vector<Gaussian<4>>& sums() const { return sums_; }

 private:
    /// The largest cell around p, within the octaves given, that has no surface beside it.
    LatticeCell cellFor(const Eigen::Vector3d& p, int largest, int smallest) {
        LatticeCell cell = LatticeCell::at(p, largest);
        while (cell.octave > smallest && isNearSurface(cell))
            cell = LatticeCell::at(p, cell.octave - 1);
        return cell;
    }

    bool isNearSurface(const LatticeCell& cell) {
        const auto [near, isNew] = near_.tryEmplace(cell, false);
        if (isNew) *near = pyramid_.isNearSurface(cell);
        return *near;
    }

    void add(const Gaussian<4>& slab, const LatticeCell& cell) {
        const auto [number, isNew] =
            numbers_.tryEmplace(cell, static_cast<std::uint32_t>(cells_.size()));
        if (isNew) {
            cells_.push_back(cell);
            sums_.push_back(slab);
        } else {
            sums_[*number] = mergeMoments(sums_[*number], slab);
        }
    }

    const Eigen::Vector3d sensorOrigin_;
    const SurfacePyramid& pyramid_;
    const FreeSpaceBandParams& band_;
    const double cellAtOneMetre_m_;
    LatticeTable<bool> near_;
    LatticeTable<std::uint32_t> numbers_;
    std::vector<LatticeCell> cells_;
    std::vector<Gaussian<4>> sums_;
};

}  // namespace

int FreeSpace::pyramidOctave(const FreeSpaceParams& params) {
    // Cells of the least range are taken whatever is near.
    const int smallest =
        octaveOf(params.freeCellAtOneMetre_m * std::sqrt(kSensorSurroundings_m));
    return std::clamp(smallest + 1, SurfacePyramid::kMinOctave, SurfacePyramid::kMaxOctave);
}

std::vector<std::uint32_t> FreeSpace::insert(const std::vector<RayBundle>& bundles,
                                             const Eigen::Vector3d& sensorOrigin,
                                             const SurfacePyramid& pyramid,
                                             const FreeSpaceBandParams& band,
                                             const FreeSpaceParams& params) {
    ScanCells scan(sensorOrigin, pyramid, band, params.freeCellAtOneMetre_m);
    for (const RayBundle& bundle : bundles) scan.add(bundle);

    std::vector<std::uint32_t> changed;
    for (std::size_t s = 0; s < scan.cells().size(); ++s) {
        const Gaussian<4>& sum = scan.sums()[s];
        const std::uint32_t* known = componentOf_.find(scan.cells()[s]);
        if (known != nullptr &&
            !(mixture_.support[*known] < params.freeSettledScans * sum.support))
            continue;
        changed.push_back(add(sum, scan.cells()[s]));
    }
    std::sort(changed.begin(), changed.end());
    return changed;
}

std::uint32_t FreeSpace::merge(Gaussian<4> component, int octave) {
    component.mean.head<3>() = rounded(component.mean.head<3>());
    return add(component, LatticeCell::at(component.mean.head<3>(), octave));
}

std::uint32_t FreeSpace::add(const Gaussian<4>& component, const LatticeCell& cell) {
    const auto [number, isNew] =
        componentOf_.tryEmplace(cell, static_cast<std::uint32_t>(octaves_.size()));
    const std::uint32_t i = *number;
    if (isNew) {
        append(regularized(keptInside(component, cell)), cell);
    } else {
        mixture_.set(i,
                     regularized(keptInside(mergeMoments(mixture_[i], component), cell)));
    }
    return i;
}

Mixture<4> FreeSpace::coarsened(int times) const {
    LatticeTable<std::uint32_t> numbers;
    std::vector<Gaussian<4>> merged;
    for (std::size_t i = 0; i < mixture_.size(); ++i) {
        LatticeCell cell = LatticeCell::at(mixture_[i].mean.head<3>(), octave(i));
        std::int32_t* const axes[3] = {&cell.x, &cell.y, &cell.z};
        for (int t = 0; t < times; ++t) *axes[t % 3] >>= 1;
        const auto [number, isNew] =
            numbers.tryEmplace(cell, static_cast<std::uint32_t>(merged.size()));
        if (isNew)
            merged.push_back(mixture_[i]);
        else
            merged[*number] = mergeMoments(merged[*number], mixture_[i]);
    }
    Mixture<4> mixture;
    mixture.reserve(merged.size());
    for (const Gaussian<4>& g : merged) mixture.pushBack(regularized(g));
    return mixture;
}

void FreeSpace::reserve(std::size_t n) {
    mixture_.reserve(n);
    octaves_.reserve(n);
    componentOf_.reserve(n);
}

void FreeSpace::pushBack(const Gaussian<4>& component, int octave) {
    const LatticeCell cell = LatticeCell::at(component.mean.head<3>(), octave);
    componentOf_.tryEmplace(cell, static_cast<std::uint32_t>(octaves_.size()));
    append(component, cell);
}

void FreeSpace::append(const Gaussian<4>& component, const LatticeCell& cell) {
    if (mixture_.size() == mixture_.support.capacity())
        mixture_.reserve(roomFor(mixture_.size() + 1));
    mixture_.pushBack(component);
    growTo(octaves_, mixture_.size());
    octaves_.back() = static_cast<std::int8_t>(cell.octave);
}

std::size_t FreeSpace::liveBytes() const {
    return mixture_.support.capacity() * sizeof(float) * (1 + 4 + Mixture<4>::packed) +
           octaves_.capacity() + componentOf_.liveBytes();
}

}  // namespace hgmm
