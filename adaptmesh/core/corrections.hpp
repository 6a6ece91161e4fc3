// What edges know of their true length.
//
// The closed form (metrics::length) sees the metric at the two ends only. Where the true length has
// been measured, the edge keeps its ratio to the closed form. The ratio belongs to the two ends: it
// survives small moves of them; an edge that a flip makes has none (1).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "adaptmesh/core/triangulation.hpp"

namespace adaptmesh {

class Corrections {
  public:
    double of(Index a, Index b) const {
        if (slots_.empty()) return 1.0;
        const Slot& s = slots_[place(key(a, b))];
        return s.key == EMPTY ? 1.0 : s.ratio;
    }

    bool knows(Index a, Index b) const {
        return !slots_.empty() && slots_[place(key(a, b))].key != EMPTY;
    }

    void set(Index a, Index b, double ratio) {
        if (2 * (used_ + 1) > slots_.size()) grow();
        Slot& s = slots_[place(key(a, b))];
        used_ += s.key == EMPTY;
        s = {key(a, b), ratio};
    }

    void clear() {
        slots_.clear();
        used_ = 0;
    }

  private:
    struct Slot {
        std::uint64_t key;
        double ratio;
    };
    static constexpr std::uint64_t EMPTY = ~std::uint64_t(0);

    static std::uint64_t key(Index a, Index b) {
        if (a > b) std::swap(a, b);
        return std::uint64_t(a) << 32 | std::uint32_t(b);
    }

    // Open addressing, at most half full, a power of two slots; where the key is or belongs.
    std::size_t place(std::uint64_t key) const {
        const std::size_t mask = slots_.size() - 1;
        std::size_t i = std::size_t((key * 0x9E3779B97F4A7C15u) >> 20) & mask;
        while (slots_[i].key != key && slots_[i].key != EMPTY) i = (i + 1) & mask;
        return i;
    }

    void grow() {
        std::vector<Slot> old(slots_.empty() ? 1024 : 2 * slots_.size(), Slot{EMPTY, 1.0});
        old.swap(slots_);
        for (const Slot& s : old) {
            if (s.key != EMPTY) slots_[place(s.key)] = s;
        }
    }

    std::vector<Slot> slots_;
    std::size_t used_ = 0;
};

}  // namespace adaptmesh
