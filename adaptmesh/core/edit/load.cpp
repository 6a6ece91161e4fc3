#include "adaptmesh/core/edit/load.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/triangulation/edge_map.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

// One side of an edge, as the triangle with this code sees it.
struct EdgeSide {
    Index low, high;
    Index code;
    bool is_upward;  // runs from the lower vertex number to the higher

    bool is_of_same_edge(const EdgeSide& s) const { return low == s.low && high == s.high; }
    bool operator<(const EdgeSide& s) const {
        return low != s.low ? low < s.low : high != s.high ? high < s.high : code < s.code;
    }
};

std::vector<EdgeSide> sides_of(const Triangulation& topology) {
    std::vector<EdgeSide> sides;
    sides.reserve(3 * topology.triangles.size());
    for (Index t = 0; t < topology.triangle_count(); ++t) {
        const Triangle& T = topology.triangles[t];
        for (int slot = 0; slot < 3; ++slot) {
            const Index a = T.v[next(slot)], b = T.v[prev(slot)];
            sides.push_back({std::min(a, b), std::max(a, b), edge_code(t, slot), a < b});
        }
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

MetricMesh load(std::vector<Vertex> vertices, const std::vector<std::array<Index, 3>>& triangles,
                const std::vector<Index>& labels, const std::vector<Segment>& locked) {
    const Index n_vertices = Index(vertices.size());
    MetricMesh mesh;
    mesh.vertices = std::move(vertices);
    Triangulation& topology = mesh.topology;
    topology.reserve(n_vertices);
    for (Index v = 0; v < n_vertices; ++v) topology.add_vertex();
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto& v = triangles[t];
        const Index k = topology.add_triangle(v[0], v[1], v[2]);
        topology.triangles[k].label = labels[t];
    }
    const std::vector<EdgeSide> sides = sides_of(topology);
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        const EdgeSide &s = sides[i], &t = sides[i + 1];
        if (!s.is_of_same_edge(t)) continue;
        if (s.is_upward == t.is_upward || (i > 0 && sides[i - 1].is_of_same_edge(s))) {
            throw std::invalid_argument("triangles " + std::to_string(triangle_of(s.code)) +
                                        " and " + std::to_string(triangle_of(t.code)) +
                                        " overlap at their common edge");
        }
        topology.link(triangle_of(s.code), slot_of(s.code), t.code);
    }
    const EdgeNumbers lookup(locked);
    std::vector<char> is_end(n_vertices, false);
    for (const Segment& e : locked) is_end[e.a] = is_end[e.b] = true;
    for (const EdgeSide& s : sides) {
        if (is_end[s.low] && is_end[s.high] && lookup.find(s.low, s.high) != NONE)
            topology.lock({triangle_of(s.code), slot_of(s.code)});
    }
    mesh.take_fans_apart();
    return mesh;
}

}  // namespace adaptmesh
