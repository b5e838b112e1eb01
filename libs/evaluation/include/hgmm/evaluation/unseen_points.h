#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "hgmm/evaluation/free_points.h"
#include "hgmm/evaluation/occupancy_figures.h"
#include "hgmm/evaluation/points.h"
#include "hgmm/evaluation/seen_cells.h"

namespace hgmm::evaluation {

/// Questions about space that no ray came near, and about space that rays passed.
struct UnseenPoints {
    static constexpr double kBehind_m[2] = {0.1, 1.5};  ///< after hits, along the ray [m]
    static constexpr std::size_t kOfEach = 20000;       ///< points drawn at most

    Points behindHits_map;  ///< unseen, behind hits [m]
    Points inBox_map;       ///< unseen, uniform in the box around all hits [m]
    Points free_map;        ///< that rays passed, within the free band [m]
    double edge_m = 0.0;    ///< of the cells of the reference [m]
};

/// Learns what a recording saw: all of its scans, test scans as well.
class SeenSpace {
 public:
    static constexpr std::size_t kRaysPerScan = 500;  ///< kept to draw points from

    explicit SeenSpace(std::uint64_t seed) : seed_(seed) {}

    /// The first scan with points says how fine the reference is (seenCellEdge_m).
    void add(const Scan& scan, std::size_t scanIndex);

    /// Points to ask maps about; the same for the same scans and seed.
    UnseenPoints draw(const FreeBand& free = {}) const;

 private:
    struct Ray {
        Eigen::Vector3d origin_map, hit_map;  ///< [m]
    };

    std::uint64_t seed_;
    std::optional<SeenCells> cells_;
    std::vector<Ray> rays_;
};

/// How a map answers where nothing was seen, and, so that timidity does not win, where rays
/// passed. All shares are in [0, 1], 0 without points.
struct UnseenFigures {
    std::size_t behindHits = 0, inBox = 0, free = 0;  ///< points asked for
    double calledFreeBehindHits = 0.0;                ///< share of those with P(free) > 0.5
    double calledFreeInBox = 0.0;                     ///< likewise
    double calledOccupied = 0.0;                      ///< P(occupied) > 0.5, of both kinds
    double meanUnknown = 0.0;                         ///< mean P(unknown), of both kinds
    double seenCalledUnknown = 0.0;  ///< P(unknown) > 0.5, of points that rays passed
};

/// What any map says of points, with unknown space apart.
using OccupancyQuery = std::function<std::vector<Occupancy>(const Points& points_map)>;

/// A level of a mixture map, which must outlive the result.
OccupancyQuery occupancyQueryOf(const Map& map);

/// An answer of another map: all known or all unknown.
Occupancy occupancyOfAnswer(const Answer& answer);

UnseenFigures evaluateUnseen(const OccupancyQuery& query, const UnseenPoints& points);

}  // namespace hgmm::evaluation
