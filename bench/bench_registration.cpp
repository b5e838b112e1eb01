// Registration of pairs of scans, by our mixtures and by the normal distributions transform
// of PCL with several cell sizes: the same pairs and guesses, in one run.
//   build/bin/bench-registration LOG.rawlog POSES.tum [PAIRS]        default: 40 pairs
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/ndt.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "hgmm/evaluation/registration_trials.h"
#include "hgmm/evaluation/sensor_kind.h"

namespace {

using namespace hgmm::evaluation;
using hgmm::Pose;
using hgmm::Scan;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// pcl::NormalDistributionsTransform, the source thinned to one point a leaf.
class PclNdt : public Aligner {
 public:
    PclNdt(float cell_m, float leaf_m, double step_m) : cell_m_(cell_m), leaf_m_(leaf_m) {
        ndt_.setResolution(cell_m);
        ndt_.setStepSize(step_m);
        ndt_.setTransformationEpsilon(1e-3);
        ndt_.setMaximumIterations(50);
    }

    std::string name() const override {
        char text[40];
        std::snprintf(text, sizeof text, "pcl ndt %g m", double(cell_m_));
        return text;
    }

    /// Moved to the sensor's position: PCL computes in floats.
    void setTarget(const Scan& target) override {
        origin_ = target.T_map_sensor.t;
        ndt_.setInputTarget(cloudOf(target, target.T_map_sensor.R));
    }

    void setSource(const Scan& source) override {
        pcl::VoxelGrid<pcl::PointXYZ> filter;
        filter.setLeafSize(leaf_m_, leaf_m_, leaf_m_);
        filter.setInputCloud(cloudOf(source, Eigen::Matrix3d::Identity()));
        Cloud::Ptr thinned(new Cloud);
        filter.filter(*thinned);
        ndt_.setInputSource(thinned);
    }

    Pose align(const Pose& guess) const override {
        Eigen::Matrix4f start = Eigen::Matrix4f::Identity();
        start.topLeftCorner<3, 3>() = guess.R.cast<float>();
        start.topRightCorner<3, 1>() = (guess.t - origin_).cast<float>();
        Cloud aligned;
        ndt_.align(aligned, start);
        const Eigen::Matrix4d found = ndt_.getFinalTransformation().cast<double>();
        return {found.topLeftCorner<3, 3>(), found.topRightCorner<3, 1>() + origin_};
    }

 private:
    static Cloud::Ptr cloudOf(const Scan& scan, const Eigen::Matrix3d& R) {
        Cloud::Ptr cloud(new Cloud);
        for (std::size_t i = 0; i < scan.size(); ++i) {
            const Eigen::Vector3f p =
                (R * Eigen::Vector3d(scan.x[i], scan.y[i], scan.z[i])).cast<float>();
            if (p.allFinite()) cloud->push_back({p.x(), p.y(), p.z()});
        }
        return cloud;
    }

    float cell_m_, leaf_m_;
    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
    mutable pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ> ndt_;
};

std::vector<std::unique_ptr<Aligner>> alignersFor(SensorKind sensor) {
    std::vector<std::unique_ptr<Aligner>> aligners;
    aligners.push_back(makeMixtureAligner({}));
    if (sensor == SensorKind::depthCamera) {
        for (const float cell_m : {0.3F, 0.5F, 1.0F})
            aligners.push_back(std::make_unique<PclNdt>(cell_m, 0.05F, 0.5));
    } else {
        for (const float cell_m : {1.0F, 2.0F, 3.0F})
            aligners.push_back(std::make_unique<PclNdt>(cell_m, 0.2F, 0.5));
    }
    return aligners;
}

}  // namespace

int main(int argc, char** argv) {
    const int pairs = argc == 4 ? std::atoi(argv[3]) : 40;
    if (argc < 3 || argc > 4 || pairs < 1) {
        std::fputs("usage: bench-registration LOG.rawlog POSES.tum [PAIRS]\n", stderr);
        return 2;
    }
    try {
        RecordingOptions options;
        options.posesFile = argv[2];
        Recording recording(argv[1], options);
        RegistrationTrials trials = trialsFor(recording.sensor(), 1);
        trials.maxPairs = static_cast<std::size_t>(pairs);
        const auto figures =
            runTrials(recording, alignersFor(sensorKindOf(recording.sensor())), trials);
        std::fputs(trialsTable(figures, trials).c_str(), stdout);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench-registration: %s\n", e.what());
        return 1;
    }
}
