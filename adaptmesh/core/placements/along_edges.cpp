#include "adaptmesh/core/placements/along_edges.hpp"

#include <algorithm>
#include <vector>

#include "adaptmesh/core/mesher/measure_edges.hpp"
#include "adaptmesh/core/mesher/point_inserter.hpp"

namespace adaptmesh {

namespace {

// The metric length from which an edge is cut.
constexpr double LONG_EDGE = 1.45;

// Longer ones are cut into about so many parts, and what is left of them in the next sweep.
constexpr double LONGEST_EDGE = 16;

MeasuredEdges measured_to_be_cut(MetricMesh& mesh, const MetricField& metric) {
    MeasuredEdges edges{EdgeSampler(LONGEST_CHORD, LONGEST_EDGE, LONG_EDGE), {}, {}};
    const auto& triangles = mesh.topology.triangles;
    const auto changed = std::count_if(triangles.begin(), triangles.end(),
                                       [](const Triangle& t) { return t.pending & TO_MEASURE; });
    edges.reserve(3 * std::size_t(changed) / 2);
    for_each_changed_edge(mesh, [&](Index a, Index b) { edges.add(mesh, a, b); });
    edges.sampler.measure(metric);
    note_lengths(mesh, edges);
    return edges;
}

// Returns how many points the mesh took. An edge that the points of others have made vanish is
// passed over: what took its place is measured in the next sweep.
Index insert_along(const MeasuredEdges& edges, MetricMesh& mesh, Monitor& monitor) {
    PointInserter inserter(mesh, ALONG_EDGES_SPACING);
    std::vector<FieldPoint> points;
    Index inserted = 0;
    for (Index e = 0; e < edges.sampler.edge_count(); ++e) {
        monitor.poll(e);
        const double length = edges.sampler.lengths()[e];
        if (length < LONG_EDGE) continue;
        const Place place = mesh.topology.find_edge(edges.a[e], edges.b[e]);
        if (place.triangle == NONE) continue;
        monitor.check_vertex_count(mesh.topology.living_vertex_count() + 1);
        points.clear();
        edges.sampler.cut(e, Index(unit_parts(std::min(length, LONGEST_EDGE))), points);
        Index near = place.triangle;
        for (const FieldPoint& p : points) {
            if (inserter.insert(p.at, p.metric, near) != PointInserter::Outcome::inserted) continue;
            mesh.interpolated.push_back(Index(mesh.vertices.size()) - 1);
            ++inserted;
        }
    }
    return inserted;
}

}  // namespace

void place_along_edges(MetricMesh& mesh, const MetricField& metric, Monitor& monitor) {
    Index inserted = 0;
    do {
        monitor.report_placed("placing points along edges", mesh.topology.living_vertex_count());
        inserted = insert_along(measured_to_be_cut(mesh, metric), mesh, monitor);
        monitor.check_vertex_count(mesh.topology.living_vertex_count());
        evaluate_interpolated(mesh, metric);
    } while (inserted > 0);
}

}  // namespace adaptmesh
