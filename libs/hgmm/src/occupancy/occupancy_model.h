#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/dual.h"
#include "base/lazy.h"
#include "hgmm/gaussian.h"
#include "hgmm/joint_moments.h"
#include "hgmm/mixture.h"
#include "hgmm/occupancy.h"
#include "hgmm/regression.h"
#include "hgmm/view_directions.h"
#include "index/box_index.h"
#include "index/component_index.h"
#include "occupancy/band_kernel.h"
#include "occupancy/coverage.h"
#include "occupancy/free_space.h"
#include "occupancy/openings.h"
#include "occupancy/sides.h"

namespace hgmm {

/// The unified model of occupancy (thesis 4.3) of one level, prepared for queries:
/// surface components with their bands and free-space components, weighed by their supports
/// (thesis eq. (4.14)), with an index over both.
///
/// A surface component's W is evaluated exactly as FreeSpaceBandParams describes it.
///
/// The unexplored has a prior. Mixtures say only how likely a point is occupied or free;
/// that it is known at all is for coverage to say, C(x) (Coverage), and within the
/// thickness of a surface for its hits: K = sum_j p_j(x), of their densities relative to
/// their own peaks (and sharpened along their extents, see extentSigmas). What the mixtures
/// say counts 1 - (1 - C) k / (K + k), k = exp(-knownSigmas^2 / 2). Free densities beyond
/// the thickness of surfaces count C times. It depends neither on the size of the map nor
/// on counts.
///
/// Positions are in the local frame. Const member functions may be called from several
/// threads at once.
class OccupancyModel {
 public:
    /// Components are felt up to this distance [sigma].
    static constexpr double kSigmas = kReachSigmas;

    /// The surface components of the level.
    struct Surfaces {
        const Mixture<3>& rows;
        const ViewDirections& views;
        const ComponentIndex& index;  ///< has the rows' factors; of kSigmas
    };
    /// @param surfaces, coverage, openings read whenever asked; must outlive the model
    /// Throws std::invalid_argument naming the field.
    OccupancyModel(const OccupancyParams& params, const Surfaces& surfaces,
                   const Coverage& coverage, const Openings& openings);
    /// The same components, as copies of what another one reads have them.
    OccupancyModel(const OccupancyModel& o, const Surfaces& surfaces,
                   const Coverage& coverage, const Openings& openings);
    OccupancyModel(const OccupancyModel&) = delete;
    OccupancyModel& operator=(const OccupancyModel&) = delete;

    /// Answers depend on a component only at points that a BoxIndex with this box leads to.
    static BoxCells::Box reachOf(const OccupancyParams& params, const Gaussian<3>& surface,
                                 const ViewDirection& view);
    static BoxCells::Box reachOf(const Gaussian<4>& component);
    /// Where coverage tells whether space is open behind a surface.
    static Eigen::Vector3d beyond(const OccupancyParams& params, const Gaussian<3>& surface,
                                  const ViewDirection& view);

    /// Enters or re-enters surface component i <= number of those entered, as its row is
    /// now.
    void updateSurface(std::uint32_t i);
    /// Drops surface components n, n + 1, ...
    void truncateSurfaces(std::size_t n);
    /// Enters or re-enters free component i <= number of those entered.
    void updateFree(std::uint32_t i, const Gaussian<4>& component);

    /// A point that is not finite is unknown.
    Occupancy at(const Eigen::Vector3d& point) const;
    /// The same for points[which[0]] to points[which[n - 1]], to the same places of
    /// `answers`. Sooner than one by one where they follow each other in few cells.
    void at(const Eigen::Vector3d* points, const std::uint32_t* which, std::size_t n,
            Occupancy* answers) const;
    /// Octave of the smallest cells that points are looked up in.
    int smallestOctave() const {
        return std::min(bandBoxes_.smallestOctave(), freeBoxes_.smallestOctave());
    }
    /// Gradient of Occupancy::occupied [1/m].
    Eigen::Vector3d gradient(const Eigen::Vector3d& point) const;
    /// As Map::castRay. `direction` is a unit vector.
    std::optional<RayHit> castRay(const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction,
                                  const RayCastParams& params) const;

    std::size_t liveBytes() const;

 private:
    using Factor = ComponentIndex::Factor;

    static constexpr double kReach2 = kSigmas * kSigmas;  ///< [sigma^2]
    /// exp(-kReach2 / 2): relative densities end there.
    static constexpr double kCutDensity = 3.3546262790251185e-4;
    static_assert(kReach2 == 16.0, "kCutDensity follows it");

    /// The band of a surface component, made of its rows when asked. Stored, bands would
    /// take more memory than the rows themselves.
    struct Band {
        float viewPrecision = 0.F;  ///< u^T Sigma^-1 u [1/m^2]; 0 without a view
        float tau_m = 0.F;          ///< its root's inverse, thickness along the view
        float width_m = 0.F, reach_m = 0.F;
        float freePerMetre = 0.F;
        float peak = 0.F;  ///< support times density at the mean [1/m^3]

