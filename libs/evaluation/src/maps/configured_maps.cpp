#include "maps/configured_maps.h"

#include <mrpt/maps/CColouredOctoMap.h>
#include <mrpt/maps/CHeightGridMap2D.h>
#include <mrpt/maps/COctoMap.h>
#include <mrpt/maps/CPointsMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>
#include <exception>
#include <optional>

#include "hgmm/evaluation/nearest_baseline.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "maps/grid3d_access.h"
#include "maps/octree_access.h"
#include "maps/scan_points.h"
#include "maps/serialized_size.h"

namespace hgmm::evaluation {
namespace {

using mrpt::obs::CObservationPointCloud;

/// The finite points of a scan, moved by a pose, as an observation of a sensor at the
/// robot's origin.
CObservationPointCloud cloudOf(const Scan& scan, const Pose& T_robot_sensor) {
    Scan moved = scan;
    moved.T_map_sensor = T_robot_sensor;
    auto cloud = mrpt::maps::CSimplePointsMap::Create();
    for (const Eigen::Vector3d& p : finitePointsInMap(moved))
        cloud->insertPoint(static_cast<float>(p.x()), static_cast<float>(p.y()),
                           static_cast<float>(p.z()));
    CObservationPointCloud observation;
    observation.pointcloud = cloud;
    return observation;
}

/// What all maps of an MRPT configuration have in common.
class ConfiguredBaseline : public Baseline {
 public:
    explicit ConfiguredBaseline(mrpt::maps::CMetricMap::Ptr map) : map_(std::move(map)) {}

    std::string className() const override { return map_->GetRuntimeClass()->className; }
    std::string source() const override { return "MRPT, as configured"; }
    std::vector<std::pair<std::string, double>> options() const override { return {}; }
    void query(const Eigen::Vector3d* points_map, std::size_t n,
               Answer* answers) const override {
        for (std::size_t i = 0; i < n; ++i)
            answers[i] = points_map[i].allFinite() ? answer(points_map[i]) : unknown();
    }
    std::size_t liveBytes() const override { return serializedSize(*map_); }
    std::optional<std::size_t> serializedBytes() const override {
        return serializedSize(*map_);
    }

 protected:
    virtual Answer answer(const Eigen::Vector3d& p_map) const = 0;
    Answer unknown() const { return {meaning() == Meaning::occupancy ? 0.5 : 0.0, true}; }
    mrpt::maps::CMetricMap& map() { return *map_; }
    const mrpt::maps::CMetricMap& map() const { return *map_; }

 private:
    mrpt::maps::CMetricMap::Ptr map_;
};

/// A map as its own class M.
template <class M>
class ConfiguredMap : public ConfiguredBaseline {
 public:
    using ConfiguredBaseline::ConfiguredBaseline;

 protected:
    M& mine() { return static_cast<M&>(map()); }
    const M& mine() const { return static_cast<const M&>(map()); }
};

template <class Octree>
class ConfiguredOctree : public ConfiguredMap<Octree> {
 public:
    using ConfiguredMap<Octree>::ConfiguredMap;
    std::vector<std::pair<std::string, double>> options() const override {
        auto options = optionsOfOctree(this->mine());
        options.emplace_back("pruning", this->mine().insertionOptions.pruning ? 1.0 : 0.0);
        return options;
    }
    void insert(const Scan& scan) override {
        // COctoMap forgets the sensor's pose on the robot: so the sensor is the robot.
        this->map().insertObservation(cloudOf(scan, Pose{}),
                                      mrpt_bridge::toCPose3D(scan.T_map_sensor));
    }
    std::size_t liveBytes() const override { return this->mine().memoryUsage(); }

 protected:
    Answer answer(const Eigen::Vector3d& p_map) const override {
        return answerOfOctree(this->mine(), p_map);
    }
};

/// CColouredOctoMap takes depth images and 2D scans only, but any single ray.
class ConfiguredColouredOctree : public ConfiguredOctree<mrpt::maps::CColouredOctoMap> {
 public:
    using ConfiguredOctree::ConfiguredOctree;
    void insert(const Scan& scan) override {
        if (!map().genericMapParams.enableObservationInsertion) return;
        const Eigen::Vector3f from = scan.T_map_sensor.t.cast<float>();
        for (const Eigen::Vector3d& p_map : finitePointsInMap(scan)) {
            const Eigen::Vector3f to = p_map.cast<float>();
            mine().insertRay(to.x(), to.y(), to.z(), from.x(), from.y(), from.z());
        }
    }
};

class ConfiguredGrid3d : public ConfiguredMap<mrpt::maps::COccupancyGridMap3D> {
 public:
    using ConfiguredMap::ConfiguredMap;
    std::vector<std::pair<std::string, double>> options() const override {
        return {{"resolution", mine().m_grid.getResolutionXY()}};
    }
    void insert(const Scan& scan) override {
        if (map().genericMapParams.enableObservationInsertion)
            insertIntoGrid(finitePointsInMap(scan), scan.T_map_sensor.t, mine());
    }
    std::size_t liveBytes() const override { return bytesOfGrid(mine()); }

