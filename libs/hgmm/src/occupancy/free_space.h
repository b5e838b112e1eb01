#pragma once
#include <cstdint>
#include <vector>

#include "base/lattice_table.h"
#include "hgmm/joint_moments.h"
#include "hgmm/mixture.h"
#include "hgmm/params.h"
#include "index/surface_pyramid.h"

namespace hgmm {

/// Hits of one scan that belong to one surface component: their number, mean and scatter.
using RayBundle = Gaussian<3>;

/// The default free-space model: a mixture over (X, W) whose components grow with the
/// distance to the surfaces around them, so that their number depends on the area of what
/// was seen, not on ranges. Where rays passed is for Coverage to say.
///
/// Each bundle of rays is cut into slabs from the reach of its surface's band to the
/// sensor. A slab belongs to a cell of a lattice whose edge is the octave of W, or smaller
/// where surfaces are nearer than W (rays that graze a floor), down to
/// freeCellAtOneMetre_m. One component is kept for each cell and grows by the closed-form
/// moments of its slabs (raySegmentMoments). The support of a slab continues that of the
/// band.
class FreeSpace {
 public:
    /// Octave of the smallest cells that insert asks a pyramid about, in the pyramid's
    /// range.
    static int pyramidOctave(const FreeSpaceParams& params);

    /// Adds the rays of one scan, in the local frame. Returns the changed components,
    /// rising; new ones come last.
    std::vector<std::uint32_t> insert(const std::vector<RayBundle>& bundles,
                                      const Eigen::Vector3d& sensorOrigin,
                                      const SurfacePyramid& pyramid,
                                      const FreeSpaceBandParams& band,
                                      const FreeSpaceParams& params);

    /// Adds a component of another map, in the local frame, to the cell of its mean.
    /// Returns which component it became.
    std::uint32_t merge(Gaussian<4> component, int octave);

    const Mixture<4>& mixture() const { return mixture_; }
    /// Octave of the cell of component i: its edge is 2^octave m.
    int octave(std::size_t i) const { return octaves_[i]; }
    /// The mixture with pairs of neighbouring cells merged, `times` times over, each time
    /// along the next axis.
    Mixture<4> coarsened(int times) const;

    /// Makes room for n components in all.
    void reserve(std::size_t n);
    /// For loading. Cells are found again from the means.
    void pushBack(const Gaussian<4>& component, int octave);

    std::size_t liveBytes() const;
    bool operator==(const FreeSpace& o) const {
        return mixture_ == o.mixture_ && octaves_ == o.octaves_;
    }

 private:
    /// Adds a component, whose mean lies in the cell and is one of floats, to the cell's.
    /// Returns which component it became.
    std::uint32_t add(const Gaussian<4>& component, const LatticeCell& cell);
    void append(const Gaussian<4>& component, const LatticeCell& cell);

    Mixture<4> mixture_;
    std::vector<std::int8_t> octaves_;  ///< of cells, which are around the means
    LatticeTable<std::uint32_t> componentOf_;
};

}  // namespace hgmm
