#pragma once

namespace hgmm::bands {

/// So many bands are evaluated at once, at most.
constexpr int kBlock = 64;
/// Bit k stands for lane k.
using LaneSet = unsigned long long;

/// Bands beside each other, in the order in which their components were found: one lane a
/// band, plain arrays of floats. Lanes up to a multiple of 8 are read and written.
struct Lanes {
    alignas(32) float mean[3][kBlock];       ///< [m]
    alignas(32) float factor[6][kBlock];     ///< of WhitenedGaussian, row by row [1/m]
    alignas(32) float view[3][kBlock];       ///< whitened: factor times the unit view [1/m]
    alignas(32) float precision[kBlock];     ///< |view|^2 [1/m^2], > 0
    alignas(32) float tau[kBlock];           ///< 1 / |view|, thickness along the view [m]
    alignas(32) float peak[kBlock];          ///< support times density at the mean [1/m^3]
    alignas(32) float sharpness[kBlock];     ///< of extents against thickness [1]
    alignas(32) float reach[kBlock];         ///< of free space before the surface [m]
    alignas(32) float width[kBlock];         ///< free density falls beyond it [m]
    alignas(32) float freePerMetre[kBlock];  ///< [1/m]
};

/// Boxes beside each other.
struct Boxes {
    alignas(32) float centre[3][kBlock];      ///< [m]
    alignas(32) float halfExtent[3][kBlock];  ///< [m]
};

/// Components of a mixture beside each other.
struct Bodies {
    alignas(32) float mean[3][kBlock];    ///< [m]
    alignas(32) float factor[6][kBlock];  ///< of WhitenedGaussian, row by row [1/m]
};

/// Where a point is seen from each band.
struct Places {
    alignas(32) float beside[kBlock];  ///< squared distance across the view [sigma^2]
    alignas(32) float height[kBlock];  ///< over the surface, along the view [m]
};

/// What each band says of a point: OccupancyModel::Sums has the meaning.
struct Densities {
    alignas(32) float occupied[kBlock], known[kBlock];
    alignas(32) float freeAtHits[kBlock], freePassed[kBlock];
    alignas(32) float meanW[kBlock];         ///< [m]
    alignas(32) float meanSquaredW[kBlock];  ///< [m^2]
};

/// The loops for one instruction set. Each lane has the same bits in all of them: they
/// use no fused and no approximate operations, and no function of the C library.
struct Kernel {
    const char* name;
    /// Places of a point given as a float and the rest that is left of it [m]. Reads mean,
    /// factor, view and precision.
    void (*place)(const Lanes&, int n, const float* point, const float* rest, Places&);
    /// Which of the first n boxes hold a point.
    LaneSet (*inside)(const Boxes&, int n, const float* point);
    /// place() for the lanes of a set, and for others. Returns which of them are at most
    /// `maxBeside` beside.
    LaneSet (*placeNear)(const Lanes&, LaneSet set, const float* point, const float* rest,
                         float maxBeside, Places&);
    /// Squared distances from the first n components [sigma^2]. Returns which of them are
    /// at most `maxSquared`.
    LaneSet (*within)(const Bodies&, int n, const float* point, float maxSquared,
                      float* squared);
    /// @param cut densities relative to their peaks count from there on: what is known
    void (*evaluate)(const Lanes&, const Places&, int n, float cut, Densities&);
    /// exp(-squared / 2) in place, squared >= 0. `squared` is aligned to 32 bytes.
    void (*normalFall)(float* squared, int n);
};

}  // namespace hgmm::bands
