#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hgmm/evaluation/occupancy_figures.h"
#include "hgmm/evaluation/sensor_kind.h"
#include "hgmm/scan.h"

namespace hgmm::evaluation {

/// What a map's word for a point (Answer::probability) means.
enum class Meaning {
    occupancy,          ///< the probability of being occupied
    surfaceLikelihood,  ///< grows with the density of measured surfaces; no probability
    nearness            ///< grows as a measured point comes nearer; no probability
};

/// Another map that is given the same scans and asked the same questions (protocol, step
/// 8).
class Baseline {
 public:
    virtual ~Baseline() = default;

    /// Class that does the work, as its own library calls it.
    virtual std::string className() const = 0;
    /// The paper that the map comes from, or the library that holds it.
    virtual std::string source() const = 0;
    /// What it was made with.
    virtual std::vector<std::pair<std::string, double>> options() const = 0;
    virtual Meaning meaning() const { return Meaning::occupancy; }

    /// Rays from the origin of the scan's sensor frame to its points; points that are not
    /// finite are left out. Uses one thread.
    virtual void insert(const Scan& scan) = 0;
    /// As BatchQuery; unknown space is 0.5 for maps of occupancy. May finish work that
    /// insert() put off.
    virtual void query(const Eigen::Vector3d* points_map, std::size_t n,
                       Answer* answers) const = 0;
    /// Memory by the map's own account [bytes].
    virtual std::size_t liveBytes() const = 0;
    /// Bytes of the saved map before compression, where the map can be saved.
    virtual std::optional<std::size_t> serializedBytes() const { return std::nullopt; }
};

/// A baseline as users name it: "octomap" with the usual resolution for the sensor, or
/// "octomap:0.05" with its own [m]; baselineNames() lists them. Throws
/// std::invalid_argument, listing the names, for one that is not known, and for a
/// resolution that is not positive.
std::unique_ptr<Baseline> makeBaseline(const std::string& specification,
                                       SensorKind sensor = SensorKind::depthCamera);

/// The names that makeBaseline knows, each with a line that says what it is.
const std::vector<std::pair<std::string, std::string>>& baselineNames();

}  // namespace hgmm::evaluation
