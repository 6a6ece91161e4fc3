// What the long work of the core asks of its caller, and tells: whether to stop, how many vertices
// a mesh may have, and how far the work is.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <optional>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

// A mesh needs more vertices than the caller allows; many of them near a point, if that is known.
struct TooManyVertices : std::exception {
    std::optional<Point> near;

    explicit TooManyVertices(std::optional<Point> near = std::nullopt) : near(near) {}
    const char* what() const noexcept override { return "the mesh needs too many vertices"; }
};

// This one never stops the work and shows nothing; callers derive from it.
class Monitor {
  public:
    Monitor() = default;
    Monitor(Index max_vertices, Index expected_vertices)
        : max_vertices_(max_vertices), expected_vertices_(expected_vertices) {}
    Monitor(const Monitor&) = delete;
    Monitor& operator=(const Monitor&) = delete;
    virtual ~Monitor() = default;

    // Long loops call this for each of their items, by its number: once in a while it asks whether
    // to stop, which is by an exception.
    void poll(std::size_t item) {
        if (item % ITEMS_BETWEEN_POLLS == 0) stop_if_asked();
    }

    Index max_vertices() const { return max_vertices_; }
    void check_vertex_count(Index n) const {
        if (n > max_vertices_) throw TooManyVertices();
    }

    // How much of all the work is done, from 0 to 1, and what is being done.
    virtual void report(const char* /*stage*/, double /*fraction*/) {}

    // The same while points are placed, which takes the time from PLACING to OPTIMISING.
    void report_placed(const char* stage, Index n) {
        const double share = double(n) / std::max(expected_vertices_, Index(1));
        report(stage, std::min(OPTIMISING, PLACING + (OPTIMISING - PLACING) * share));
    }

    // Shares of the work that are done when these stages begin.
    static constexpr double TRIANGULATING = 0.03, PLACING = 0.05, OPTIMISING = 0.7, FINAL = 0.97;

  protected:
    virtual void stop_if_asked() {}

  private:
    static constexpr std::size_t ITEMS_BETWEEN_POLLS = 1024;

    Index max_vertices_ = MAX_VERTICES;
    Index expected_vertices_ = 1;
};

}  // namespace adaptmesh
