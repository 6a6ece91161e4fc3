// Grids within grids that know, for every point, an item near it: where a walk may start.
//
//     +------+------+------+
//     |      |      |   |__|     One item in each cell is enough, for a seed need not be right. A
//     |      |      |___|__|     cell with many items has a grid of its own, on the box of their
//     +------+------+___|==|     places: where items are small, and in one direction only if they
//     |      |      |___|==|     are thin in one, seeds are as dense as they are.
//     +------+------+------+
//
// Cells that got none take over what the cell before them in their row has, or the row before.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "metrics/core/boxtree.hpp"

namespace metrics {

class SeedGrid {
  public:
    SeedGrid() = default;

    // Items are where the centres of their boxes are.
    explicit SeedGrid(const std::vector<Box>& boxes) {
        std::vector<std::int32_t> all(boxes.size());
        std::iota(all.begin(), all.end(), 0);
        add_grid(boxes, all.data(), all.data() + all.size());
    }

    std::int32_t near(double x, double y) const {
        std::int32_t content = ~0;
        while (content < 0) {
            const Grid& grid = grids_[~content];
            content = cells_[grid.first + grid.cell(x, y)];
        }
        return content;
    }

  private:
    static constexpr double ITEMS_PER_CELL = 2;
    static constexpr std::size_t MANY = 8;  // items, for which a cell gets a grid

    struct Grid {
        std::size_t first;  // of its cells
        double x0, y0, scale_x, scale_y;
        int columns, rows;

        std::size_t cell(double x, double y) const {
            const int column = clamped((x - x0) * scale_x, columns);
            const int row = clamped((y - y0) * scale_y, rows);
            return std::size_t(row) * columns + column;
        }

        // NaN and points outside of the box belong to cells at its border.
        static int clamped(double position, int count) {
            return position >= 1 ? (position < count ? int(position) : count - 1) : 0;
        }
    };

    static double centre_x(const Box& box) { return 0.5 * (box.x0 + box.x1); }
    static double centre_y(const Box& box) { return 0.5 * (box.y0 + box.y1); }

    // Adds a grid with these items, which are put in the order of its cells.
    void add_grid(const std::vector<Box>& boxes, std::int32_t* begin, std::int32_t* end) {
        const Grid grid = grid_for(boxes, begin, end);
        const std::size_t count = std::size_t(grid.columns) * grid.rows;
        grids_.push_back(grid);
        cells_.resize(grid.first + count, NOTHING);

        std::vector<std::size_t> start(count + 1, 0);
        std::vector<std::int32_t> cell_of, items(begin, end);
        cell_of.reserve(items.size());
        for (const std::int32_t item : items) {
            const Box& box = boxes[item];
            cell_of.push_back(std::int32_t(grid.cell(centre_x(box), centre_y(box))));
            ++start[cell_of.back() + 1];
        }
        std::partial_sum(start.begin(), start.end(), start.begin());
        std::vector<std::size_t> next(start.begin(), start.end() - 1);
        for (std::size_t i = 0; i < items.size(); ++i) begin[next[cell_of[i]]++] = items[i];

        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t held = start[k + 1] - start[k];
            if (held == 0) continue;
            std::int32_t* const first = begin + start[k];
            // Items at the same place stay together in whatever grid.
            if (held <= MANY || held == items.size()) {
                cells_[grid.first + k] = first[held / 2];
            } else {
                cells_[grid.first + k] = ~std::int32_t(grids_.size());
                add_grid(boxes, first, first + held);
            }
        }
        const auto cells = cells_.begin() + std::ptrdiff_t(grid.first);
        spread(cells, cells + std::ptrdiff_t(count));
        spread(std::make_reverse_iterator(cells + std::ptrdiff_t(count)),
               std::make_reverse_iterator(cells));
    }

    // With ITEMS_PER_CELL, in cells of the shape of the mean item.
    Grid grid_for(const std::vector<Box>& boxes, const std::int32_t* begin,
                  const std::int32_t* end) const {
        Box all;
        double item_width = 0, item_height = 0;
        for (const std::int32_t* item = begin; item != end; ++item) {
            const Box& box = boxes[*item];
            all.include(centre_x(box), centre_y(box));
            item_width += box.x1 - box.x0, item_height += box.y1 - box.y0;
        }
        const double width = all.x1 - all.x0, height = all.y1 - all.y0;
        const double cells = std::max(1.0, double(end - begin) / ITEMS_PER_CELL);
        const double ratio = (width * item_height) / (height * item_width);
        const int columns = whole(std::sqrt(cells * ratio), cells);
        const int rows = whole(std::sqrt(cells / ratio), cells);
        return {cells_.size(), all.x0, all.y0, columns / width, rows / height, columns, rows};
    }

    static int whole(double side, double most) {
        return side >= 1 ? int(std::floor(std::min(side, most))) : 1;
    }

    template <typename Iterator>
    static void spread(Iterator begin, Iterator end) {
        std::int32_t last = NOTHING;
        for (Iterator cell = begin; cell != end; ++cell) {
            if (*cell != NOTHING) last = *cell;
            *cell = last;
        }
    }

    static constexpr std::int32_t NOTHING = INT32_MIN;

    std::vector<Grid> grids_;
    std::vector<std::int32_t> cells_;  // an item, or ~k where grid k is
};

}  // namespace metrics
