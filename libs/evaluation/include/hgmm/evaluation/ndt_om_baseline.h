#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "hgmm/evaluation/baseline.h"
#include "hgmm/evaluation/cell_gaussian.h"
#include "hgmm/evaluation/voxel_hash.h"

namespace hgmm::evaluation {

/// Normal distributions transform occupancy map: cells hold a Gaussian of their points and
/// the log-odds of being occupied. The points of a scan are first gathered by cell; one ray
/// goes to each cell's mean and weighs as many as its points. A cell that the ray passes is
/// the freer, the nearer the ray comes to the cell's Gaussian, unless that is where the ray
/// ends.
///
/// Within a cell, surface points are distributed as its Gaussian N, and free points evenly
/// over its volume V. So the odds of a point x are the odds of its cell times N(x) V. Cells
/// without a Gaussian answer the same throughout, and cells that no ray met are unknown.
class NdtOmBaseline : public Baseline {
 public:
    /// @param resolution_m edge of a cell [m], > 0
    explicit NdtOmBaseline(double resolution_m) : edge_m_(resolution_m) {}

    std::string className() const override { return "hgmm::evaluation::NdtOmBaseline"; }
    std::string source() const override;
    std::vector<std::pair<std::string, double>> options() const override;
    void insert(const Scan& scan) override;
    void query(const Eigen::Vector3d* points_map, std::size_t n,
               Answer* answers) const override;
    /// The cells with their table, and what is known of the points in those with points.
    std::size_t liveBytes() const override;

    /// Probability that the cell at a point is occupied, whatever its Gaussian; nothing if
    /// the cell was never met.
    std::optional<double> cellProbability(const Eigen::Vector3d& p_map) const;

 private:
    static constexpr std::uint32_t kNoSurface = 0xFFFFFFFFU;

    /// Most cells are empty space: those with points keep them elsewhere.
    struct Cell {
        float logOdds = 0.0F;
        std::uint32_t surface = kNoSurface;  ///< number in surfaces_
    };
    struct Surface {
        PointSums sums;
        std::optional<CellGaussian> gaussian;  ///< of the sums
    };

    double edge_m_;
    VoxelHash<Cell> cells_;
    std::vector<Surface> surfaces_;
    VoxelHash<PointSums> hits_;  ///< of one scan; kept for its memory, empty in between

    void traceRay(const Eigen::Vector3d& origin_map, const Eigen::Vector3d& end_map,
                  double weight);
    void addHits(const VoxelIndex& voxel, const PointSums& sums);
    const Cell* cellAt(const Eigen::Vector3d& p_map) const;
};

}  // namespace hgmm::evaluation
