#include "modality/linear_split.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

#include "hgmm/gaussian.h"
#include "modality/channel_sums.h"

namespace hgmm {

namespace {

using PerChannel = std::array<double, kMaxModalities>;

/// A region is cut at one of these many places, this far apart [sigma].
constexpr int kCuts = 5;
constexpr double kCutStep = 0.5;
/// A part needs so many samples for a line to mean something.
constexpr std::size_t kMinSamples = 3;
/// Parameters of a linear function of place.
constexpr double kParametersPerFit = 4;

struct Split {
    double gain = 0;  ///< of the explained share, summed over channels
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    double offset = 0;  ///< samples with direction^T x below it are the first part [m]
};

struct Node {
    LinearRegion region;
    ChannelSums sums;          ///< of the samples
    PerChannel unexplained{};  ///< of the samples
    double pointsInAll = 0;    ///< prior included [count]
    PerChannel unexplainedInAll{};
    bool evaluated = false;
    Split split;

    Node(LinearRegion of, int channels) : region(std::move(of)), sums(channels) {}
};

/// Whether two linear functions instead of one, which explain `gain` more of the samples,
/// are worth their parameters, given all that was ever seen of a region: what varies
/// between scans counts as noise.
bool isWorthwhile(const Node& node, int channels, const PerChannel& gain) {
    double logGain = 0;
    for (int c = 0; c < channels; ++c) {
        const double before = node.unexplainedInAll[c] + 1e-30;
        logGain -= std::log(std::max(1 - gain[c] / before, 1e-12));
    }
    const double n = node.pointsInAll;
    return n * logGain > channels * kParametersPerFit * std::log(n);
}

class Splitter {
 public:
    Splitter(const ChannelSamples& samples, std::vector<LinearRegion> regions,
             const ModalityParams& params)
        : samples_(samples), channels_(samples.channels()) {
        ChannelSums all(channels_);
        nodes_.reserve(2 * regions.size());
        for (LinearRegion& region : regions) {
            addNode(std::move(region));
            all.add(nodes_.back().sums);
        }
        PerChannel spread{};
        all.spread(spread);
        const double noise = all.count() * params.modalityNoise * params.modalityNoise;
        for (int c = 0; c < channels_; ++c) {
            perSpread_[c] = 1 / std::max(spread[c], 1e-12);
            allowed_[c] = params.modalityUnexplained * spread[c] + noise;
        }
    }

    std::vector<LinearRegion> run() {
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) enqueue(i);
        while (!queue_.empty() && tooMuchUnexplained()) {
            const std::uint32_t i = queue_.top().node;
            queue_.pop();
            if (!nodes_[i].evaluated) {
                evaluate(nodes_[i]);
                if (nodes_[i].split.gain > 0) enqueue(i);
            } else {
                divide(i);
            }
        }
        std::vector<LinearRegion> regions;
        for (Node& node : nodes_) regions.push_back(std::move(node.region));
        return regions;
    }

 private:
    struct Candidate {
        double gain;  ///< of its best split, or more than it can be
        std::uint32_t node;
        bool operator<(const Candidate& o) const {
            return gain != o.gain ? gain < o.gain : node > o.node;
        }
    };

    void addNode(LinearRegion region) {
        Node node(std::move(region), channels_);
        for (const std::uint32_t s : node.region.samples) node.sums.add(samples_.sums(s));
        setUnexplained(node);
        nodes_.push_back(std::move(node));
    }

    void setUnexplained(Node& node) {
        node.sums.unexplained(node.unexplained);
        node.evaluated = false;
        for (int c = 0; c < channels_; ++c) unexplained_[c] += node.unexplained[c];
        ChannelSums all = node.sums;
        if (node.region.prior) all.add(*node.region.prior);
        node.pointsInAll = all.count();
        all.unexplained(node.unexplainedInAll);
    }

    double weighted(const PerChannel& sums) const {
        double total = 0;
        for (int c = 0; c < channels_; ++c) total += sums[c] * perSpread_[c];
        return total;
    }

    bool tooMuchUnexplained() const {
        for (int c = 0; c < channels_; ++c)
            if (unexplained_[c] > allowed_[c]) return true;
        return false;
    }

    void enqueue(std::uint32_t i) {
        const Node& node = nodes_[i];
        if (node.region.samples.size() < 2 * kMinSamples ||
            !isWorthwhile(node, channels_, node.unexplained))
            return;
        queue_.push({node.evaluated ? node.split.gain : weighted(node.unexplained), i});
    }

    Eigen::Vector3d meanOf(std::uint32_t s) const {
        return {samples_.mean()[0][s], samples_.mean()[1][s], samples_.mean()[2][s]};
    }

    void evaluate(Node& node) const {
        node.evaluated = true;
        node.split = {};
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(node.sums.covariance());
        for (const int axis : {2, 1}) {
            const double sigma = std::sqrt(std::max(axes.eigenvalues()[axis], 0.0));
            if (sigma > 0) tryCuts(node, axes.eigenvectors().col(axis), sigma);
        }
    }

