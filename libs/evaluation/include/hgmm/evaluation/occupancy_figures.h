#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "hgmm/evaluation/calibration.h"
#include "hgmm/evaluation/roc.h"
#include "hgmm/evaluation/test_points.h"
#include "hgmm/map.h"

namespace hgmm::evaluation {

/// What any map says about one point.
struct Answer {
    double probability = 0.5;  ///< of being occupied, [0, 1]; 0.5 where nothing is known
    bool unknown = true;       ///< whether the map says that it does not know
};

/// Asks a map about n points [m, map frame], writing n answers: all that a map has to offer
/// to be evaluated.
using BatchQuery =
    std::function<void(const Eigen::Vector3d* points_map, std::size_t n, Answer* answers)>;

/// A level of a Gaussian mixture map, which must outlive the result. Its word for a point
/// is Occupancy::probability(), and it does not know where P(unknown) > 0.5.
BatchQuery queryOf(const Map& map, std::size_t level = 0);

/// Points asked for at a time (protocol, step 6).
constexpr std::size_t kQueryBatch = 10000;

/// The answers to all points, in their order.
std::vector<Answer> answersOf(const BatchQuery& query, const Points& points_map);

/// Occupancy against test points (protocol, step 4). Hits are the positives; calibration
/// (Brier score, log-loss, reliability) is of hits and near free points 1:1, so that hits
/// whose ray is too short for a near free point are left out there.
struct OccupancyFigures {
    std::size_t hits = 0, uniformFree = 0, nearFree = 0;  ///< points asked for
    RocCurve rocUniform, rocNear;       ///< against uniform and near free points
    double aucUniform = 0.0;            ///< [0, 1]
    double aucNear = 0.0;               ///< [0, 1]
    double balancedAccuracyNear = 0.0;  ///< at p = 0.5, [0, 1]
    double brier = 0.0;                 ///< [0, 1]
    double logLoss = 0.0;               ///< [nat]
    std::vector<ReliabilityBin> reliability;
    double ece = 0.0;               ///< expected calibration error, [0, 1]
    double unknownShareHit = 0.0;   ///< of hits, [0, 1]
    double unknownShareFree = 0.0;  ///< of uniform free points, [0, 1]
    double unknownShareNear = 0.0;  ///< of near free points, [0, 1]
    double queriesPerSecond = 0.0;  ///< in batches of kQueryBatch
};

/// Throws std::invalid_argument if there are no hits, or all rays are too short for free
/// points of a class, or an answer is not within [0, 1].
OccupancyFigures evaluateOccupancy(const BatchQuery& query, const TestPoints& testPoints);

}  // namespace hgmm::evaluation
