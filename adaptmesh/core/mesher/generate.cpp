#include "adaptmesh/core/mesher/generate.hpp"

#include <utility>

#include "adaptmesh/core/edit/zone.hpp"
#include "adaptmesh/core/mesher/cut_boundary.hpp"
#include "adaptmesh/core/mesher/final_optimisation.hpp"
#include "adaptmesh/core/mesher/optimise.hpp"
#include "adaptmesh/core/mesher/swap.hpp"
#include "adaptmesh/core/placements/along_edges.hpp"
#include "adaptmesh/core/placements/front.hpp"
#include "adaptmesh/core/triangulation/cdt.hpp"
#include "adaptmesh/core/triangulation/outside.hpp"

namespace adaptmesh {

namespace {

// The points of the domain are triangulated for the Euclidean plane; under a slanted and strongly
// anisotropic metric it can take many passes of swaps until that is metric Delaunay. Most need two.
constexpr int BOUNDARY_SWAPS = 200;

constexpr int REFILL_SWAPS = 5;

// The constrained Delaunay triangulation of a boundary's points, with the metric at each, and what
// lies around it.
std::pair<MetricMesh, Outside> triangulated(const BoundaryCuts& boundary, const CarveOptions& carve,
                                            Monitor& monitor) {
    MetricMesh mesh;
    Triangulation outside;
    try {
        mesh.topology =
            triangulate(boundary.points, boundary.segments, carve, monitor, &outside).triangulation;
    } catch (const InputError& fault) {
        throw boundary.in_the_domain(fault);
    }
    for (std::size_t i = 0; i < boundary.points.size(); ++i)
        mesh.vertices.push_back(Vertex::make(boundary.points[i], boundary.tensors[i], FIXED));
    mesh.take_fans_apart();
    return {std::move(mesh), Outside(std::move(outside), boundary.points)};
}

// The triangulation of a boundary with its cuts, metric Delaunay. A cut of a curve is off the chord
// that it divides, and can be hidden from it by triangles that lie between; any cut can be rounded
// onto or beyond what comes very near. BoundaryCuts::mend says what is tried then.
MetricMesh cut_and_triangulated(BoundaryCuts boundary, const CarveOptions& carve,
                                Monitor& monitor) {
    monitor.report("triangulating", Monitor::TRIANGULATING);
    while (true) {
        auto [mesh, outside] = triangulated(boundary, carve, monitor);
        swap_to_delaunay(mesh, BOUNDARY_SWAPS, monitor);
        const std::vector<char> is_made = cut_boundary(mesh, outside, boundary, monitor);
        if (!boundary.mend(is_made)) return std::move(mesh);
    }
}

}  // namespace

MetricMesh generate(BoundaryCuts boundary, const CarveOptions& carve, const Samples& samples,
                    Placement placement, const MetricField& metric, Monitor& monitor) {
    MetricMesh mesh = cut_and_triangulated(std::move(boundary), carve, monitor);
    fill(mesh, samples, placement, metric, monitor);
    mesh.compact();
    return mesh;
}

void fill(MetricMesh& mesh, const Samples& samples, Placement placement, const MetricField& metric,
          Monitor& monitor) {
    if (placement == Placement::front) place_ahead_of_front(mesh, metric, monitor);
    place_along_edges(mesh, metric, monitor);
    if (insert_missed_samples(mesh, samples, monitor) > 0) place_along_edges(mesh, metric, monitor);
    optimise(mesh, metric, monitor);
    final_optimisation(mesh, metric, monitor);
}

void refill(MetricMesh& mesh, const Samples& samples, const MetricField& metric, Monitor& monitor) {
    remove_free(mesh, monitor);
    swap_to_delaunay(mesh, REFILL_SWAPS, monitor);
    fill(mesh, samples, Placement::front, metric, monitor);
}

}  // namespace adaptmesh
