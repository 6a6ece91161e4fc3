#include "adaptmesh/core/transfer/field_bounds.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "adaptmesh/core/transfer/overlay.hpp"

namespace adaptmesh {

void ranges(const Overlay& overlay, const double* low, const double* high, std::size_t columns,
            const std::int32_t* nodes, std::size_t per_triangle, double* least, double* most) {
    const auto include = [&](std::int32_t k, std::int32_t t) {
        for (std::size_t i = 0; i < per_triangle; ++i) {
            const std::size_t node = std::size_t(nodes[k * per_triangle + i]) * columns;
            const std::size_t row = std::size_t(t) * columns;
            for (std::size_t c = 0; c < columns; ++c) {
                least[node + c] = std::min(least[node + c], low[row + c]);
                most[node + c] = std::max(most[node + c], high[row + c]);
            }
        }
    };
    for (std::int32_t k = 0; k < overlay.new_mesh().triangle_count(); ++k) {
        const std::size_t begin = overlay.first()[k], end = overlay.first()[k + 1];
        for (std::size_t i = begin; i < end; ++i) include(k, overlay.olds()[i]);
        if (begin == end) include(k, overlay.place_of(k).triangle);
    }
}

}  // namespace adaptmesh
