// A uniform grid that knows, for every point, an item near it: where a walk may start.
//
// One item in each cell is enough, for a seed need not be right. Cells that got none take over that
// of the cell before them in their row, or of the row before.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "metrics/core/boxtree.hpp"

namespace metrics {

class SeedGrid {
  public:
    SeedGrid() = default;

    // A grid for `count` items over a box, with about ITEMS_PER_CELL of them in a cell.
    SeedGrid(const Box& box, std::size_t count) : box_(box) {
        const double width = box.x1 - box.x0, height = box.y1 - box.y0;
        const double cells = std::max(1.0, double(count) / ITEMS_PER_CELL);
        columns_ = whole(std::sqrt(cells * (width / height)), cells);
        rows_ = whole(std::sqrt(cells * (height / width)), cells);
        scale_x_ = columns_ / width, scale_y_ = rows_ / height;
        seeds_.assign(std::size_t(columns_) * rows_, -1);
    }

    void put(double x, double y, std::int32_t item) { seeds_[cell(x, y)] = item; }

    void fill_gaps() {
        spread(seeds_.begin(), seeds_.end());
        spread(seeds_.rbegin(), seeds_.rend());
    }

    std::int32_t near(double x, double y) const { return seeds_[cell(x, y)]; }

  private:
    static constexpr double ITEMS_PER_CELL = 2;

    static int whole(double side, double most) {
        return int(std::min(std::max(std::floor(side), 1.0), most));
    }

    // NaN and points outside of the box belong to cells at its border.
    static int clamped(double position, int count) {
        return position >= 1 ? (position < count ? int(position) : count - 1) : 0;
    }

    std::size_t cell(double x, double y) const {
        const int column = clamped((x - box_.x0) * scale_x_, columns_);
        const int row = clamped((y - box_.y0) * scale_y_, rows_);
        return std::size_t(row) * columns_ + column;
    }

    template <typename Iterator>
    static void spread(Iterator begin, Iterator end) {
        std::int32_t last = -1;
        for (Iterator seed = begin; seed != end; ++seed) {
            if (*seed >= 0) last = *seed;
            *seed = last;
        }
    }

    Box box_;
    int columns_ = 1, rows_ = 1;
    double scale_x_ = 0, scale_y_ = 0;
    std::vector<std::int32_t> seeds_ = {-1};
};

}  // namespace metrics
