#pragma once
#include <optional>

#include "hgmm/evaluation/baseline.h"
#include "hgmm/evaluation/cell_gaussian.h"
#include "hgmm/evaluation/voxel_hash.h"

namespace hgmm::evaluation {

/// Normal distributions transform: one Gaussian for the points in each cell of a regular
/// grid. It knows surfaces only: a point's score is s = d / (d + 1 per m^3), where d is the
/// sum of the densities [1/m^3] of its own cell's Gaussian and of those of the 26 cells
/// around it; cells weigh the same, however many points they hold.
class NdtBaseline : public Baseline {
 public:
    /// @param resolution_m edge of a cell [m], > 0
    explicit NdtBaseline(double resolution_m) : edge_m_(resolution_m) {}

    std::string className() const override { return "hgmm::evaluation::NdtBaseline"; }
    std::string source() const override;
    std::vector<std::pair<std::string, double>> options() const override;
    Meaning meaning() const override { return Meaning::surfaceLikelihood; }
    void insert(const Scan& scan) override;
    /// Points with no Gaussian in the 27 cells are unknown, and score 0.
    void query(const Eigen::Vector3d* points_map, std::size_t n,
               Answer* answers) const override;
    std::size_t liveBytes() const override { return cells_.bytes(); }

    /// The Gaussian of the cell that a point lies in, if it has one.
    std::optional<CellGaussian> gaussianAt(const Eigen::Vector3d& p_map) const;

 private:
    struct Cell {
        PointSums sums;
        std::optional<CellGaussian> gaussian;  ///< of the sums
    };

    double edge_m_;
    VoxelHash<Cell> cells_;

    Answer answer(const Eigen::Vector3d& p_map) const;
};

}  // namespace hgmm::evaluation
