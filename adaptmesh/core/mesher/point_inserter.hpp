// Putting a point into a metric mesh: find its place, see that it keeps its distance, insert, flip.
#pragma once

#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/mesher/swap.hpp"
#include "adaptmesh/core/triangulation/locate.hpp"

namespace adaptmesh {

class PointInserter {
  public:
    PointInserter(MetricMesh& mesh, double spacing) : mesh_(mesh), spacing_(spacing) {}

    enum class Outcome { inserted, too_near, on_constraint, not_reached };

    // Tries to put a point into the mesh, walking to it from the triangle `near`, which becomes the
    // one where the walk ended. The new vertex is the last one.
    Outcome insert(Point at, const Tensor& metric, Index& near);

  private:
    // Where a point was refused that would replace more triangles than this, the points next to it
    // are refused for the same reason without looking at all of these again: beside a side that is
    // cut thousands of times per unit, every long edge asks for the same places.
    static constexpr std::size_t MANY = 64;
    static constexpr double NEXT_TO = 0.25;  // in metric length

    // A square around p of about that size, by the exponent of its side and its place in the grid
    // of such squares.
    using Cell = std::tuple<int, double, double>;
    static Cell cell_of(const Vertex& p) {
        const int exponent = std::ilogb(NEXT_TO / std::sqrt(p.metric.a + p.metric.c));
        const auto number = [&](double x) { return std::floor(std::scalbn(x, -exponent)); };
        return {exponent, number(p.at.x), number(p.at.y)};
    }

    // Looks at the triangles whose circle in the metric of p holds p: those that p would replace by
    // triangles to their vertices, two more than they are. Constraints screen what lies behind
    // them.
    bool has_room(const Vertex& p, Index home);

    // False, and remembers why: for this vertex that is too near, or for triangles too small.
    bool refused(const Vertex& p, Index too_near);

    bool is_known_to_be_crowded(const Vertex& p) const;

    MetricMesh& mesh_;
    double spacing_;
    std::vector<Index> cavity_;
    std::vector<Index> around_;
    std::map<Cell, Index> crowded_;
};

}  // namespace adaptmesh