    void tryCuts(Node& node, const Eigen::Vector3d& direction, double sigma) const {
        std::vector<ChannelSums> bins(kCuts + 1, ChannelSums(channels_));
        std::array<std::size_t, kCuts + 1> inBin{};
        const double first = direction.dot(node.sums.mean()) - kCuts / 2 * kCutStep * sigma;
        const double perStep = 1 / (kCutStep * sigma);
        for (const std::uint32_t s : node.region.samples) {
            const double step = (direction.dot(meanOf(s)) - first) * perStep + 1;
            const auto bin = static_cast<std::size_t>(std::clamp(step, 0.0, double(kCuts)));
            bins[bin].add(samples_.sums(s));
            ++inBin[bin];
        }
        std::vector<ChannelSums> above = bins;
        for (std::size_t b = kCuts; b-- > 0;) above[b].add(above[b + 1]);
        ChannelSums below(channels_);
        std::size_t count = 0;
        for (std::size_t b = 0; b < kCuts; ++b) {
            below.add(bins[b]);
            count += inBin[b];
            if (count < kMinSamples || node.region.samples.size() - count < kMinSamples)
                continue;
            PerChannel parts{}, other{};
            below.unexplained(parts);
            above[b + 1].unexplained(other);
            for (int c = 0; c < channels_; ++c)
                parts[c] = node.unexplained[c] - parts[c] - other[c];
            const double gain = weighted(parts);
            if (gain > node.split.gain && isWorthwhile(node, channels_, parts))
                node.split = {gain, direction, first + double(b) * kCutStep * sigma};
        }
    }

    void divide(std::uint32_t i) {
        LinearRegion whole = std::move(nodes_[i].region);
        const Split split = nodes_[i].split;
        LinearRegion below, above;
        below.component = whole.component;
        for (const std::uint32_t s : whole.samples)
            (split.direction.dot(meanOf(s)) < split.offset ? below : above)
                .samples.push_back(s);
        if (whole.prior) {
            CutComponent parts =
                cut(*whole.prior, channels_, split.direction, split.offset);
            below.prior = std::move(parts.below);
            above.prior = std::move(parts.above);
        }
        for (int c = 0; c < channels_; ++c) unexplained_[c] -= nodes_[i].unexplained[c];
        Node& node = nodes_[i];
        node.sums = ChannelSums(channels_);
        node.region = std::move(below);
        for (const std::uint32_t s : node.region.samples) node.sums.add(samples_.sums(s));
        setUnexplained(node);
        addNode(std::move(above));
        enqueue(i);
        enqueue(static_cast<std::uint32_t>(nodes_.size() - 1));
    }

    const ChannelSamples& samples_;
    int channels_;
    PerChannel perSpread_{}, allowed_{}, unexplained_{};
    std::vector<Node> nodes_;
    std::priority_queue<Candidate> queue_;
};

ChannelGaussian truncated(const ChannelGaussian& whole, int channels,
                          const Eigen::Vector3d& direction, double share, double shift,
                          double shrinkage) {
    const Eigen::Matrix3d C = whole.place.covariance;
    const Eigen::Vector3d along = C * direction;
    const double sigma = std::sqrt(direction.dot(along));
    ChannelGaussian part = whole;
    part.place.support *= share;
    const Eigen::Vector3d move = along / sigma * shift;
    part.place.mean += move;
    part.place.covariance -= along * along.transpose() * (shrinkage / (sigma * sigma));
    for (int c = 0; c < channels; ++c) part.fits[c].mean += part.fits[c].slope.dot(move);
    return part;
}

}  // namespace

std::vector<LinearRegion> splitWhereNotLinear(const ChannelSamples& samples,
                                              std::vector<LinearRegion> regions,
                                              const ModalityParams& params) {
    return Splitter(samples, std::move(regions), params).run();
}

CutComponent cut(const ChannelGaussian& component, int channels,
                 const Eigen::Vector3d& direction, double offset) {
    constexpr double kLeastShare = 0.01;
    const Eigen::Matrix3d C = component.place.covariance;
    const double sigma = std::sqrt(direction.dot(C * direction));
    const double a =
        (offset - direction.dot(Eigen::Vector3d(component.place.mean))) / sigma;
    const double share = 0.5 * std::erfc(-a / std::sqrt(2.0));
    CutComponent parts;
    if (share < kLeastShare) {
        parts.above = component;
    } else if (share > 1 - kLeastShare) {
        parts.below = component;
    } else {
        // Moments of a standard normal below and above a.
        const double peak = std::exp(-0.5 * (a * a + kLogTwoPi));
        const double below = -peak / share, above = peak / (1 - share);
        parts.below =
            truncated(component, channels, direction, share, below, below * (below - a));
        parts.above = truncated(component, channels, direction, 1 - share, above,
                                above * (above - a));
    }
    return parts;
}

}  // namespace hgmm
