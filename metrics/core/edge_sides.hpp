// The sides of triangles, sorted by the edge that they lie on: by its smaller vertex, then by the
// other, then by triangle. The sides of one edge are neighbours in this order.
//
//     side    2   5 | 0 | 1   7 | ...        side 3 t + i lies opposite corner i of triangle t
//     edge   (0, 1) (0, 2)  (0, 4)
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace metrics {

using Index = std::int32_t;

class EdgeSides {
  public:
    struct Entry {
        Index high;  // the larger vertex of its edge
        Index side;
    };

    // triangles: m triples of numbers in [0, n), of any orientation.
    EdgeSides(const Index* triangles, std::size_t m, std::size_t n) : first_(n + 2, 0) {
        // Counted two places ahead, so that putting the entries in leaves `first_` as it is to be.
        for (std::size_t k = 0; k < 3 * m; ++k) ++first_[ends(triangles, k).low + 2];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        entries_.resize(3 * m);
        for (std::size_t k = 0; k < 3 * m; ++k) {
            const Ends edge = ends(triangles, k);
            entries_[first_[edge.low + 1]++] = {edge.high, Index(k)};
        }
        for (std::size_t low = 0; low < n; ++low) sort(first_[low], first_[low + 1]);
    }

    // Calls visit(low, high, first, end), with pointers to the entries of each edge, in order.
    template <typename Visit>
    void for_each_edge(Visit visit) const {
        const Entry* entry = entries_.data();
        for (std::size_t low = 0; low + 2 < first_.size(); ++low) {
            const Entry* const stop = entries_.data() + first_[low + 1];
            while (entry != stop) {
                const Entry* end = entry + 1;
                while (end != stop && end->high == entry->high) ++end;
                visit(Index(low), entry->high, entry, end);
                entry = end;
            }
        }
    }

  private:
    struct Ends {
        Index low, high;
    };

    static Ends ends(const Index* triangles, std::size_t side) {
        const Index* corner = triangles + side / 3 * 3;
        const Index from = corner[(side + 1) % 3], to = corner[(side + 2) % 3];
        return {std::min(from, to), std::max(from, to)};
    }

    // By insertion where there are few, as there are around nearly every vertex; stable.
    void sort(std::size_t begin, std::size_t end) {
        constexpr std::size_t FEW = 24;
        const auto before = [](const Entry& a, const Entry& b) { return a.high < b.high; };
        Entry* const entries = entries_.data();
        if (end - begin > FEW) return std::stable_sort(entries + begin, entries + end, before);
        for (std::size_t i = begin + 1; i < end; ++i) {
            const Entry entry = entries[i];
            std::size_t place = i;
            for (; place > begin && before(entry, entries[place - 1]); --place) {
                entries[place] = entries[place - 1];
            }
            entries[place] = entry;
        }
    }

    std::vector<std::size_t> first_;  // of each smaller vertex; one more at the end
    std::vector<Entry> entries_;
};

}  // namespace metrics