 protected:
    Answer answer(const Eigen::Vector3d& p_map) const override {
        return answerOfGrid(mine(), p_map);
    }
};

class ConfiguredPoints : public ConfiguredMap<mrpt::maps::CPointsMap> {
 public:
    using ConfiguredMap::ConfiguredMap;
    Meaning meaning() const override { return Meaning::nearness; }
    void insert(const Scan& scan) override {
        // MRPT 2.5.8 loses the robot's pose: so the cloud is in the map frame.
        map().insertObservation(cloudOf(scan, scan.T_map_sensor), mrpt::poses::CPose3D());
    }

 protected:
    Answer answer(const Eigen::Vector3d& p_map) const override {
        if (mine().isEmpty()) return unknown();
        const Eigen::Vector3f p = p_map.cast<float>();
        float squared = 0.0F;
        mine().kdTreeClosestPoint3D(p.x(), p.y(), p.z(), squared);
        return {1.0 / (1.0 + std::sqrt(squared) / NearestBaseline::kNearScale_m), false};
    }
};

/// Any other class: by what it thinks of an observation of the one point.
class ConfiguredOther : public ConfiguredMap<mrpt::maps::CMetricMap> {
 public:
    using ConfiguredMap::ConfiguredMap;
    Meaning meaning() const override { return Meaning::surfaceLikelihood; }
    void insert(const Scan& scan) override {
        // Height maps make a map of points first, which loses the robot's pose.
        if (map().GetRuntimeClass()->derivedFrom(CLASS_ID(mrpt::maps::CHeightGridMap2D)))
            map().insertObservation(cloudOf(scan, scan.T_map_sensor),
                                    mrpt::poses::CPose3D());
        else
            map().insertObservation(cloudOf(scan, Pose{}),
                                    mrpt_bridge::toCPose3D(scan.T_map_sensor));
    }

 protected:
    Answer answer(const Eigen::Vector3d& p_map) const override {
        Scan point;
        point.pushBack(static_cast<float>(p_map.x()), static_cast<float>(p_map.y()),
                       static_cast<float>(p_map.z()));
        const std::optional<double> logLikelihood = logLikelihoodOf(cloudOf(point, Pose{}));
        if (!logLikelihood || !std::isfinite(*logLikelihood)) return unknown();
        return {1.0 / (1.0 + std::exp(-*logLikelihood)), false};
    }

 private:
    mutable bool mute_ = false;  ///< the class has no likelihood, whatever it says

    std::optional<double> logLikelihoodOf(const CObservationPointCloud& observation) const {
        if (mute_ || map().isEmpty() || !map().canComputeObservationLikelihood(observation))
            return std::nullopt;
        try {
            return map().computeObservationLikelihood(observation, mrpt::poses::CPose3D());
        } catch (const std::exception&) {
            mute_ = true;  // CHeightGridMap2D says that it can, and throws: not implemented
            return std::nullopt;
        }
    }
};

}  // namespace

std::unique_ptr<Baseline> baselineOf(const mrpt::maps::CMetricMap::Ptr& map) {
    using namespace mrpt::maps;
    if (dynamic_cast<COctoMap*>(map.get()) != nullptr)
        return std::make_unique<ConfiguredOctree<COctoMap>>(map);
    if (dynamic_cast<CColouredOctoMap*>(map.get()) != nullptr)
        return std::make_unique<ConfiguredColouredOctree>(map);
    if (dynamic_cast<COccupancyGridMap3D*>(map.get()) != nullptr)
        return std::make_unique<ConfiguredGrid3d>(map);
    if (dynamic_cast<CPointsMap*>(map.get()) != nullptr)
        return std::make_unique<ConfiguredPoints>(map);
    return std::make_unique<ConfiguredOther>(map);
}

}  // namespace hgmm::evaluation
