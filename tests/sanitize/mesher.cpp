// Meshes of boundaries and metrics, and meshes edited.
#include "tests/sanitize/mesher.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adaptmesh/core/debug/write_vtu.hpp"
#include "adaptmesh/core/edit/load.hpp"
#include "adaptmesh/core/edit/recut.hpp"
#include "adaptmesh/core/edit/zone.hpp"
#include "adaptmesh/core/mesher/generate.hpp"
#include "adaptmesh/core/mesher/measure_edges.hpp"
#include "adaptmesh/core/triangulation/cdt.hpp"
#include "tests/sanitize/input.hpp"

namespace sanitize {

namespace {

BoundaryCuts boundary_of(const Input& input, const MovedMetric& metric) {
    const auto sub_edges =
        triangulate(input.points, input.segments, input.options, monitor()).sub_edges;
    return unit_boundary(input.points, input.segments, sub_edges, metric);
}

MetricMesh meshed(const Input& input, Placement placement, const MovedMetric& metric) {
    const BoundaryCuts boundary = boundary_of(input, metric);
    const Samples samples{input.points, boundary.tensors};
    return generate(boundary, input.options, samples, placement, metric.field(), monitor());
}

Input with_points_of(const MetricMesh& mesh, const Input& input, const char* what) {
    Input out{input.name + what, {}, {}, {}};
    for (const Vertex& v : mesh.vertices) out.points.push_back(v.at);
    return out;
}

// A mesh as it comes from outside, with other metrics at its vertices.
MetricMesh loaded(const MetricMesh& mesh, const MovedMetric& metric) {
    std::vector<Vertex> vertices;
    for (const Vertex& v : mesh.vertices)
        vertices.push_back(Vertex::make(v.at, metric.at(v.at), v.held_by));
    std::vector<std::array<Index, 3>> corners;
    std::vector<Index> labels;
    for (const Triangle& t : mesh.topology.triangles) {
        corners.push_back({t.v[0], t.v[1], t.v[2]});
        labels.push_back(t.label);
    }
    std::vector<Segment> locked;
    for (const SubEdge& e : mesh.constrained) locked.push_back({e.a, e.b});
    return load(vertices, corners, labels, locked);
}

// A triangle that is there twice is no mesh.
bool is_refused_twice(const Input& input, const MovedMetric& metric) {
    std::vector<Vertex> vertices;
    for (Point p : input.points) vertices.push_back(Vertex::make(p, metric.at(p), FREE));
    try {
        load(vertices, {{0, 1, 2}, {0, 1, 2}}, {0, 0}, {});
    } catch (const std::invalid_argument&) {
        return true;
    }
    return false;
}

// Puts a vertex on one of the two edges beside others on the boundary, and lets those go.
void recut_lines(MetricMesh& mesh, const std::vector<SubEdge>& edges, const MovedMetric& metric) {
    std::map<Index, std::vector<std::pair<Index, Index>>> beside;  // neighbour and segment
    for (const SubEdge& e : edges) {
        beside[e.a].push_back({e.b, e.segment});
        beside[e.b].push_back({e.a, e.segment});
    }
    std::set<Index> touched;
    for (const auto& [v, two] : beside) {
        if (mesh.vertices[v].held_by < 0 || two.size() != 2) continue;
        const Index a = two[0].first, b = two[1].first;
        if (touched.count(a) || touched.count(b) || touched.count(v)) continue;
        touched.insert({a, b, v});
        const Point p = mesh.at(a), q = mesh.at(v);
        const Point cut{p.x + (q.x - p.x) / 2, p.y + (q.y - p.y) / 2};
        std::vector<Stop> stops = {{0.0, a, true}, {0.5, v, true}, {1.0, b, true}};
        const double place = 0.25;
        recut(mesh, stops, {Vertex::make(cut, metric.at(cut), two[0].second)}, &place);
    }
}

}  // namespace

// The mesh, with one metric after the other from input to input: the constrained edges are there,
// and none of them has vanished.
void run_mesher(const Input& input) {
    static std::size_t turn = 0;
    const auto& all = metrics_of_unit_square();
    triangulate(input.points, input.segments, input.options, monitor());  // or it is refused
    const MovedMetric metric(all[++turn % all.size()], input.points);
    if (!metric.is_defined()) return;
    for (Placement placement : {Placement::front, Placement::edges}) {
        const MetricMesh mesh = meshed(input, placement, metric);
        const Input result = with_points_of(mesh, input, ", meshed");
        check_mesh(mesh.topology, result);
        std::ostringstream file;
        write_vtu(mesh, file);
        require(file.str().find("nan") == std::string::npos, result, "qualities are numbers");
        std::set<std::pair<Index, Index>> locked;
        for (const Triangle& T : mesh.topology.triangles) {
            for (int slot = 0; slot < 3; ++slot) {
                if (is_locked(T.n[slot]))
                    locked.insert(std::minmax(T.v[next(slot)], T.v[prev(slot)]));
            }
        }
        for (const SubEdge& e : mesh.constrained) {
            require(locked.count(std::minmax(e.a, e.b)) == 1, result,
                    "constrained edges are locked edges");
        }
    }
}

// The mesh for one metric edited for another: its boundary discretised again, one half of it held
// and the other made again; held vertices stay where they are.
void run_edit(const Input& input) {
    static std::size_t turn = 0;
    const auto& all = metrics_of_unit_square();
    triangulate(input.points, input.segments, input.options, monitor());
    if (++turn % 5 != 0) return;  // it takes as long as all else
    const MovedMetric metric(all[turn % all.size()], input.points);
    const MovedMetric other(all[(turn + 1) % all.size()], input.points);
    if (!metric.is_defined()) return;
    const MetricMesh before = meshed(input, Placement::front, metric);
    require(is_refused_twice(input, metric), input, "a triangle is there once");

    MetricMesh mesh = loaded(before, other);
    recut_lines(mesh, before.constrained, other);
    mesh.drop_dead_triangles();
    measure_changed_edges(mesh, other.field());
    const EdgeList edges = edge_list(mesh);
    require(edges.ends.size() == 2 * edges.lengths.size(), input, "edges have two ends");
    corners_below(mesh, 0.5);

    std::vector<char> in_zone(mesh.vertices.size());
    for (std::size_t v = 0; v < in_zone.size(); ++v) in_zone[v] = v % 2;
    hold_all_but(mesh, in_zone);
    std::set<std::pair<double, double>> held;
    for (const Vertex& v : mesh.vertices) {
        const Index number = Index(&v - mesh.vertices.data());
        if (v.held_by == HELD && mesh.topology.triangle_at(number) != NONE)
            held.insert({v.at.x, v.at.y});
    }
    refill(mesh, {input.points, evaluate(other.field(), input.points)}, other.field(), monitor());
    mesh.constrained.clear();
    mesh.compact();
    const Input result = with_points_of(mesh, input, ", edited");
    check_mesh(mesh.topology, result);
    for (Point p : result.points) held.erase({p.x, p.y});
    require(held.empty(), result, "held vertices are still there");
}

}  // namespace sanitize
