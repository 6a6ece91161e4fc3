#include "adaptmesh/core/mesher/final_optimisation.hpp"

#include <cstddef>
#include <vector>

#include "adaptmesh/core/mesher/acceptance.hpp"
#include "adaptmesh/core/mesher/measure_edges.hpp"
#include "adaptmesh/core/mesher/proposals.hpp"
#include "adaptmesh/core/mesher/sites.hpp"
#include "adaptmesh/core/mesher/worst_places.hpp"

namespace adaptmesh {

namespace {

// Rounds of the first aim, and how far they try to move vertices.
constexpr double STEPS[] = {0.3, 0.15, 0.3, 0.15, 0.3, 0.15};
constexpr double MIN_QUALITY = 0.6;  // triangles of lesser quality are worked on

// With more places to work on than the one plus this share of the vertices nothing is done: then
// the metric is beyond what straight edges can follow, and they are no exceptions.
constexpr double MAX_SITES = 1000, MAX_SITES_SHARE = 0.125;

// Rounds of the second aim, for triangles of lesser quality, so many at a time.
constexpr int LIFTS = 6;
constexpr double LIFT_BELOW = 0.8;
constexpr double MAX_LIFTED = 20, MAX_LIFTED_SHARE = 0.004;

void mark_all_to_improve(MetricMesh& mesh) {
    for (Triangle& t : mesh.topology.triangles) t.pending |= TO_IMPROVE;
}

// Returns how many of the sites were changed.
Index improve(std::vector<Site>& sites, const Aim& aim, MetricMesh& mesh, Measures& measures,
              const MetricField& metric, Monitor& monitor) {
    measure_sites(sites, mesh, measures, metric);
    propose(sites, mesh, measures, aim, metric, monitor);
    const EdgeSampler proposed = measured_proposals(sites, mesh, metric);
    return accept_best(sites, proposed, aim, mesh, measures);
}

}  // namespace

void final_optimisation(MetricMesh& mesh, const MetricField& metric, Monitor& monitor) {
    monitor.report("final optimisation", Monitor::FINAL);
    Measures measures;
    if (make_unit(mesh, measures, metric, monitor)) lift_worst(mesh, measures, metric, monitor);
}

bool make_unit(MetricMesh& mesh, Measures& measures, const MetricField& metric, Monitor& monitor) {
    measure_changed_edges(mesh, metric);
    mark_all_to_improve(mesh);
    for (double step : STEPS) {
        std::vector<Site> sites = sites_at(take_changed_off_unit(mesh, MIN_QUALITY), mesh);
        const double max_sites = MAX_SITES + MAX_SITES_SHARE * mesh.topology.living_vertex_count();
        if (double(sites.size()) > max_sites) return false;
        const Aim aim{Aim::Goal::least_cost, MIN_QUALITY, step};
        if (sites.empty() || improve(sites, aim, mesh, measures, metric, monitor) == 0) break;
        monitor.check_vertex_count(mesh.topology.living_vertex_count());
    }
    return true;
}

void lift_worst(MetricMesh& mesh, Measures& measures, const MetricField& metric, Monitor& monitor) {
    mark_all_to_improve(mesh);
    for (int lift = 0; lift < LIFTS; ++lift) {
        const double n = mesh.topology.living_vertex_count();
        const auto most = std::size_t(MAX_LIFTED + MAX_LIFTED_SHARE * n);
        std::vector<Site> sites = sites_at(take_changed_worst(mesh, LIFT_BELOW, most), mesh);
        const Aim aim{Aim::Goal::best_worst, LIFT_BELOW, 0.0};
        if (sites.empty() || improve(sites, aim, mesh, measures, metric, monitor) == 0) return;
    }
}

}  // namespace adaptmesh
