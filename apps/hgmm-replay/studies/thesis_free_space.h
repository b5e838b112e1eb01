#pragma once
#include <memory>
#include <vector>

#include "hgmm/evaluation/baseline.h"
#include "hgmm/map.h"

namespace replay {

/// Occupancy as the thesis writes it (4.2, 4.3), beside the map's own: each surface
/// component has one component of free space, the moments over (X, W) of all rays that
/// ended in it (4.2.1 in closed form); free points lie 1 mm before surfaces; a point is
/// occupied, free or unknown by the integrals (4.15), (4.16) of (4.8).
///
/// Rays belong to the surfaces that explain their hits when all scans are in. A point that
/// hardly any component reaches is unknown, as in the map (OccupancyParams::knownSigmas).
class ThesisFreeSpace : public hgmm::evaluation::Baseline {
 public:
    explicit ThesisFreeSpace(const hgmm::MapParams& params);
    ~ThesisFreeSpace() override;

    std::string className() const override { return "ThesisFreeSpace"; }
    std::string source() const override { return "thesis 4.2 and 4.3"; }
    std::vector<std::pair<std::string, double>> options() const override;
    void insert(const hgmm::Scan& scan) override;
    void query(const Eigen::Vector3d* points_map, std::size_t n,
               hgmm::evaluation::Answer* answers) const override;
    std::size_t liveBytes() const override;
    std::optional<std::size_t> serializedBytes() const override;

 private:
    struct Model;
    struct InsertedScan {
        hgmm::Mixture<3> samples_local;
        Eigen::Vector3d sensorOrigin_local;
    };

    const Model& model() const;

    hgmm::Map map_;
    std::vector<InsertedScan> scans_;
    mutable std::unique_ptr<const Model> model_;  ///< made for the first query
};

}  // namespace replay
