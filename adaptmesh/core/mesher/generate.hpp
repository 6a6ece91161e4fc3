// From a boundary and a metric to a mesh: all stages in their order.
#pragma once

#include "adaptmesh/core/mesher/boundary_cuts.hpp"
#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/placements/missed_samples.hpp"
#include "adaptmesh/core/triangulation/carve.hpp"

namespace adaptmesh {

// How points are placed: ahead of a front and then along edges, or only along edges.
enum class Placement { front, edges };

// Throws InputError where lines of the domain cannot be told apart, TooManyVertices where the mesh
// would be larger than the monitor allows, and what the metric and the monitor throw.
MetricMesh generate(BoundaryCuts boundary, const CarveOptions& carve, const Samples& samples,
                    Placement placement, const MetricField& metric, Monitor& monitor);

// Fills a mesh that is too coarse with points, and optimises it; what is held stays where it is.
void fill(MetricMesh& mesh, const Samples& samples, Placement placement, const MetricField& metric,
          Monitor& monitor);

// Removes the free vertices of a mesh, and fills it again.
void refill(MetricMesh& mesh, const Samples& samples, const MetricField& metric, Monitor& monitor);

}  // namespace adaptmesh
