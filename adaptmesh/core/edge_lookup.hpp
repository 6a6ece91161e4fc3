// Edges found by their two end vertices, in either order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "adaptmesh/core/triangulation.hpp"

namespace adaptmesh {

class EdgeLookup {
  public:
    // Every element of `edges` has ends a and b; it is found as its number in the vector.
    template <typename Edge>
    explicit EdgeLookup(const std::vector<Edge>& edges) {
        entries_.reserve(edges.size());
        for (std::size_t i = 0; i < edges.size(); ++i) {
            entries_.push_back({key(edges[i].a, edges[i].b), Index(i)});
        }
        std::sort(entries_.begin(), entries_.end());
    }

    // NONE if there is no such edge.
    Index find(Index a, Index b) const {
        const Entry wanted{key(a, b), 0};
        const auto it = std::lower_bound(entries_.begin(), entries_.end(), wanted);
        return it != entries_.end() && it->first == wanted.first ? it->second : NONE;
    }

    // Two edges with the same ends, the lower number first; {NONE, NONE} if there are none.
    std::pair<Index, Index> doubled() const {
        for (std::size_t k = 1; k < entries_.size(); ++k) {
            if (entries_[k - 1].first == entries_[k].first) {
                return {entries_[k - 1].second, entries_[k].second};
            }
        }
        return {NONE, NONE};
    }

  private:
    using Entry = std::pair<std::uint64_t, Index>;

    static std::uint64_t key(Index a, Index b) {
        const auto [low, high] = std::minmax(a, b);
        return std::uint64_t(low) << 32 | std::uint32_t(high);
    }

    std::vector<Entry> entries_;
};

}  // namespace adaptmesh
