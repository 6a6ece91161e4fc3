// The long loops of the core call a `poll` now and then, which may throw to stop them.
#pragma once

#include <cstddef>

namespace adaptmesh {

constexpr std::size_t POLL_EVERY = 1024;  // items of a loop between two polls

// For callers that never want to stop.
struct NoPoll {
    void operator()() const {}
};

}  // namespace adaptmesh
