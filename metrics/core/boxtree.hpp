// A static tree of boxes: which items may contain a point, and which item is nearest to it.
//
// The boxes are put in the order of a space-filling curve, and every FANOUT consecutive boxes get
// one box around them, level upon level, up to one root:
//
//     level 2   [            0            ]
//     level 1   [     0     ][     1      ]
//     level 0   [0][1][2][3] [4][5][6]            children of k: FANOUT k ... FANOUT k + FANOUT - 1
//
// Nothing is searched by walking, so an answer is definite whatever the shape of the domain.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "metrics/core/radix_sort.hpp"

namespace metrics {

struct Box {
    double x0 = std::numeric_limits<double>::infinity(), y0 = x0, x1 = -x0, y1 = -x0;

    void include(double x, double y) {
        x0 = std::min(x0, x), x1 = std::max(x1, x);
        y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
    void include(const Box& other) {
        x0 = std::min(x0, other.x0), x1 = std::max(x1, other.x1);
        y0 = std::min(y0, other.y0), y1 = std::max(y1, other.y1);
    }
    bool contains(double x, double y) const { return x0 <= x && x <= x1 && y0 <= y && y <= y1; }
    bool meets(const Box& other) const {
        return x0 <= other.x1 && other.x0 <= x1 && y0 <= other.y1 && other.y0 <= y1;
    }
    double squared_distance(double x, double y) const {
        const double dx = std::max(std::max(x0 - x, x - x1), 0.0);
        const double dy = std::max(std::max(y0 - y, y - y1), 0.0);
        return dx * dx + dy * dy;
    }
};

// Puts a zero before each of the low 16 bits: dcba -> 0d0c0b0a.
inline std::uint32_t spread_bits(std::uint32_t v) {
    v = (v | v << 8) & 0x00ff00ffu;
    v = (v | v << 4) & 0x0f0f0f0fu;
    v = (v | v << 2) & 0x33333333u;
    return (v | v << 1) & 0x55555555u;
}

// Item numbers in Morton order of the centres of their boxes.
inline std::vector<std::int32_t> curve_order(const std::vector<Box>& boxes) {
    Box all;
    for (const Box& box : boxes) all.include(box);
    const double side_x = all.x1 - all.x0, side_y = all.y1 - all.y0;
    const auto cell = [](double centre, double low, double side) {
        const double place = (centre - low) / side * 65535;  // NaN where the side is 0 or infinite
        return place > 0 && place <= 65535 ? std::uint32_t(place) : 0u;
    };
    std::vector<std::uint64_t> keys(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Box& box = boxes[i];
        const std::uint32_t code =
            spread_bits(cell(box.x0 + 0.5 * (box.x1 - box.x0), all.x0, side_x)) |
            spread_bits(cell(box.y0 + 0.5 * (box.y1 - box.y0), all.y0, side_y)) << 1;
        keys[i] = std::uint64_t(code) << 32 | i;
    }
    std::vector<std::uint64_t> spare;
    sort_by_number(keys, spare, [](std::uint64_t key) { return std::uint32_t(key >> 32); });
    std::vector<std::int32_t> order(boxes.size());
    for (std::size_t k = 0; k < keys.size(); ++k) order[k] = std::int32_t(keys[k] & 0xffffffff);
    return order;
}

class BoxTree {
  public:
    BoxTree() = default;

    explicit BoxTree(const std::vector<Box>& boxes) : items_(curve_order(boxes)) {
        std::vector<Box> level;
        level.reserve(boxes.size());
        for (std::int32_t item : items_) level.push_back(boxes[item]);
        levels_.push_back(std::move(level));
        while (levels_.back().size() > 1) {
            const std::vector<Box>& below = levels_.back();
            std::vector<Box> above((below.size() + FANOUT - 1) / FANOUT);
            for (std::size_t k = 0; k < below.size(); ++k) above[k / FANOUT].include(below[k]);
            levels_.push_back(std::move(above));
        }
    }

    // The box around all.
    Box bounds() const { return levels_.empty() ? Box() : levels_.back().front(); }

    // Calls visit(item) for each item whose box contains the point, until it returns true.
    template <typename Visit>
    void containing(double x, double y, Visit visit) const {
        matching([x, y](const Box& box) { return box.contains(x, y); }, visit);
    }

