// Sorting by numbers, without comparisons: by their lowest digit, then the next, and so on. Each
// pass keeps the order of items of the same digit, so that the last leaves all in order.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace metrics {

// Sorts items by key(item), a std::uint32_t; items of the same key stay in order. `spare` is room
// to work in.
template <typename Item, typename Key>
void sort_by_number(std::vector<Item>& items, std::vector<Item>& spare, Key key) {
    constexpr unsigned BITS = 11;  // of a digit: the heads of all piles fit into the cache
    constexpr std::uint32_t MASK = (1u << BITS) - 1;
    std::uint32_t largest = 0;
    for (const Item& item : items) largest = std::max<std::uint32_t>(largest, key(item));
    spare.resize(items.size());
    for (unsigned shift = 0; shift < 32 && largest >> shift; shift += BITS) {
        std::array<std::size_t, MASK + 2> place{};
        for (const Item& item : items) ++place[(key(item) >> shift & MASK) + 1];
        for (std::size_t digit = 0; digit < MASK; ++digit) place[digit + 1] += place[digit];
        for (const Item& item : items) spare[place[key(item) >> shift & MASK]++] = item;
        items.swap(spare);
    }
}

}  // namespace metrics
