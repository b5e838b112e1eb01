// Distances to the nearest surface, beside those of a Euclidean distance transform
// (dynamicEDT3D, Lau et al. 2013) of an OctoMap of the same scans.
//   build/bin/bench-distance room [NOISE_M]               a simulated room, 0.005 if unset
//   build/bin/bench-distance LOG.rawlog POSES.tum CELL_M  a recording
// The truth is the distance to the room's faces, or to the nearest of all points, of which
// each voxel of CELL_M / 10 keeps one. Points asked about are drawn along rays (in the
// room: anywhere in free space), at most 2 m from a surface. Both maps look 3 m far.
#include <dynamicEDT3D/dynamicEDTOctomap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <octomap/OcTree.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "hgmm/evaluation/recording.h"
#include "hgmm/evaluation/voxel_hash.h"
#include "hgmm/map.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "scenes.h"

namespace {

using namespace hgmm;
using Eigen::Vector3d;
using evaluation::hasVoxel;
using evaluation::VoxelHash;
using evaluation::voxelOf;

constexpr double kFarthest_m = 2.0, kTruncation_m = 3.0, kNear_m = 0.1;
constexpr std::size_t kPoints = 20000;

/// What a point is told, or the truth of it.
struct Answer {
    double distance_m = 0.0;
    Vector3d away = Vector3d::Zero();  ///< unit vector away from the surface
    double std_m = 0.0;
    bool isAnswered = true;
};

struct Scene {
    std::function<void(const std::function<void(const Scan&)>&)> forEachScan;
    std::vector<Vector3d> points;
    std::vector<Answer> truths;
    double cell_m;  ///< of the octomap
};

/// From a point outside of a box, or inside of the room, to the nearest face.
Answer toRoom(const testing::RoomScanner& scanner, const Vector3d& p) {
    Answer answer;
    answer.distance_m = kTruncation_m;
    const auto offer = [&](const Vector3d& nearest) {
        const double d = (p - nearest).norm();
        if (d >= answer.distance_m) return;
        answer.distance_m = d;
        answer.away = (p - nearest) / d;
    };
    for (int d = 0; d < 3; ++d)
        for (const Vector3d& corner : {scanner.room.min(), scanner.room.max()}) {
            Vector3d onFace = p;
            onFace[d] = corner[d];
            offer(onFace);
        }
    for (const testing::Box& box : scanner.furniture)
        offer(p.cwiseMax(box.min()).cwiseMin(box.max()));
    return answer;
}

Scene room(double noise_m) {
    testing::RoomScanner scanner;
    scanner.elevations = 48;
    scanner.elevationSpan_rad = 1.4;
    scanner.noiseStd_m = noise_m;
    Scene scene;
    scene.cell_m = 0.05;
    scene.forEachScan = [scanner](const std::function<void(const Scan&)>& visit) {
        for (int k = 0; k < 12; ++k)
            visit(scanner.scan(testing::walk(k), 100 + static_cast<std::uint64_t>(k)));
    };
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    while (scene.points.size() < kPoints) {
        Vector3d p;
        for (int d = 0; d < 3; ++d)
            p[d] = scanner.room.min()[d] + unit(engine) * scanner.room.sizes()[d];
        const Answer truth = toRoom(scanner, p);
        const bool isInside =
            std::any_of(scanner.furniture.begin(), scanner.furniture.end(),
                        [&](const testing::Box& box) { return box.contains(p); });
        if (isInside || truth.distance_m > kFarthest_m) continue;
        scene.points.push_back(p);
        scene.truths.push_back(truth);
    }
    return scene;
}

/// All points of a recording, of which each voxel keeps one, and the nearest of them.
class Cloud {
 public:
    explicit Cloud(double voxel_m) : voxel_m_(voxel_m) {}

