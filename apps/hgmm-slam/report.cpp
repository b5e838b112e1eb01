#include "report.h"

#include <hgmm/slam/submap.h>
#include <hgmm/surface_distance.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <vector>

namespace hgmm::slam_app {
namespace {

using slam::PoseEdge;

constexpr double kSide = 1000.0;      // of the drawing, the longer one [px]
constexpr double kText = 90.0;        // height of what is written above it [px]
constexpr double kTextWidth = 740.0;  // of it, at most [px]
constexpr double kMargin = 20.0;      // [px]
constexpr double kAbout = 0.02;       // of the extent, about all that is drawn
constexpr double kTail = 0.05;        // share of surfaces that may lie beyond, on each side
constexpr double kPatchReach = 1.7;   // half length of a patch [sigma]

constexpr double kNarrow = 0.3;  // width over length of what stands upright

template <typename... Numbers>
std::string format(const char* pattern, Numbers... numbers) {
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), pattern, numbers...);
    return text.data();
}

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text)
        safe += c == '&'   ? "&amp;"
                : c == '<' ? "&lt;"
                : c == '>' ? "&gt;"
                           : std::string(1, c);
    return safe;
}

/// A surface component from above: a line along its longest horizontal axis. What is narrow
/// there stands upright, or a planar laser saw it.
struct Stroke {
    Eigen::Vector2d from_map, to_map;
    bool upright = false;
};

std::vector<Stroke> strokesOf(const Map& map) {
    const Mixture<3> surfaces = slam::surfacesInMapFrame(map);
    std::vector<Stroke> strokes;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const Gaussian<3> component = surfaces[i];
        if (surfaces.support[i] < kSurfaceSupport) continue;
        const Eigen::Matrix2d covariance =
            Eigen::Matrix3d(component.covariance).topLeftCorner<2, 2>();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
        const Eigen::Vector2d sigma = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
        const Eigen::Vector2d half = kPatchReach * sigma[1] * axes.eigenvectors().col(1);
        const Eigen::Vector2d centre = Eigen::Vector3d(component.mean).head<2>();
        strokes.push_back({centre - half, centre + half, sigma[0] < kNarrow * sigma[1]});
    }
    return strokes;
}

/// From the map to the drawing: x to the right, y upwards.
class Paper {
 public:
    Paper(const std::vector<Stroke>& strokes, const evaluation::Trajectory& way) {
        Eigen::AlignedBox2d box;
        for (const evaluation::StampedPose& pose : way)
            box.extend(pose.T_world_frame.t.head<2>());
        std::vector<double> x_map, y_map;
        for (const Stroke& stroke : strokes) {
            x_map.push_back(stroke.from_map.x());
            y_map.push_back(stroke.from_map.y());
        }
        std::sort(x_map.begin(), x_map.end());
        std::sort(y_map.begin(), y_map.end());
        const auto tail = static_cast<std::size_t>(kTail * double(strokes.size()));
        if (!strokes.empty()) {
            box.extend(Eigen::Vector2d(x_map[tail], y_map[tail]));
            box.extend(Eigen::Vector2d(x_map.rbegin()[std::ptrdiff_t(tail)],
                                       y_map.rbegin()[std::ptrdiff_t(tail)]));
        }
        if (box.isEmpty()) box.extend(Eigen::Vector2d::Zero());
        // So that what lies at its border is drawn whole.
        const Eigen::Vector2d about =
            Eigen::Vector2d::Constant(std::max(0.5, kAbout * box.sizes().maxCoeff()));
        box = {box.min() - about, box.max() + about};
        const double extent_m = box.sizes().maxCoeff();
        scale_ = kSide / extent_m;
        corner_map_ = {box.min().x(), box.max().y()};
        size_ = scale_ * box.sizes().cwiseMax(0.3 * extent_m);
    }

    Eigen::Vector2d operator()(const Eigen::Vector2d& p_map) const {
        return {kMargin + scale_ * (p_map.x() - corner_map_.x()),
                kMargin + kText + scale_ * (corner_map_.y() - p_map.y())};
    }
    double pixelsPerMetre() const { return scale_; }
    Eigen::Vector2d size() const { return size_; }

 private:
    double scale_ = 1.0;
    Eigen::Vector2d corner_map_, size_;
};

/// A path of all strokes of a kind. What lies above each other is drawn once.
std::string pathOf(const std::vector<Stroke>& strokes, bool upright, const Paper& paper) {
    std::set<std::array<int, 4>> lines;
    for (const Stroke& stroke : strokes) {
        if (stroke.upright != upright) continue;
        const Eigen::Vector2i a = paper(stroke.from_map).array().round().cast<int>();
        const Eigen::Vector2i b = paper(stroke.to_map).array().round().cast<int>();
        lines.insert({a.x(), a.y(), b.x() - a.x(), b.y() - a.y()});
    }
    std::string path;
    for (const auto& [x, y, dx, dy] : lines) path += format("M%d %dl%d %d", x, y, dx, dy);
    return path;
}