        bool hasView() const { return viewPrecision > 0; }
    };
    /// A component over (X, W) for thesis eq. (4.4) to (4.9).
    struct Joint {
        WhitenedGaussian<3, float> place;
        std::array<float, 3> slope{};  ///< Sigma_XX^-1 Sigma_XW
        float meanW_m = 0.F, varianceW_m2 = 0.F;
        float peak = 0.F;  ///< support times density at the mean [1/m^3]
    };
    /// A density of free points with the moments of their W.
    template <typename T>
    struct FreeDensity {
        T density = 0.0;                               ///< [1/m^3]
        double distance = 0.0, squaredDistance = 0.0;  ///< W and W^2, times the density

        void add(const T& more, double meanW, double meanSquaredW) {
            density += more;
            distance += valueOf(more) * meanW;
            squaredDistance += valueOf(more) * meanSquaredW;
        }
    };
    template <typename T>
    struct Side {
        bool isFront = false;
        T share = 0.0;  ///< in [0, 1]: 1 well off the surface, and not beside it
    };
    /// Sums over components, all relative to their supports.
    template <typename T>
    struct Sums {
        T occupied = 0.0;       ///< density [1/m^3]
        FreeDensity<T> atHits;  ///< within the thickness of a surface
        FreeDensity<T> passed;  ///< elsewhere: it counts as far as rays passed
        T known = 0.0;          ///< K_hit
        Sides<T> sides;
    };
    /// The same, weighed by coverage.
    template <typename T>
    struct Answer {
        T occupied = 0.0, free = 0.0;  ///< probabilities
        double alongRay_m = 0.0, variance_m2 = 0.0;
    };
    struct Bounds {
        std::array<float, 3> low, high;  ///< [m]
    };
    /// The components near a point, as packed for it and points in the same cells.
    class Nearby;
    /// Where a ray is near one component, along the ray.
    struct Interval {
        double start_m, end_m;  ///< within 4 sigma, and within the part that is looked at
        double peak_m, sigma_m;
    };

    /// Sums at a point, for its gradient.
    Sums<Dual> sums(const Dual* x) const;
    /// The same sums in single precision, several components at a time.
    Sums<double> sums(const double* x) const;
    void addBands(const std::uint32_t* ids, int n, const float* point, const float* rest,
                  Sums<double>& sums) const;
    Band bandOf(std::uint32_t i, float viewPrecision) const;
    /// A component's view, whitened; zero without a view.
    std::array<float, 3> whitenedView(std::uint32_t i) const;
    float gatherPlace(std::uint32_t i, bands::Lanes& lanes, int k) const;
    void gatherBand(const Band& band, bands::Lanes& lanes, int k) const;
    void addFree(const std::uint32_t* ids, float* squared, int n, const double* x,
                 Sums<double>& sums) const;
    template <typename T>
    Answer<T> answer(const T* x) const;
    /// @param open, covered openings and coverage at the point
    template <typename T>
    Answer<T> answer(const Sums<T>& sums, const T& open, const T& covered) const;
    static Occupancy occupancyOf(const Answer<double>& answer);
    void addBand(std::uint32_t i, const Dual* x, Sums<Dual>& sums) const;
    /// What the kernel says of lane k.
    static void addDensities(const bands::Densities& densities, int k, Sums<double>& sums);
    /// On which side of a component a point is.
    template <typename T>
    Side<T> sideOf(std::uint32_t i, float viewPrecision, const T& height,
                   const T& beside) const;
    template <typename T>
    void addSide(std::uint32_t i, const Side<T>& side, Sides<T>& sides) const;
    /// The direction of a component's view, a unit vector.
    std::array<float, 3> viewOf(std::uint32_t i) const;
    /// C(x) where it tells whether space is open behind a surface.
    double coverageBeyond(std::uint32_t i) const;
    void addFree(const Joint& joint, const Dual* x, Sums<Dual>& sums) const;
    /// First and last distance at which the line from `start` along `direction` may meet a
    /// surface; the first is beyond the last if there is none.
    std::pair<double, double> spanAlong(const Eigen::Vector3d& start,
                                        const Eigen::Vector3d& direction) const;
    std::vector<Interval> intervals(const Eigen::Vector3d& origin,
                                    const Eigen::Vector3d& direction, double from_m,
                                    double to_m) const;
    std::optional<double> firstOccupied(const Eigen::Vector3d& origin,
                                        const Eigen::Vector3d& direction,
                                        const Interval& interval, double minOccupied) const;
    bool crossesUnknown(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                        double to_m) const;

    static Joint jointOf(const Gaussian<4>& g);
    /// So far to each side a surface tells which side a point is on [m].
    static float sideReach_m(const OccupancyParams& params, const ViewDirection& view);

    OccupancyParams params_;
    const Surfaces surfaces_;
    const Coverage& coverage_;
    const Openings& openings_;
    double unknownDensity_;  ///< k
    double sharpness_;       ///< of extents against thickness
    std::vector<Joint> freeJoints_;
    std::vector<BoxCells::Box> boxes_;  ///< of bands, kSigmas to each side
    BoxIndex<0> bandBoxes_;             ///< who is in boxes_
    BoxIndex<0> freeBoxes_;
    mutable Lazy<Bounds> bounds_;  ///< of all boxes_
};

}  // namespace hgmm