    void add(const Vector3d& p) {
        if (!hasVoxel(p, voxel_m_)) return;
        const std::size_t before = taken_.size();
        if (taken_.numberOf(voxelOf(p, voxel_m_)) == before)
            points_.insertPointFast(float(p.x()), float(p.y()), float(p.z()));
    }
    Answer nearestTo(const Vector3d& p) const {
        float x = 0.F, y = 0.F, z = 0.F, squared = 0.F;
        points_.kdTreeClosestPoint3D(float(p.x()), float(p.y()), float(p.z()), x, y, z,
                                     squared);
        const Vector3d away = p - Vector3d(double(x), double(y), double(z));
        return {away.norm(), away.normalized(), 0.0, true};
    }

 private:
    double voxel_m_;
    VoxelHash<char> taken_;
    mrpt::maps::CSimplePointsMap points_;
};

void forEachScanOf(const std::string& log, const std::string& poses,
                   const std::function<void(const Scan&)>& visit) {
    evaluation::RecordingOptions options;
    options.posesFile = poses;
    evaluation::Recording recording(log, options);
    while (const auto recorded = recording.next())
        if (const auto scan = mrpt_bridge::observationToScan(
                *recorded->observation, recorded->T_map_robot, mrpt_bridge::Channels::none))
            visit(*scan);
}

Vector3d pointOf(const Scan& scan, std::size_t i) {
    return scan.T_map_sensor.R * Vector3d(scan.x[i], scan.y[i], scan.z[i]) +
           scan.T_map_sensor.t;
}

Scene recorded(const std::string& log, const std::string& poses, double cell_m) {
    Scene scene;
    scene.cell_m = cell_m;
    scene.forEachScan = [=](const std::function<void(const Scan&)>& visit) {
        forEachScanOf(log, poses, visit);
    };
    Cloud cloud(cell_m / 10);
    std::vector<Vector3d> candidates;
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    scene.forEachScan([&](const Scan& scan) {
        for (std::size_t i = 0; i < scan.size(); ++i) {
            const Vector3d p = pointOf(scan, i);
            if (!p.allFinite()) continue;
            cloud.add(p);
            if (unit(engine) * double(scan.size()) > 1000) continue;
            const Vector3d& origin = scan.T_map_sensor.t;
            candidates.push_back(origin + unit(engine) * (p - origin));
        }
    });
    std::shuffle(candidates.begin(), candidates.end(), engine);
    for (const Vector3d& p : candidates) {
        if (scene.points.size() == kPoints) break;
        const Answer truth = cloud.nearestTo(p);
        if (truth.distance_m > kFarthest_m) continue;
        scene.points.push_back(p);
        scene.truths.push_back(truth);
    }
    return scene;
}

/// Nanoseconds of the processor for each point, the second time.
template <typename Work>
double nanosecondsOf(const Work& work) {
    work();
    const std::clock_t begin = std::clock();
    work();
    return 1e9 * double(std::clock() - begin) / CLOCKS_PER_SEC / double(kPoints);
}

void report(const char* name, const Scene& scene, const std::vector<Answer>& answers,
            double ns, double megabytes) {
    double error = 0, bias = 0;
    std::size_t answered = 0, within = 0, beyond = 0, aligned = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const Answer &a = answers[i], &truth = scene.truths[i];
        if (!a.isAnswered) continue;
        const double off = a.distance_m - truth.distance_m;
        ++answered;
        error += std::abs(off);
        bias += off;
        within += std::abs(off) <= a.std_m ? 1 : 0;
        if (truth.distance_m < kNear_m) continue;
        ++beyond;
        aligned += a.away.dot(truth.away) > std::cos(5 * M_PI / 180) ? 1 : 0;
    }
    const auto of = [](double part, std::size_t all) {
        return part / double(std::max<std::size_t>(all, 1));
    };
    std::printf("| %s | %.1f %% | %.4f | %+.4f | %.2f | %.3f | %.0f | %.2f |\n", name,
                100 * of(double(answered), answers.size()), of(error, answered),
                of(bias, answered), of(double(within), answered),
                of(double(aligned), beyond), ns, megabytes);
}

