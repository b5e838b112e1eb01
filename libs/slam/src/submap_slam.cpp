#include "hgmm/slam/submap_slam.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "drift.h"
#include "submap_slam_impl.h"

namespace hgmm::slam {
namespace {

void requireRigid(const Pose& pose, const char* name) {
    const Eigen::Matrix3d off = pose.R.transpose() * pose.R - Eigen::Matrix3d::Identity();
    if (!pose.t.allFinite() || !(off.cwiseAbs().maxCoeff() < 1e-3) ||
        !(pose.R.determinant() > 0))
        throw std::invalid_argument(std::string(name) + ": is not a rigid transform");
}

/// Median distance of a scan's samples [m]; 0 without any.
double medianRange(const Mixture<3>& samples_sensor) {
    std::vector<float> squares;
    for (std::size_t i = 0; i < samples_sensor.size(); ++i) {
        float square = 0;
        for (const std::vector<float>& axis : samples_sensor.mean)
            square += axis[i] * axis[i];
        squares.push_back(square);
    }
    if (squares.empty()) return 0.0;
    const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
    std::nth_element(squares.begin(), middle, squares.end());
    return std::sqrt(static_cast<double>(*middle));
}

}  // namespace

void SlamParams::validate() const {
    submap.validate();
    drift.validate();
    closure.validate();
    optimisation.validate();
    earlier.validate();
}

void SubmapSlam::Impl::begin(const Pose& T_world_robot) {
    current = Submap(mapParams);
    T_submap_robot = {};
    T_submap_robot.T_a_b.R = T_world_robot.R;
    graph.T_world_node.push_back({Eigen::Matrix3d::Identity(), T_world_robot.t});
}

void SubmapSlam::Impl::require(const UncertainPose& T_previous_robot) const {
    requireRigid(T_previous_robot.T_a_b, "T_previous_robot");
    if (!T_previous_robot.covariance.allFinite())
        throw std::invalid_argument("T_previous_robot: the covariance is not finite");
    if (isFinished()) throw std::logic_error("SubmapSlam: was given a scan after finish");
}

bool SubmapSlam::Impl::isComplete() const {
    const SubmapParams& p = params.submap;
    const double length_m =
        std::clamp(p.lengthPerRange * range_m, p.minLength_m, p.maxLength_m);
    return static_cast<int>(current.T_submap_robot.size()) >= p.minScans &&
           (current.length_m >= length_m || current.turn_rad >= p.maxTurn_rad);
}

void SubmapSlam::Impl::complete() {
    enterClosures();
    submaps.push_back(std::make_shared<const FinishedSubmap>(std::move(current)));
    beginSearch();
}

void SubmapSlam::Impl::beginSearch() {
    search = std::async(std::launch::async, [all = submaps, known = graph, slam = params] {
        omp_set_num_threads(1);  // the front has the others
        return compareNewest(all, known, slam);
    });
}

void SubmapSlam::Impl::next() {
    const UncertainPose T_last_robot = T_submap_robot;
    complete();
    const std::size_t last = submaps.size() - 1;
    begin(graph.T_world_node[last] * T_last_robot.T_a_b);
    UncertainPose T_last_next = T_last_robot;
    T_last_next.T_a_b = graph.T_world_node[last].inverse() * graph.T_world_node.back();
    graph.edges.push_back({last, last + 1, T_last_next, PoseEdge::Kind::odometry});
}

void SubmapSlam::Impl::move(const UncertainPose& motion) {
    T_submap_robot = T_submap_robot * motion;
    T_submap_robot.T_a_b.R = orthonormal(T_submap_robot.T_a_b.R);
    current.length_m += motion.T_a_b.t.norm();
    current.turn_rad += rotationVectorOf(motion.T_a_b.R).norm();
}

void SubmapSlam::Impl::enterClosures() {
    if (!search.valid()) return;
    Compared compared = search.get();
    if (compared.contradictsGraph) doubtOdometryTo(submaps.size() - 1, graph);
    closures += pool.enter(std::move(compared.closures), graph);
}

void SubmapSlam::Impl::closeWithEarlier(const EarlierMap& map,
                                        const std::vector<PoseEdge>& found) {
    const std::size_t start = found.front().to - 1;
    std::vector<std::size_t> order;
    for (std::size_t k = start; k < submaps.size(); ++k) order.push_back(k);
    for (std::size_t k = start; k-- > 0;) order.push_back(k);
    for (const std::size_t k : order) {
        const bool known =
            std::any_of(found.begin(), found.end(),
                        [&](const PoseEdge& edge) { return edge.to == k + 1; });
        if (known || endsEarly(*submaps[k], params.submap)) continue;
        const auto place =
            map.placeNear(*submaps[k], poseOfAll(graph, 0)[k + 1], params.closure);
        if (!place) continue;
        closures += pool.enter({{0, k + 1, *place, PoseEdge::Kind::closure}}, graph);
    }
}

SubmapSlam::SubmapSlam(const MapParams& map, const SlamParams& params) {
    params.validate();
    map.validate();
    impl_ = std::make_unique<Impl>(map, params);
}

SubmapSlam::~SubmapSlam() = default;

void SubmapSlam::add(const ScanSamples& scan, const Pose& T_robot_sensor,
                     const UncertainPose& T_previous_robot) {
    Impl& s = *impl_;
    requireRigid(T_robot_sensor, "T_robot_sensor");
    s.require(T_previous_robot);
    const double range_m = medianRange(scan.samples_sensor);
    if (!s.started) {
        s.begin({});
        s.range_m = range_m;
        s.started = true;
    } else {
        s.move(withDrift(T_previous_robot, s.params.drift));
        s.range_m += 0.1 * (range_m - s.range_m);
        if (s.isComplete() || isGuess(s.T_submap_robot)) s.next();
    }
    const Pose T_submap_sensor = s.T_submap_robot.T_a_b * T_robot_sensor;
    if (s.current.map.empty()) s.current.sensor_submap = T_submap_sensor.t;
    s.current.map.insert(scan, T_submap_sensor);
    s.current.T_submap_robot.push_back(s.T_submap_robot.T_a_b);
}

void SubmapSlam::addLost(const UncertainPose& T_previous_robot) {
    Impl& s = *impl_;
    s.require(T_previous_robot);
    if (!s.started) {
        s.begin({});
        s.started = true;
    }
    Pose T_submap_robot = s.T_submap_robot.T_a_b * T_previous_robot.T_a_b;
    T_submap_robot.R = orthonormal(T_submap_robot.R);
    s.current.T_submap_robot.push_back(T_submap_robot);
}

void SubmapSlam::finish() {
    Impl& s = *impl_;
    if (s.started && !s.isFinished()) s.complete();
    s.enterClosures();
}

Continuation SubmapSlam::continueFrom(std::shared_ptr<const Map> earlier) {
    Impl& s = *impl_;
    if (s.started && !s.isFinished())
        throw std::logic_error("SubmapSlam: a map is gone on from after finish");
    if (s.earlier) throw std::logic_error("SubmapSlam: has gone on from a map already");
    const EarlierMap map(earlier, s.params.earlier);
    if (!s.started) return {};
    PoseGraph behind = behindEarlierMap(s.graph);
    const FoundSession found =
        findSession(map, s.submaps, behind, s.params.closure, s.params.submap.minScans);
    const Continuation result{found.sure, found.searched, found.closures.size(),
                              found.elsewhere};
    if (!found.sure) return result;
    const PoseEdge& first = found.closures.front();
    const Pose T_world_session =
        first.T_from_to.T_a_b * behind.T_world_node[first.to].inverse();
    for (std::size_t k = 1; k < behind.T_world_node.size(); ++k)
        behind.T_world_node[k] = T_world_session * behind.T_world_node[k];
    s.graph = std::move(behind);
    s.earlier = std::move(earlier);
    s.pool = ClosurePool(s.params.optimisation);
    s.closures += s.pool.enter(found.closures, s.graph);
    s.closeWithEarlier(map, found.closures);
    return result;
}

std::vector<Pose> SubmapSlam::trajectory() const {
    std::vector<Pose> poses;
    for (std::size_t k = 0; k < impl_->submapCount(); ++k)
        for (const Pose& T_submap_robot : impl_->submap(k).T_submap_robot)
            poses.push_back(impl_->T_world_submap(k) * T_submap_robot);
    return poses;
}

Pose SubmapSlam::T_world_robot() const {
    return impl_->started ? impl_->robot() : Pose{};
}

const PoseGraph& SubmapSlam::graph() const {
    return impl_->graph;
}
std::size_t SubmapSlam::closures() const {
    return impl_->closures;
}
std::size_t SubmapSlam::submaps() const {
    return impl_->submapCount();
}

std::size_t SubmapSlam::parts() const {
    return partsOf(impl_->graph);
}

Map SubmapSlam::fusedMap() const {
    Map fused = impl_->earlier ? *impl_->earlier : Map(impl_->mapParams);
    for (std::size_t k = 0; k < impl_->submapCount(); ++k)
        fused.merge(impl_->submap(k).map, impl_->T_world_submap(k));
    return fused;
}

}  // namespace hgmm::slam
