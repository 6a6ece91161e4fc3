// Outlines: where their segments meet, and points left out.
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/outline/decimate.hpp"
#include "adaptmesh/core/outline/encounters.hpp"
#include "tests/sanitize/input.hpp"
#include "tests/sanitize/mesher.hpp"

namespace sanitize {

namespace {

bool cross(const Input& input, Segment s, Segment t) {
    if (s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b) return false;
    const auto side = [&](Segment line, Index v) {
        return orient2d(input.points[line.a], input.points[line.b], input.points[v]);
    };
    return side(s, t.a) * side(s, t.b) < 0 && side(t, s.a) * side(t, s.b) < 0;
}

}  // namespace

// Every pair that crosses is found, and no other.
void run_encounters(const Input& input) {
    if (!has_extent(input.points)) return;
    const auto all = std::vector<char>(input.segments.size(), true);
    const std::vector<std::uint8_t> unseen(all.begin(), all.end());
    const auto* is_unseen = reinterpret_cast<const bool*>(unseen.data());
    const Encounters found = find_encounters(input.points, input.segments, 0.0, is_unseen,
                                             input.segments.size() * 100, monitor());
    std::set<IndexPair> expected;
    for (Index i = 0; i < Index(input.segments.size()); ++i) {
        for (Index j = i + 1; j < Index(input.segments.size()); ++j) {
            if (cross(input, input.segments[i], input.segments[j])) expected.insert({i, j});
        }
    }
    require(std::set<IndexPair>(found.crossings.begin(), found.crossings.end()) == expected, input,
            "the crossings are those of all pairs");
    for (auto [segment, v] : found.near) {
        const Segment s = input.segments[segment];
        require(s.a != v && s.b != v, input, "a point divides a segment between its ends");
    }
}

// Each point is still an end, or is passed by once, or was the end of nothing.
void run_decimate(const Input& input) {
    if (!has_extent(input.points)) return;
    const Metric coarse = [](Point) { return metrics::from_size(0.5); };
    const MovedMetric metric(coarse, input.points);
    if (!metric.is_defined()) return;
    std::vector<ChainEdge> edges;
    std::set<Index> ends;
    for (Segment s : input.segments) {
        if (s.a == s.b) return;
        edges.push_back({s.a, s.b, 0});
        ends.insert({s.a, s.b});
    }
    const Decimated left =
        decimate(input.points, evaluate(metric.field(), input.points), edges, 0.1, monitor());
    require(left.starts.size() == left.edges.size() + 1 &&
                left.starts.back() == std::int64_t(left.passed.size()),
            input, "each edge says which points it passes by");
    for (auto [a, b] : left.edges) ends.erase(a), ends.erase(b);
    for (Index v : left.passed) {
        require(ends.erase(v) == 1, input, "a point is passed by once, or is an end");
    }
    require(ends.empty(), input, "no point vanishes");
}

}  // namespace sanitize
