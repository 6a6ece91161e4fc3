#include "adaptmesh/core/placements/missed_samples.hpp"

#include <algorithm>

#include "adaptmesh/core/geometry/hilbert.hpp"
#include "adaptmesh/core/mesher/point_inserter.hpp"
#include "adaptmesh/core/placements/along_edges.hpp"
#include "adaptmesh/core/triangulation/locate.hpp"

namespace adaptmesh {

namespace {

// A sample with this many times the density sqrt(det M) of all corners of its triangle was missed.
constexpr double FAR_FINER = 2.0;

}  // namespace

Index insert_missed_samples(MetricMesh& mesh, const Samples& samples, Monitor& monitor) {
    PointInserter inserter(mesh, ALONG_EDGES_SPACING);
    Index inserted = 0, tried = 0, near = 0;
    for (Index i : hilbert_order(samples.points)) {
        monitor.poll(++tried);
        const Vertex p = Vertex::make(samples.points[i], samples.tensors[i]);
        near = locate(mesh.topology, [&](Index v) { return mesh.at(v); }, p.at, near).triangle;
        double known = 0;
        for (Index v : mesh.triangle(near).v) known = std::max(known, mesh.vertices[v].sqrt_det);
        if (p.sqrt_det < FAR_FINER * known) continue;
        inserted += inserter.insert(p.at, p.metric, near) == PointInserter::Outcome::inserted;
    }
    return inserted;
}

}  // namespace adaptmesh
