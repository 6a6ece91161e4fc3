#include "adaptmesh/core/mesher/optimise.hpp"

#include <iterator>

#include "adaptmesh/core/mesher/measure_edges.hpp"
#include "adaptmesh/core/mesher/passes.hpp"
#include "adaptmesh/core/mesher/smooth.hpp"
#include "adaptmesh/core/mesher/swap.hpp"

namespace adaptmesh {

namespace {

constexpr int SMOOTHINGS = 2;
constexpr int SWAP_PASSES = 5;

// What the rounds after these leave alone: first where edges are nearly unit, then where hardly.
constexpr Band WIDE{0.8, 1.25, 0.6}, NARROW{0.74, 1.36, 0.5};
constexpr Band ROUNDS[] = {WIDE, WIDE, NARROW, NARROW, NARROW, NARROW};

constexpr double SEARCH_STEP = 0.12;  // the first of the search, in metric length
constexpr double SWAP_BELOW = 0.5;    // at last, triangles of lesser quality are swapped for shape

void report(const char* stage, int step, Monitor& monitor) {
    constexpr int STEPS = SMOOTHINGS + int(std::size(ROUNDS));
    const double begin = Monitor::OPTIMISING;
    monitor.report(stage, begin + (Monitor::FINAL - begin) * step / STEPS);
}

}  // namespace

void optimise(MetricMesh& mesh, const MetricField& metric, Monitor& monitor) {
    const auto swap = [&] { swap_to_delaunay(mesh, SWAP_PASSES, monitor); };
    int step = 0;
    swap();
    for (int k = 0; k < SMOOTHINGS; ++k) {
        report("smoothing", step++, monitor);
        smooth_changed(mesh, monitor);
        evaluate_interpolated(mesh, metric);
        swap();
    }
    for (const Band& band : ROUNDS) {
        report("improving", step++, monitor);
        measure_changed_edges(mesh, metric);
        Index changes = collapse_short_edges(mesh, monitor);
        changes += split_long_edges(mesh, monitor);
        monitor.check_vertex_count(mesh.topology.living_vertex_count());
        evaluate_interpolated(mesh, metric);
        swap();
        changes += search_outside(band, mesh, SEARCH_STEP, monitor);
        if (changes == 0) break;
        evaluate_interpolated(mesh, metric);
        swap();
    }
    swap_for_quality(mesh, SWAP_BELOW, monitor);
}

}  // namespace adaptmesh
