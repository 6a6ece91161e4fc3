// Where a point is in a mesh of triangles: the one that has it, and its barycentric coordinates
// there.
//
// A look-up walks from a triangle that the caller remembers to the one that has the point, each
// step across the edge that the point lies furthest behind; without a hint, from a triangle that
// nested grids have for the place. In a mesh with holes and corners a walk may end at the border
// with the point still beyond; and on a mesh that is not Delaunay it may go in circles. So a walk
// is only ever an attempt, which nearly always succeeds: when it meets the border or has gone
// MAX_STEPS steps, a tree of boxes gives the definite answer, which triangle has the point, or, for
// a point outside, which border edge is nearest.
//
// Constant after construction: any number of threads may look up at once.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "metrics/core/boxtree.hpp"
#include "metrics/core/edge_sides.hpp"
#include "metrics/core/seedgrid.hpp"

namespace metrics {

// Where a point is: its triangle and its barycentric coordinates there, none negative. For a point
// outside, those of the nearest point of the border, and how far away that is.
struct Location {
    Index triangle;
    double weight[3];
    double outside = 0;
};

class Locator {
  public:
    static constexpr Index NO_TRIANGLE = -1;

    struct Vertex {
        double x, y;
    };

    // points: n pairs (x, y); triangles: m counter-clockwise triples.
    // Throws std::invalid_argument where the triangles are not a mesh.
    Locator(const double* points, std::size_t n, const Index* triangles, std::size_t m);

    Index triangle_count() const { return Index(triangles_.size()); }
    const Vertex& vertex(Index v) const { return vertices_[v]; }
    Index corner(Index triangle, int i) const { return triangles_[triangle].v[i]; }

    // The triangle across the edge opposite corner `edge`, or NO_TRIANGLE.
    Index neighbour(Index triangle, int edge) const { return triangles_[triangle].n[edge]; }

    // Of the box around the mesh.
    double diagonal() const {
        const Box box = triangle_tree_.bounds();
        return std::hypot(box.x1 - box.x0, box.y1 - box.y0);
    }

    // Calls visit(triangle) for each triangle whose box meets a box.
    template <typename Visit>
    void near(const Box& box, Visit visit) const {
        triangle_tree_.matching([&](const Box& b) { return b.meets(box); },
                                [&](Index t) { return visit(t), false; });
    }

    // `hint` is where to start from: -1, or any number that is not a triangle, when nothing is
    // known.
    Location locate(double x, double y, Index hint) const;

  private:
    static constexpr int MAX_STEPS = 64;
    // A point in no triangle, by this little in barycentric coordinates, fell between two of them
    // by rounding.
    static constexpr double ROUNDING = 1e-9;

    // Edge i lies opposite vertex i, and neighbour n[i] across it.
    struct Triangle {
        Index v[3], n[3];
    };

    struct Side {
        Index triangle;
        int edge;
    };

    // Twice the area of the triangle (point, v[i + 1], v[i + 2]): negative where the point is
    // behind edge i. The same edge seen from its other triangle gives exactly the opposite number,
    // so no walk turns back on its last step.
    void areas(const Triangle& t, double x, double y, double w[3]) const;

    static Location inside(Index triangle, const double w[3]);

    bool walk(double x, double y, Index start, Location& place) const;

    // Among the triangles whose boxes have the point: the one that has it best.
    bool search(double x, double y, Location& place) const;

    Location nearest_on_border(double x, double y) const;

    // How far along a side its point nearest to (x, y) is, and the squared distance to it.
    double share_of_side(Side side, double x, double y, double& squared_distance) const;

    void find_neighbours(const Index* triangles);

    // The vertex that side i of triangle t runs from, counter-clockwise.
    Index start(Index t, int i) const { return triangles_[t].v[(i + 1) % 3]; }

    void join(Index low, Index high, Index here, Index there, std::ptrdiff_t count);

    void prepare_searches();

    void include(Box& box, Index t, int corner) const {
        const Vertex& vertex = vertices_[triangles_[t].v[corner]];
        box.include(vertex.x, vertex.y);
    }

    std::vector<Vertex> vertices_;
    std::vector<Triangle> triangles_;
    std::vector<Side> border_;
    BoxTree triangle_tree_, border_tree_;
    SeedGrid seeds_;
};

}  // namespace metrics