std::string lineBetween(const slam::PoseGraph& graph, const PoseEdge& edge,
                        const Paper& paper) {
    const Eigen::Vector2d a = paper(graph.T_world_node[edge.from].t.head<2>());
    const Eigen::Vector2d b = paper(graph.T_world_node[edge.to].t.head<2>());
    return format("M%.1f %.1fL%.1f %.1f", a.x(), a.y(), b.x(), b.y());
}

std::string drawnGraph(const SlamRun& run, const Paper& paper) {
    const slam::PoseGraph& graph = run.slam->graph();
    const std::size_t first = run.continuation.found ? 1 : 0;
    std::set<std::size_t> inEarlierMap;
    std::string loops, nodes;
    for (const PoseEdge& edge : graph.edges) {
        if (edge.kind != PoseEdge::Kind::closure) continue;
        if (edge.from < first)
            inEarlierMap.insert(edge.to);
        else
            loops += lineBetween(graph, edge, paper);
    }
    for (std::size_t k = first; k < graph.T_world_node.size(); ++k) {
        const Eigen::Vector2d p = paper(graph.T_world_node[k].t.head<2>());
        nodes += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4.5\" fill=\"%s\"/>\n", p.x(),
                        p.y(), inEarlierMap.count(k) != 0 ? "#2a2" : "#fff");
    }
    return "<path d=\"" + loops + "\" stroke=\"#e80\" stroke-opacity=\".7\"/>\n" +
           "<g stroke=\"#06c\" stroke-width=\"1.5\">\n" + nodes + "</g>\n";
}

std::string drawnWay(const evaluation::Trajectory& way, const Paper& paper) {
    std::string points;
    for (const evaluation::StampedPose& pose : way) {
        const Eigen::Vector2d p = paper(pose.T_world_frame.t.head<2>());
        points += format("%.1f,%.1f ", p.x(), p.y());
    }
    return "<polyline points=\"" + points + "\" stroke=\"#06c\" stroke-width=\"2.5\"/>\n";
}

/// A bar of 1, 2 or 5 times a power of ten metres, about a fifth of the width.
std::string drawnScale(const Paper& paper) {
    const double about_m = 0.2 * paper.size().x() / paper.pixelsPerMetre();
    const double decade_m = std::pow(10.0, std::floor(std::log10(about_m)));
    const double ratio = about_m / decade_m;
    const double length_m = decade_m * (ratio >= 5 ? 5 : ratio >= 2 ? 2 : 1);
    const double y = kText + 2.5 * kMargin + paper.size().y(), x0 = kMargin;
    const double x1 = x0 + length_m * paper.pixelsPerMetre();
    return format("<path d=\"M%.1f %.1fv8h%.1fv-8\" fill=\"none\" stroke=\"#000\"/>\n", x0,
                  y - 8, x1 - x0) +
           format("<text x=\"%.1f\" y=\"%.1f\">%g m</text>\n", x1 + 8, y, length_m);
}

std::string figuresOf(const SlamRun& run) {
    double way_m = 0.0;
    for (std::size_t i = 1; i < run.trajectory.size(); ++i)
        way_m += (run.trajectory[i].T_world_frame.t - run.trajectory[i - 1].T_world_frame.t)
                     .norm();
    return format("%zu scans (%zu not recognised), way %.1f m, %.1f s",
                  run.trajectory.size(), run.scansLost, way_m, run.seconds);
}

}  // namespace

std::string reportSvg(const SlamRun& run, const Map& map, const std::string& title) {
    const std::vector<Stroke> strokes = strokesOf(map);
    const Paper paper(strokes, run.trajectory);
    const double width = std::max(paper.size().x(), kTextWidth) + 2 * kMargin;
    const double height = paper.size().y() + kText + 3.5 * kMargin;
    const std::size_t parts = run.slam->parts();
    std::string svg = format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
        "font-family=\"sans-serif\" font-size=\"16\">\n",
        width, height);
    svg +=
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<text x=\"20\" y=\"34\" "
        "font-size=\"20\">" +
        escaped(title) + "</text>\n<text x=\"20\" y=\"60\">" + figuresOf(run) +
        "</text>\n<text x=\"20\" y=\"84\">" +
        format("%zu submaps (circles), %zu loop closures (orange%s), ", run.slam->submaps(),
               run.slam->closures(),
               run.continuation.found ? ", green circles: with the earlier map" : "") +
        format(parts == 1 ? "%zu part" : "%zu parts", parts) + "</text>\n";
    svg += format("<svg x=\"%.1f\" y=\"%.1f\" ", kMargin, kMargin + kText) +
           format("width=\"%.1f\" height=\"%.1f\" ", paper.size().x(), paper.size().y()) +
           format("viewBox=\"%.1f %.1f ", kMargin, kMargin + kText) +
           format("%.1f %.1f\">\n", paper.size().x(), paper.size().y());
    svg +=
        "<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<path d=\"" +
        pathOf(strokes, false, paper) +
        "\" stroke=\"#ddd\" stroke-width=\"3\"/>\n<path d=\"" +
        pathOf(strokes, true, paper) + "\" stroke=\"#555\"/>\n" + drawnGraph(run, paper) +
        drawnWay(run.trajectory, paper) + "</g>\n</svg>\n";
    return svg + drawnScale(paper) + "</svg>\n";
}

}  // namespace hgmm::slam_app
