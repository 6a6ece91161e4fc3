// Passes over what is not yet unit: collapse short edges, split long ones, search better places for
// the vertices of what remains.
#pragma once

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/monitor.hpp"

namespace adaptmesh {

// Collapses edges shorter than unit, shortest first; returns how many vertices vanished.
Index collapse_short_edges(MetricMesh& mesh, Monitor& monitor);

// Splits edges longer than unit, longest first; returns how many vertices were added.
Index split_long_edges(MetricMesh& mesh, Monitor& monitor);

// What counts as nearly unit: vertices that touch only such edges and triangles are left alone.
struct Band {
    double shortest, longest;
    double min_quality;
};

// Searches better places for the other vertices around which something has changed since the last
// call, `step` metric units away; returns how many moved.
Index search_outside(const Band& band, MetricMesh& mesh, double step, Monitor& monitor);

}  // namespace adaptmesh
