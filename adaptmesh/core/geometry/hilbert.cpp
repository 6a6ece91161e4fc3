#include "adaptmesh/core/geometry/hilbert.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"
#include "metrics/core/radix_sort.hpp"

namespace adaptmesh {

constexpr int HILBERT_BITS = 16;  // per coordinate; a key has twice as many

// Position along the Hilbert curve of the cell (x, y) of a grid of 2^16 x 2^16.
//
//     1---2     One level: the quadrants in the order 0 1 2 3. Quadrants 1 and 2 repeat the
//     |   |     pattern, quadrant 0 reflects it about the rising diagonal and quadrant 3 about
//     0   3     the falling one, so that each piece ends beside the start of the next.
std::uint32_t hilbert_key(std::uint32_t x, std::uint32_t y) {
    // The reflections seen so far compose to one of four states; STEP[state][quadrant of (x, y)]
    // holds the digit of the key and the next state.
    struct Step {
        std::uint8_t digit, state;
    };
    enum : std::uint8_t { plain, rising, falling, both };
    static constexpr Step STEP[4][4] = {
        {{0, rising}, {1, plain}, {3, falling}, {2, plain}},
        {{0, plain}, {3, both}, {1, rising}, {2, rising}},
        {{2, falling}, {1, falling}, {3, plain}, {0, both}},
        {{2, both}, {3, rising}, {1, both}, {0, falling}},
    };
    std::uint32_t key = 0;
    std::uint8_t state = plain;
    for (int bit = HILBERT_BITS - 1; bit >= 0; --bit) {
        const Step step = STEP[state][(x >> bit & 1) << 1 | (y >> bit & 1)];
        key = key << 2 | step.digit;
        state = step.state;
    }
    return key;
}

namespace {

void hilbert_sort(const std::vector<Point>& points, Index* first, Index* last) {
    constexpr std::ptrdiff_t CROWD = 32;  // more points than this in one cell are sorted again
    Point low = points[*first], high = low;
    for (const Index* i = first; i != last; ++i) {
        const Point p = points[*i];
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    // Halves, so that the extent of any finite points is finite.
    const double extent = std::max(high.x / 2 - low.x / 2, high.y / 2 - low.y / 2);
    if (!(extent > 0)) return;  // all in one place

    constexpr std::uint32_t CELLS = 1u << HILBERT_BITS;
    const auto cell = [&](double value, double from) {
        const double part = (value / 2 - from / 2) / extent;
        return std::min(std::uint32_t(part * CELLS), CELLS - 1);
    };
    const std::size_t count = std::size_t(last - first);
    std::vector<std::uint64_t> entries(count), scratch;
    for (std::size_t k = 0; k < count; ++k) {
        const Point p = points[first[k]];
        const std::uint64_t key = hilbert_key(cell(p.x, low.x), cell(p.y, low.y));
        entries[k] = key << 32 | std::uint32_t(first[k]);
    }
    const auto key_of = [](std::uint64_t entry) { return std::uint32_t(entry >> 32); };
    metrics::sort_by_number(entries, scratch, key_of);
    for (std::size_t k = 0; k < count; ++k) first[k] = Index(entries[k] & 0xffffffffu);

    for (std::size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && entries[end] >> 32 == entries[begin] >> 32;) ++end;
        if (std::ptrdiff_t(end - begin) > CROWD) hilbert_sort(points, first + begin, first + end);
    }
}

}  // namespace

std::vector<Index> hilbert_order(const std::vector<Point>& points) {
    std::vector<Index> order(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = Index(i);
    if (!order.empty()) hilbert_sort(points, order.data(), order.data() + order.size());
    return order;
}

}  // namespace adaptmesh
