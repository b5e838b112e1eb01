#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace hgmm {

/// Components of a mixture in a binary tree by their means, with what bounds a divergence
/// from below: KL(f || g) >= (mu_f - mu_g)_a^2 / (2 Sigma_g,aa) for any axis a. The tree
/// stays as it is built while components change, merge and vanish; refit() brings its
/// bounds up to date.
template <int D>
class BoundTree {
 public:
    using Point = std::array<double, D>;

    struct Item {
        Point mean, variance;    ///< variances > 0, those that a factored component has
        double logWeight = 0.0;  ///< log of its share of the mixture
        bool isLeft = true;      ///< false: it is gone
    };
    /// What holds of all items of a node that are left.
    struct Node {
        Point low, high;  ///< of their means
        Point widest;     ///< largest variances
        double heaviest;  ///< largest logWeight
        bool isEmpty;
        std::uint32_t begin, end;  ///< places of its items, all of them
        std::uint32_t right;       ///< its second child; the first follows it. 0: a leaf
        int axis;                  ///< along which its children lie
        double border;             ///< between them

        /// Distance from a point to its means along an axis.
        double gap(const Point& from, int a) const {
            return std::max(std::max(low[a] - from[a], from[a] - high[a]), 0.0);
        }
    };

    BoundTree() = default;
    explicit BoundTree(std::vector<Item> items) : items_(std::move(items)) {
        order_.resize(items_.size());
        for (std::uint32_t k = 0; k < order_.size(); ++k) order_[k] = k;
        if (!items_.empty()) build(0, static_cast<std::uint32_t>(items_.size()));
        refit();
    }

    const Item& item(std::uint32_t k) const { return items_[k]; }
    /// To be changed, before refit().
    Item& item(std::uint32_t k) { return items_[k]; }
    void refit();

    /// Calls visit(k) for each item k that is left in nodes of which mayHold(node) says so,
    /// nodes that are nearer to a point before others.
    template <typename MayHold, typename Visit>
    void visit(const Point& from, MayHold&& mayHold, Visit&& visit) const;

 private:
    static constexpr std::uint32_t kLeaf = 8;

    void build(std::uint32_t begin, std::uint32_t end);
    void setBounds(Node& node) const;
    void unite(Node& node, const Node& a, const Node& b) const;

    std::vector<Item> items_;
    std::vector<std::uint32_t> order_;  ///< items by place
    std::vector<Node> nodes_;           ///< parents before their children
};

template <int D>
void BoundTree<D>::build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t own = nodes_.size();
    Node node{};
    node.begin = begin, node.end = end;
    setBounds(node);
    nodes_.push_back(node);
    if (end - begin <= kLeaf) return;
    for (int a = 1; a < D; ++a)
        if (node.high[a] - node.low[a] > node.high[node.axis] - node.low[node.axis])
            node.axis = a;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t k, std::uint32_t l) {
                         const double a = items_[k].mean[node.axis],
                                      b = items_[l].mean[node.axis];
                         return a != b ? a < b : k < l;
                     });
    node.border = items_[order_[middle]].mean[node.axis];
    build(begin, middle);
    node.right = static_cast<std::uint32_t>(nodes_.size());
    nodes_[own] = node;
    build(middle, end);
}

template <int D>
void BoundTree<D>::setBounds(Node& node) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    node.low.fill(kInfinity), node.high.fill(-kInfinity), node.widest.fill(0.0);
    node.heaviest = -kInfinity;
    node.isEmpty = true;
    for (std::uint32_t p = node.begin; p < node.end; ++p) {
        const Item& item = items_[order_[p]];
        if (!item.isLeft) continue;
        node.isEmpty = false;
        node.heaviest = std::max(node.heaviest, item.logWeight);
        for (int a = 0; a < D; ++a) {
            node.low[a] = std::min(node.low[a], item.mean[a]);
            node.high[a] = std::max(node.high[a], item.mean[a]);
            node.widest[a] = std::max(node.widest[a], item.variance[a]);
        }
    }
}

template <int D>
void BoundTree<D>::unite(Node& node, const Node& a, const Node& b) const {
    for (int d = 0; d < D; ++d) {
        node.low[d] = std::min(a.low[d], b.low[d]);
        node.high[d] = std::max(a.high[d], b.high[d]);
        node.widest[d] = std::max(a.widest[d], b.widest[d]);
    }
    node.heaviest = std::max(a.heaviest, b.heaviest);
    node.isEmpty = a.isEmpty && b.isEmpty;
}

template <int D>
void BoundTree<D>::refit() {
    for (std::size_t k = nodes_.size(); k-- > 0;) {
        Node& node = nodes_[k];
        if (node.right == 0)
            setBounds(node);
        else
            unite(node, nodes_[k + 1], nodes_[node.right]);
    }
}

template <int D>
template <typename MayHold, typename Visit>
void BoundTree<D>::visit(const Point& from, MayHold&& mayHold, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::uint32_t open[64];  // halves of halves: never more than log2 of their number
    int count = 0;
    open[count++] = 0;
    while (count > 0) {
        const std::uint32_t k = open[--count];
        const Node& node = nodes_[k];
        if (node.isEmpty || !mayHold(node)) continue;
        if (node.right == 0) {
            for (std::uint32_t p = node.begin; p < node.end; ++p)
                if (items_[order_[p]].isLeft) visit(order_[p]);
            continue;
        }
        const bool isBeyond = from[node.axis] >= node.border;
        open[count++] = isBeyond ? k + 1 : node.right;
        open[count++] = isBeyond ? node.right : k + 1;
    }
}

}  // namespace hgmm
