#include "adaptmesh/core/mesher/sites.hpp"

#include <algorithm>
#include <utility>

#include "adaptmesh/core/mesher/swap.hpp"

namespace adaptmesh {

namespace {

Site quad_site(const MetricMesh& mesh, Place edge) {
    const Quad q = quad_around(mesh.topology, edge);
    const Index across = mesh.triangle(edge.triangle).n[edge.slot];
    const Place far{triangle_of(across), slot_of(across)};
    return {{edge, far}, {q.b, q.d, q.c, q.a}, {mesh.vertices[q.b], q.b, Site::KEPT}, {}};
}

// Without a polygon if the vertex must not move.
Site ball_site(const MetricMesh& mesh, Index v) {
    Site site{{}, {}, {mesh.vertices[v], v, Star::INSIDE}, {}};
    if (mesh.vertices[v].held_by != FREE || mesh.topology.triangle_at(v) == NONE ||
        !mesh.topology.ball(v, site.places))
        return site;
    for (Place p : site.places) site.polygon.push_back(mesh.triangle(p.triangle).v[next(p.slot)]);
    return site;
}

}  // namespace

std::vector<Site> sites_at(const WorstPlaces& places, const MetricMesh& mesh) {
    std::vector<Site> sites;
    for (Index code : places.edges)
        sites.push_back(quad_site(mesh, {triangle_of(code), slot_of(code)}));
    for (Index v = 0; v < Index(places.is_centre.size()); ++v) {
        if (!places.is_centre[v]) continue;
        Site site = ball_site(mesh, v);
        if (!site.polygon.empty()) sites.push_back(std::move(site));
    }
    return sites;
}

void measure_sites(const std::vector<Site>& sites, const MetricMesh& mesh, Measures& measures,
                   const MetricField& metric) {
    std::vector<std::pair<Index, Index>> edges;
    const auto add = [&](Index a, Index b) {
        if (!measures.knows(a, b)) edges.push_back(std::minmax(a, b));
    };
    for (const Site& site : sites) {
        const StarView view(site.polygon, site.now);
        for (int i = view.first_spoke(); i < view.end_of_spokes(); ++i)
            add(site.now.vertex, view.rim(i));
        for (std::size_t i = 0; i < site.polygon.size(); ++i)
            add(site.polygon[i], site.polygon[(i + 1) % site.polygon.size()]);
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    EdgeSampler sampler = final_sampler();
    for (auto [a, b] : edges) {
        const Vertex &p = mesh.vertices[a], &q = mesh.vertices[b];
        sampler.add(p.at, p.metric, q.at, q.metric);
    }
    sampler.measure(metric);
    for (std::size_t i = 0; i < edges.size(); ++i)
        measures.set(edges[i].first, edges[i].second, Measured::of(sampler, Index(i)));
}

StarMeasure measured_now(const Site& site, const MetricMesh& mesh, const Measures& measures) {
    const StarView view(site.polygon, site.now);
    return measure(mesh, measures, view, site.now.kernel.at,
                   [&](int i) { return measures.of(site.now.vertex, view.rim(i)); });
}

EdgeSampler final_sampler() {
    constexpr double LONGEST_CHORD = 0.6, LONGEST_EDGE = 4;
    return {LONGEST_CHORD, LONGEST_EDGE, 0.0};
}

}  // namespace adaptmesh