void ours(const Scene& scene, const Map& map) {
    DistanceParams params;
    params.maxDistance_m = kTruncation_m;
    std::vector<SurfaceDistance> found(scene.points.size());
    const double ns = nanosecondsOf([&] {
        map.distance(scene.points.data(), scene.points.size(), found.data(), params);
    });
    std::vector<Answer> answers;
    for (const SurfaceDistance& f : found)
        answers.push_back({f.distance_m, f.gradient, f.std_m, f.answered()});
    report("hgmm", scene, answers, ns, double(map.liveBytes()) / 1e6);
}

void transform(const Scene& scene, octomap::OcTree& tree) {
    double x, y, z;
    tree.getMetricMin(x, y, z);
    const octomap::point3d low(static_cast<float>(x), static_cast<float>(y),
                               static_cast<float>(z));
    tree.getMetricMax(x, y, z);
    const octomap::point3d high(static_cast<float>(x), static_cast<float>(y),
                                static_cast<float>(z));
    DynamicEDTOctomap edt(static_cast<float>(kTruncation_m), &tree, low, high, false);
    edt.update();
    std::vector<Answer> answers(scene.points.size());
    const double ns = nanosecondsOf([&] {
        for (std::size_t i = 0; i < answers.size(); ++i) {
            const Vector3d& p = scene.points[i];
            float distance = 0.F;
            octomap::point3d nearest;
            edt.getDistanceAndClosestObstacle({float(p.x()), float(p.y()), float(p.z())},
                                              distance, nearest);
            answers[i].isAnswered = distance >= 0.F && double(distance) < kTruncation_m;
            answers[i].distance_m = double(distance);
            answers[i].away = (p - Vector3d(double(nearest.x()), double(nearest.y()),
                                            double(nearest.z())))
                                  .normalized();
        }
    });
    // A cell of the transform holds a distance, a place and two flags.
    constexpr double kBytesPerCell = 24;
    const double cells = double((high - low).x()) * double((high - low).y()) *
                         double((high - low).z()) / std::pow(scene.cell_m, 3);
    report("dynamicEDT3D on OctoMap", scene, answers, ns,
           (cells * kBytesPerCell + double(tree.memoryUsage())) / 1e6);
}

void compare(const Scene& scene) {
    Map map;
    octomap::OcTree tree(scene.cell_m);
    const auto insert = [&](const Scan& scan) {
        map.insert(scan);
        octomap::Pointcloud cloud;
        for (std::size_t i = 0; i < scan.size(); ++i) {
            const Eigen::Vector3f p = pointOf(scan, i).cast<float>();
            if (p.allFinite()) cloud.push_back(p.x(), p.y(), p.z());
        }
        const Eigen::Vector3f t = scan.T_map_sensor.t.cast<float>();
        tree.insertPointCloud(cloud, {t.x(), t.y(), t.z()}, -1, false, true);
    };
    scene.forEachScan(insert);
    std::puts(
        "| map | answered | error [m] | bias [m] | within one std | gradient within 5 deg "
        "| ns | MB |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |");
    ours(scene, map);
    transform(scene, tree);
}

}  // namespace

int main(int argc, char** argv) {
    const std::string first = argc > 1 ? argv[1] : "";
    const bool isRoom = first == "room" && argc <= 3, isLog = first != "room" && argc == 4;
    const double number = argc > 2 ? std::atof(argv[argc - 1]) : 0.005;
    if (!(isRoom || isLog) || !(number > 0)) {
        std::fputs(
            "usage: bench-distance room [NOISE_M]\n"
            "       bench-distance LOG.rawlog POSES.tum CELL_M\n",
            stderr);
        return 2;
    }
    try {
        omp_set_num_threads(1);
        compare(isRoom ? room(number) : recorded(argv[1], argv[2], number));
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench-distance: %s\n", e.what());
        return 1;
    }
}
