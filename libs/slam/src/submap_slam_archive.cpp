#include <stdexcept>
#include <string>
#include <utility>

#include "io/state_archive.h"
#include "submap_slam_impl.h"

namespace hgmm::slam {
namespace {

constexpr StateKind kSlamState{{'H', 'G', 'M', 'G'}, 1, "saved SLAM"};
constexpr StateKind kSubmapState{{'H', 'G', 'M', 'S'}, 1, "saved submap"};

template <typename Archive>
void archiveEdges(Archive& a, std::vector<PoseEdge>& edges) {
    a.each(edges, [&](PoseEdge& edge) {
        a(edge.from, edge.to, edge.T_from_to.T_a_b, edge.T_from_to.covariance, edge.kind);
    });
}

/// @param submap const for a writer
template <typename Archive, typename AnySubmap>
void archiveSubmap(Archive& a, AnySubmap& submap) {
    a(submap.map, submap.sensor_submap, submap.length_m, submap.turn_rad);
    a.each(submap.T_submap_robot, [&](auto& pose) { a(pose); });
}

/// Of fields that are missing or out of range.
[[noreturn]] void refuse(const StateKind& kind, const std::logic_error& e) {
    throw FormatError(std::string(kind.name) + ": " + e.what());
}

/// Throws std::out_of_range for edges between nodes that are not there.
void requireNodes(const std::vector<PoseEdge>& edges, std::size_t nodes) {
    for (const PoseEdge& edge : edges) {
        if (edge.from >= nodes || edge.to >= nodes)
            throw std::out_of_range("an edge leads to no node");
        if (edge.kind != PoseEdge::Kind::odometry && edge.kind != PoseEdge::Kind::closure)
            throw std::out_of_range("an edge is of no kind");
    }
}

SharedSubmap finishedFrom(const std::vector<std::uint8_t>& bytes) try {
    StateReader in(bytes.data(), bytes.size(), kSubmapState);
    Submap submap{MapParams{}};
    archiveSubmap(in, submap);
    return std::make_shared<const FinishedSubmap>(std::move(submap));
} catch (const std::logic_error& e) {
    refuse(kSubmapState, e);
}

}  // namespace

template <typename Archive>
void SubmapSlam::Impl::archive(Archive& a) {
    a(started, range_m, closures, T_submap_robot.T_a_b, T_submap_robot.covariance);
    a.each(graph.T_world_node, [&](Pose& pose) { a(pose); });
    archiveEdges(a, graph.edges);
    archiveEdges(a, pool.waiting());
    archiveSubmap(a, current);
}

std::size_t SubmapSlam::finishedSubmaps() const {
    return impl_->submaps.size();
}

std::vector<std::uint8_t> SubmapSlam::save() const {
    if (impl_->isFinished()) throw std::logic_error("SubmapSlam: was saved after finish");
    StateWriter out(kSlamState);
    impl_->archive(out);
    return std::move(out).finish();
}

std::vector<std::uint8_t> SubmapSlam::saveSubmap(std::size_t k) const {
    StateWriter out(kSubmapState);
    archiveSubmap(out, impl_->submaps.at(k)->submap);
    return std::move(out).finish();
}

void SubmapSlam::load(
    const std::vector<std::uint8_t>& state,
    const std::function<std::vector<std::uint8_t>(std::size_t k)>& submapOf) {
    auto loaded = std::make_unique<Impl>(impl_->mapParams, impl_->params);
    try {
        StateReader in(state.data(), state.size(), kSlamState);
        loaded->archive(in);
        const std::size_t read = loaded->graph.T_world_node.size();
        if (loaded->started != (read > 0)) throw std::out_of_range("it has no submap");
        requireNodes(loaded->graph.edges, read);
        requireNodes(loaded->pool.waiting(), read);
    } catch (const std::logic_error& e) {
        refuse(kSlamState, e);
    }
    const std::size_t nodes = loaded->graph.T_world_node.size();
    for (std::size_t k = 0; k + 1 < nodes; ++k)
        loaded->submaps.push_back(finishedFrom(submapOf(k)));
    // The search that was on its way began before the node of the submap at hand was
    // there. That node is behind all others, and how they see each other is not changed.
    if (!loaded->submaps.empty()) loaded->beginSearch();
    impl_ = std::move(loaded);
}

}  // namespace hgmm::slam