    // Calls visit(item) for each item whose box passes a test, until it returns true. A box
    // around one that passes must pass too.
    template <typename Test, typename Visit>
    void matching(Test test, Visit visit) const {
        if (items_.empty()) return;
        Node stack[MAX_DEPTH];
        int depth = 0;
        stack[depth++] = {int(levels_.size()) - 1, 0, 0};
        while (depth > 0) {
            const Node node = stack[--depth];
            if (!test(levels_[node.level][node.index])) continue;
            if (node.level == 0) {
                if (visit(items_[node.index])) return;
                continue;
            }
            for (std::size_t k = first_child(node); k < end_child(node); ++k) {
                stack[depth++] = {node.level - 1, k, 0};
            }
        }
    }

    // The item of smallest squared_distance(item), which must not be less than that to its box;
    // -1 in an empty tree. Of equals, the one of the smallest number. A hint, an item that is
    // probably near, makes it faster and changes nothing else.
    template <typename SquaredDistance>
    std::int32_t nearest(double x, double y, SquaredDistance squared_distance,
                         std::int32_t hint = -1) const {
        const auto bound = [&](int level, std::size_t k) {
            return levels_[level][k].squared_distance(x, y);
        };
        return least(bound, squared_distance, hint);
    }

    // The item of smallest cost(item), which must not be less than its value + growth * distance to
    // its box, for the values that `minima` was made from; ties and hint as for nearest.
    template <typename Cost>
    std::int32_t nearest_weighted(double x, double y, double growth,
                                  const std::vector<std::vector<double>>& minima, Cost cost,
                                  std::int32_t hint = -1) const {
        const auto bound = [&](int level, std::size_t k) {
            const double distance = std::sqrt(levels_[level][k].squared_distance(x, y));
            return minima[level][k] + growth * distance;
        };
        return least(bound, cost, hint);
    }

    // For every box of every level, the smallest of the values of the items in it.
    std::vector<std::vector<double>> minima(const std::vector<double>& of_items) const {
        std::vector<std::vector<double>> out;
        for (const std::vector<Box>& level : levels_) {
            std::vector<double> least(level.size(), std::numeric_limits<double>::infinity());
            if (out.empty()) {
                for (std::size_t k = 0; k < least.size(); ++k) least[k] = of_items[items_[k]];
            } else {
                const std::vector<double>& below = out.back();
                for (std::size_t k = 0; k < below.size(); ++k) {
                    least[k / FANOUT] = std::min(least[k / FANOUT], below[k]);
                }
            }
            out.push_back(std::move(least));
        }
        return out;
    }

  private:
    static constexpr std::size_t FANOUT = 4;
    static constexpr int MAX_DEPTH = 64;  // 16 levels of 4 hold 2^32 items; FANOUT a level waits

    struct Node {
        int level;
        std::size_t index;
        double bound;
    };

    // The item of smallest cost(item), depth first and the most promising box first, leaving out
    // the boxes whose bound(level, index), which no cost in them is below, is too large already.
    template <typename Bound, typename Cost>
    std::int32_t least(Bound bound, Cost cost, std::int32_t hint) const {
        if (items_.empty()) return -1;
        std::int32_t best = hint >= 0 ? hint : items_.front();
        double best_cost = cost(best);
        Node stack[MAX_DEPTH];
        int depth = 0;
        stack[depth++] = {int(levels_.size()) - 1, 0, 0};
        while (depth > 0) {
            const Node node = stack[--depth];
            if (node.bound > best_cost) continue;
            if (node.level == 0) {
                const std::int32_t item = items_[node.index];
                const double found = cost(item);
                if (found < best_cost || (found == best_cost && item < best)) {
                    best = item, best_cost = found;
                }
                continue;
            }
            const int bottom = depth;
            for (std::size_t k = first_child(node); k < end_child(node); ++k) {
                const Node child{node.level - 1, k, bound(node.level - 1, k)};
                if (child.bound > best_cost) continue;
                int place = depth++;  // the most promising on top
                for (; place > bottom && stack[place - 1].bound < child.bound; --place) {
                    stack[place] = stack[place - 1];
                }
                stack[place] = child;
            }
        }
        return best;
    }

    std::size_t first_child(const Node& node) const { return FANOUT * node.index; }
    std::size_t end_child(const Node& node) const {
        return std::min(first_child(node) + FANOUT, levels_[node.level - 1].size());
    }

    std::vector<std::int32_t> items_;
    std::vector<std::vector<Box>> levels_;
};

}  // namespace metrics
