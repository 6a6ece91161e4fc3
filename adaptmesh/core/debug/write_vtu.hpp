// A mesh at work as a .vtu file, to be looked at in ParaView or by adaptmesh.read: from a debugger,
//
//   (gdb) call adaptmesh::write_vtu(mesh, "/tmp/mesh.vtu")
#pragma once

#include <iosfwd>

#include "adaptmesh/core/mesher/metric_mesh.hpp"

namespace adaptmesh {

// Living triangles, with their label, quality and pending marks; vertices with their number, metric
// and what holds them.
void write_vtu(const MetricMesh& mesh, std::ostream& out);
void write_vtu(const MetricMesh& mesh, const char* path);

}  // namespace adaptmesh
