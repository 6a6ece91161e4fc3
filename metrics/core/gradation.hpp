// Limits how fast a metric known at vertices changes along the edges between them.
//
// A law says what a vertex p allows at its neighbour q. Where q allows more, q is made finer, never
// p coarser. The vertex of the smallest ellipse speaks first, as in Dijkstra's algorithm: for sizes
// without direction every vertex then has its final value when its turn comes. Tensors may take
// several turns, because the intersection of two may be finer, in between, than either; in the
// order of area it is between one and two, in the order of the smallest size it was over ten.
//
//           p speaks            q has changed, is queued, and speaks in its turn
//     p o------------> o q ------------> o ...
//
// Ellipses of one area are common, as where sizes are cut off at limits, and then it matters which
// goes first. Rounding, which differs from frame to frame, must not decide: areas that agree to
// rounding count as equal, and of those the vertex whose edges are shortest is first.
//
// A vertex changes only by more than the tolerance, and each step away from where a size comes from
// allows more, so that it ends; and what has ended is left as it is when done again.
#pragma once

#include "metrics/core/adjacency.hpp"
#include "metrics/core/tensor.hpp"

namespace metrics {

enum class GradationLaw { h_correction, metric, mixed };

struct Gradation {
    GradationLaw law;
    double log_beta;   // of the bound on growth, above 0
    double tolerance;  // relative, on sizes
};

// tensors: packed, one for each of the points; changed in place.
void grade(const double* points, Tensor* tensors, const Adjacency& mesh, const Gradation& rule);

}  // namespace metrics
