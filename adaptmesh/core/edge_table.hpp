// What is known of edges, by their two ends in either order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "adaptmesh/core/triangulation.hpp"

namespace adaptmesh {

// A hash table with open addressing: a power of two of slots, at most half of them in use.
template <typename Value>
class EdgeTable {
  public:
    // Null if nothing is known of the edge. Good until the next `set`.
    const Value* find(Index a, Index b) const {
        if (slots_.empty()) return nullptr;
        const Slot& s = slots_[place(key(a, b))];
        return s.key == EMPTY ? nullptr : &s.value;
    }

    void set(Index a, Index b, const Value& value) {
        if (2 * (used_ + 1) > slots_.size()) grow();
        Slot& s = slots_[place(key(a, b))];
        used_ += s.key == EMPTY;
        s = {key(a, b), value};
    }

  private:
    struct Slot {
        std::uint64_t key;
        Value value;
    };
    static constexpr std::uint64_t EMPTY = ~std::uint64_t(0);

    static std::uint64_t key(Index a, Index b) {
        if (a > b) std::swap(a, b);
        return std::uint64_t(a) << 32 | std::uint32_t(b);
    }

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

}  // namespace adaptmesh
