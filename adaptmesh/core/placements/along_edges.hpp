// Field points along edges (Borouchaki and George): every edge longer than unit is cut at equal
// metric shares, and the points that keep their distance from the mesh are put into it.
#pragma once

#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/monitor.hpp"

namespace adaptmesh {

// A field point nearer than this to a vertex is refused, in metric length.
constexpr double ALONG_EDGES_SPACING = 0.75;

// Cuts long edges, sweep after sweep, until none is left that takes a point. The points of a sweep
// are put in with the metric interpolated along their edge; then the metric is evaluated exactly at
// all of them at once.
void place_along_edges(MetricMesh& mesh, const MetricField& metric, Monitor& monitor);

}  // namespace adaptmesh
