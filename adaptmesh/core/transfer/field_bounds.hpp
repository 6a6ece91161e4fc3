// Between which values an old field lies around each new node: on all old triangles that overlap a
// new triangle of the node, or, where there are none, on the nearest.
#pragma once

#include <cstddef>
#include <cstdint>

#include "adaptmesh/core/transfer/overlay.hpp"

namespace adaptmesh {

// low, high: rows of `columns` numbers for the old triangles; nodes: `per_triangle` of each new
// triangle; least, most: such rows for the new nodes, +infinity and -infinity at first.
void ranges(const Overlay& overlay, const double* low, const double* high, std::size_t columns,
            const std::int32_t* nodes, std::size_t per_triangle, double* least, double* most);

}  // namespace adaptmesh
