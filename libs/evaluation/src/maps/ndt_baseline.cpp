#include "hgmm/evaluation/ndt_baseline.h"

#include "maps/scan_points.h"

namespace hgmm::evaluation {

std::string NdtBaseline::source() const {
    return "Magnusson et al., Scan registration for autonomous mining vehicles using "
           "3D-NDT, Journal of Field Robotics 2007";
}

std::vector<std::pair<std::string, double>> NdtBaseline::options() const {
    return {{"resolution", edge_m_},
            {"minPoints", kMinCellPoints},
            {"maxEigenvalueRatio", kMaxEigenvalueRatio}};
}

void NdtBaseline::insert(const Scan& scan) {
    std::vector<std::size_t> changed;
    for (const Eigen::Vector3d& p_map : finitePointsInMap(scan)) {
        if (!hasVoxel(p_map, edge_m_)) continue;
        const VoxelIndex voxel = voxelOf(p_map, edge_m_);
        const std::size_t number = cells_.numberOf(voxel);
        Cell& cell = cells_.cell(number);
        cell.sums.add(p_map - centreOf(voxel, edge_m_));
        cell.gaussian.reset();
        if (changed.empty() || changed.back() != number) changed.push_back(number);
    }
    for (const std::size_t number : changed) {
        Cell& cell = cells_.cell(number);
        if (!cell.gaussian)
            cell.gaussian =
                gaussianOf(cell.sums, centreOf(cells_.index(number), edge_m_), edge_m_);
    }
}

std::optional<CellGaussian> NdtBaseline::gaussianAt(const Eigen::Vector3d& p_map) const {
    const Cell* cell =
        hasVoxel(p_map, edge_m_) ? cells_.find(voxelOf(p_map, edge_m_)) : nullptr;
    return cell != nullptr ? cell->gaussian : std::nullopt;
}

Answer NdtBaseline::answer(const Eigen::Vector3d& p_map) const {
    Answer result{0.0, true};
    if (!hasVoxel(p_map, edge_m_)) return result;
    const VoxelIndex own = voxelOf(p_map, edge_m_);
    double density = 0.0;
    for (int i = 0; i < 27; ++i) {
        const VoxelIndex offset(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        const Cell* cell = cells_.find(own + offset);
        if (cell == nullptr || !cell->gaussian) continue;
        density += cell->gaussian->density(p_map);
        result.unknown = false;
    }
    result.probability = density / (density + 1.0);
    return result;
}

void NdtBaseline::query(const Eigen::Vector3d* points_map, std::size_t n,
                        Answer* answers) const {
    for (std::size_t i = 0; i < n; ++i) answers[i] = answer(points_map[i]);
}

}  // namespace hgmm::evaluation
