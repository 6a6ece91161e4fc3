// The neighbours of each vertex of a triangulation: those at the other ends of its edges, each
// once, ascending. One array holds them all, vertex after vertex.
//
//     first:       0     2        5  ...
//     neighbours:  1 4 | 0 2 4  | 1  ...
//        of vertex   0      1       2
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace metrics {

using Index = std::int32_t;

class Adjacency {
  public:
    // triangles: m triples of numbers in [0, n), of any orientation.
    Adjacency(const Index* triangles, std::size_t m, std::size_t n) : first_(n + 1, 0) {
        std::vector<std::size_t> next(n + 1, 0);
        for (std::size_t i = 0; i < 3 * m; ++i) next[triangles[i] + 1] += 2;
        std::partial_sum(next.begin(), next.end(), next.begin());
        neighbours_.resize(6 * m);
        std::vector<std::size_t> end(next.begin(), next.end() - 1);
        for (std::size_t t = 0; t < m; ++t) {
            const Index* v = triangles + 3 * t;
            for (int i = 0; i < 3; ++i) {
                neighbours_[end[v[i]]++] = v[(i + 1) % 3];
                neighbours_[end[v[i]]++] = v[(i + 2) % 3];
            }
        }
        drop_repetitions(next);
    }

    struct Range {
        const Index *begin_, *end_;
        const Index* begin() const { return begin_; }
        const Index* end() const { return end_; }
        std::ptrdiff_t size() const { return end_ - begin_; }
    };

    Range of(Index vertex) const {
        return {neighbours_.data() + first_[vertex], neighbours_.data() + first_[vertex + 1]};
    }

    std::size_t size() const { return first_.size() - 1; }

  private:
    // Sorts the neighbours of each vertex, which start where `start` says, and closes the gaps.
    void drop_repetitions(const std::vector<std::size_t>& start) {
        auto kept = neighbours_.begin();
        for (std::size_t v = 0; v < size(); ++v) {
            const auto begin = neighbours_.begin() + std::ptrdiff_t(start[v]);
            const auto end = neighbours_.begin() + std::ptrdiff_t(start[v + 1]);
            std::sort(begin, end);
            kept = std::copy(begin, std::unique(begin, end), kept);
            first_[v + 1] = std::size_t(kept - neighbours_.begin());
        }
        neighbours_.erase(kept, neighbours_.end());
    }

    std::vector<std::size_t> first_;
    std::vector<Index> neighbours_;
};

}  // namespace metrics
