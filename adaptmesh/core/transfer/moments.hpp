// Moments of an old field: its integrals against each basis function of the new mesh.
//
//     b_i = sum over new triangles K, old triangles T of   integral over K and T of  phi_i u
//
// On the common part of K and T both are polynomials; a rule that is exact for their product gives
// the exact moments. Where the old mesh doesn't cover K (chords of a curved boundary differ), the
// old field is extended by a polynomial p of its degree:
//
//     at least half of K is covered    p is the L2 projection of u on the covered part
//     less, and K is near              p is u on the old triangle nearest to the centroid of K
//     else                             p interpolates u at the points nearest to the nodes of K
//
// Polynomials are extended by themselves in the first two cases. A polynomial that is small on half
// of a triangle can't be large on all of it; and "near" is what keeps the second from being large.
#pragma once

#include <cstddef>
#include <cstdint>

#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/transfer/overlay.hpp"

namespace adaptmesh {

// Rows of `columns` numbers for the old triangles: the bounds of a field on each; null if there are
// none to keep.
struct BoundsOnTriangles {
    const double *low, *high;
};

// A field on the old mesh: rows of `columns` numbers at its nodes, and the nodes of each triangle.
struct OldField {
    const double* values;
    std::size_t columns;
    const std::int32_t* nodes;
    BoundsOnTriangles bounds;
};

// Adds the moments on all new triangles to `out`, rows for the new nodes, of which each triangle
// has one, three or six, as each old one has.
//
// reach: polynomials are extended to new triangles outside by at most this share of an edge.
void add_moments(const Overlay& overlay, const OldField& field, double reach,
                 const std::int32_t* new_nodes, std::size_t nodes_per_triangle, double* out,
                 Monitor& monitor);

}  // namespace adaptmesh
