// A filled mesh made better: smoothed and swapped everywhere, then worked on where it is not unit.
#pragma once

#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/monitor.hpp"

namespace adaptmesh {

void optimise(MetricMesh& mesh, const MetricField& metric, Monitor& monitor);

}  // namespace adaptmesh
