// Edges found by their two end vertices, in either order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

inline std::uint64_t edge_key(Index a, Index b) {
    if (a > b) std::swap(a, b);
    return std::uint64_t(a) << 32 | std::uint32_t(b);
}

// What is known of edges.
//
// A hash table with open addressing: a power of two of slots, at most half of them in use.
template <typename Value>
class EdgeMap {
  public:
    // Null if nothing is known of the edge. Good until the next `set`.
    const Value* find(Index a, Index b) const {
        if (slots_.empty()) return nullptr;
        const Slot& s = slots_[place(edge_key(a, b))];
        return s.key == EMPTY ? nullptr : &s.value;
    }

    void set(Index a, Index b, const Value& value) {
        if (2 * (used_ + 1) > slots_.size()) grow();
        Slot& s = slots_[place(edge_key(a, b))];
        used_ += s.key == EMPTY;
        s = {edge_key(a, b), value};
    }

  private:
    struct Slot {
        std::uint64_t key;
        Value value;
    };
    static constexpr std::uint64_t EMPTY = ~std::uint64_t(0);

    // Where the key is or belongs.
    std::size_t place(std::uint64_t key) const {
        const std::size_t mask = slots_.size() - 1;
        std::size_t i = std::size_t((key * 0x9E3779B97F4A7C15u) >> 20) & mask;
        while (slots_[i].key != key && slots_[i].key != EMPTY) i = (i + 1) & mask;
        return i;
    }

    void grow() {
        std::vector<Slot> old(slots_.empty() ? 1024 : 2 * slots_.size(), Slot{EMPTY, {}});
        old.swap(slots_);
        for (const Slot& s : old) {
            if (s.key != EMPTY) slots_[place(s.key)] = s;
        }
    }

    std::vector<Slot> slots_;
    std::size_t used_ = 0;
};

// The numbers of edges in a vector, sorted.
class EdgeNumbers {
  public:
    // Every element of `edges` has ends a and b; it is found as its number in the vector.
    template <typename Edge>
    explicit EdgeNumbers(const std::vector<Edge>& edges) {
        entries_.reserve(edges.size());
        for (std::size_t i = 0; i < edges.size(); ++i) {
            entries_.push_back({edge_key(edges[i].a, edges[i].b), Index(i)});
        }
        std::sort(entries_.begin(), entries_.end());
    }

    // NONE if there is no such edge.
    Index find(Index a, Index b) const {
        const Entry sought{edge_key(a, b), 0};
        const auto it = std::lower_bound(entries_.begin(), entries_.end(), sought);
        return it != entries_.end() && it->first == sought.first ? it->second : NONE;
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

    std::vector<Entry> entries_;
};

}  // namespace adaptmesh
