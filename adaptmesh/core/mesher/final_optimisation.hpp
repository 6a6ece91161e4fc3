// The last stage: what is still off is changed only if the change, measured, is for the better.
//
// A site is a star of the mesh with an edge that is not unit, or a bad triangle. In each round
//
//   1. the sites are measured with the exact metric                                    (sites.hpp)
//   2. stars that might take their place are thought of, and measured as well      (proposals.hpp)
//   3. those that gain most are put in, as long as their sites do not overlap     (acceptance.hpp)
//
// So a change is judged by the very numbers that it makes.
#pragma once

#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/mesher/star.hpp"
#include "adaptmesh/core/monitor.hpp"

namespace adaptmesh {

// Both aims, one after the other.
void final_optimisation(MetricMesh& mesh, const MetricField& metric, Monitor& monitor);

// First, edges are to be unit, and triangles not bad. Returns whether that was tried: not where the
// metric is beyond what straight edges can follow.
bool make_unit(MetricMesh& mesh, Measures& measures, const MetricField& metric, Monitor& monitor);

// Then the worst triangles are to be as good as they can be.
void lift_worst(MetricMesh& mesh, Measures& measures, const MetricField& metric, Monitor& monitor);

}  // namespace adaptmesh
