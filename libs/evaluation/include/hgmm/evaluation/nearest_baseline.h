#pragma once
#include <memory>

#include "hgmm/evaluation/baseline.h"

namespace hgmm::evaluation {

/// The points of all scans, and how near the nearest one is: no map, but what maps without
/// a model of free space can reach at most. A point's score is 1 / (1 + d / kNearScale_m)
/// with d its distance from the nearest. Of points within one cube of kThinning_m the first
/// is kept.
class NearestBaseline : public Baseline {
 public:
    static constexpr double kNearScale_m = 0.1;   ///< distance of score 1/2 [m]
    static constexpr double kThinning_m = 0.005;  ///< below the noise of range sensors [m]

    NearestBaseline();
    ~NearestBaseline() override;

    std::string className() const override { return "nanoflann::KDTreeSingleIndexAdaptor"; }
    std::string source() const override;
    std::vector<std::pair<std::string, double>> options() const override;
    Meaning meaning() const override { return Meaning::nearness; }
    void insert(const Scan& scan) override;
    /// Nothing is unknown once there are points, but points that are not finite; what is
    /// unknown scores 0. Builds the index if there were scans since it was built.
    void query(const Eigen::Vector3d* points_map, std::size_t n,
               Answer* answers) const override;
    /// Points, and the index if no scan came since it was built.
    std::size_t liveBytes() const override;

 private:
    struct Cloud;
    std::unique_ptr<Cloud> cloud_;
};

}  // namespace hgmm::evaluation
