// Points ahead of a front: unit triangles are built on the edges that bound what is done, layer
// after layer, from the constraints inwards.
//
// The front is a list of directed edges; each has a finished triangle (or a constraint) on its
// right and looks to its left:
//
//          c                P
//         / \              / \         if the triangle (a, b, c) ahead has short sides, it is
//        /   \    or      /   \        accepted, and (c, b), (a, c) join the front; else the
//       a --- b          a --- b       point P that makes a unit triangle is put in
//
// Like the sampler, the front asks in rounds: the place of P depends on the metric at P. It is
// guessed with the metric expected there, the metric is evaluated, for a whole layer at once, and
// the place is computed again; if that is next to the one before, P stays where the metric is
// known, and else it moves and is asked about again.
#pragma once

#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/monitor.hpp"

namespace adaptmesh {

// Builds unit triangles layer by layer, until the front has met itself everywhere.
void place_ahead_of_front(MetricMesh& mesh, const MetricField& metric, Monitor& monitor);

}  // namespace adaptmesh
