#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hgmm/evaluation/occupancy_figures.h"
#include "hgmm/scan.h"

namespace hgmm::evaluation {

/// Another map that is given the same scans and asked the same questions (protocol, step
/// 8).
class Baseline {
 public:
    virtual ~Baseline() = default;

    /// Class that does the work, as its own library calls it.
    virtual std::string className() const = 0;
    /// What it was made with.
    virtual std::vector<std::pair<std::string, double>> options() const = 0;

    /// Rays from the origin of the scan's sensor frame to its points. Uses one thread.
    virtual void insert(const Scan& scan) = 0;
    /// As BatchQuery; unknown space is 0.5.
    virtual void query(const Eigen::Vector3d* points_map, std::size_t n,
                       Answer* answers) const = 0;
    /// Memory by the map's own account [bytes].
    virtual std::size_t liveBytes() const = 0;
};

/// A baseline as users name it: "octomap:0.05", with its resolution [m]. Throws
/// std::invalid_argument for a name that is not known or a resolution that is not positive.
std::unique_ptr<Baseline> makeBaseline(const std::string& specification);

}  // namespace hgmm::evaluation
