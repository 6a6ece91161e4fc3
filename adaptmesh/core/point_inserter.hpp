// Putting a point into a metric mesh: find its place, see that it keeps its distance, insert, flip.
#pragma once

#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "adaptmesh/core/locate.hpp"
#include "adaptmesh/core/metric_mesh.hpp"
#include "adaptmesh/core/swap.hpp"

namespace adaptmesh {

class PointInserter {
  public:
    PointInserter(MetricMesh& mesh, double spacing) : mesh_(mesh), spacing_(spacing) {}

    enum class Outcome { inserted, too_near, on_constraint, not_reached };

    // Tries to put a point into the mesh, walking to it from the triangle `near`, which becomes the
    // one where the walk ended. The new vertex is the last one.
    Outcome insert(Point at, const Tensor& metric, Index& near) {
        const Location where = locate(
            mesh_.topology, [this](Index v) { return mesh_.at(v); }, at, near, Walls::locked_edges);
        near = where.triangle;
        if (where.where == Where::on_vertex) return Outcome::too_near;
        if (where.where == Where::outside) return Outcome::not_reached;
        const Place place = where.place();
        const bool on_edge = where.where == Where::on_edge;
        if (on_edge && is_locked(mesh_.triangle(place.triangle).n[place.slot]))
            return Outcome::on_constraint;

        const Vertex p = Vertex::make(at, metric);
        if (!has_room(p, place.triangle)) return Outcome::too_near;

        if (on_edge) {
            put_on_edge(mesh_, place, p, around_);
        } else {
            const Index v = mesh_.add_vertex(p);
            const auto added = mesh_.topology.split_triangle(place.triangle, v);
            around_.assign({place.triangle, added[0], added[1]});
            legalise_around(mesh_, v, around_);
        }
        return Outcome::inserted;
    }

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
    bool has_room(const Vertex& p, Index home) {
        auto& triangles = mesh_.topology.triangles;
        const std::uint32_t stamp = mesh_.topology.new_stamp();
        const MetricMesh::Frame frame(p.metric, p.sqrt_det);
        for (Index v : triangles[home].v) {
            if (MetricMesh::length(p, mesh_.vertices[v]) < spacing_) return false;
        }
        if (is_known_to_be_crowded(p)) return false;
        cavity_.assign(1, home);
        triangles[home].stamp = stamp;
        double area = 0;
        for (std::size_t i = 0; i < cavity_.size(); ++i) {
            const Triangle& T = triangles[cavity_[i]];
            area += mesh_.euclidean_area(cavity_[i]);
            for (int slot = 0; slot < 3; ++slot) {
                if (is_locked(T.n[slot])) continue;
                Triangle& U = triangles[triangle_of(T.n[slot])];
                if (U.stamp == stamp) continue;
                U.stamp = stamp;
                if (MetricMesh::in_circle(frame, mesh_.at(U.v[0]), mesh_.at(U.v[1]),
                                          mesh_.at(U.v[2]), p.at, 0.0)) {
                    const Index apex = U.v[slot_of(T.n[slot])];
                    if (MetricMesh::length(p, mesh_.vertices[apex]) < spacing_)
                        return refused(p, apex);
                    cavity_.push_back(triangle_of(T.n[slot]));
                }
            }
        }
        if (area * p.sqrt_det >= LEAST_AREA * double(cavity_.size() + 2)) return true;
        return refused(p, NONE);
    }

    // False, and remembers why: for this vertex that is too near, or for triangles too small.
    bool refused(const Vertex& p, Index too_near) {
        if (cavity_.size() > MANY) crowded_[cell_of(p)] = too_near;
        return false;
    }

    bool is_known_to_be_crowded(const Vertex& p) const {
        if (crowded_.empty()) return false;
        const auto known = crowded_.find(cell_of(p));
        if (known == crowded_.end()) return false;
        return known->second == NONE ||
               MetricMesh::length(p, mesh_.vertices[known->second]) < spacing_;
    }

    MetricMesh& mesh_;
    double spacing_;
    std::vector<Index> cavity_;
    std::vector<Index> around_;
    std::map<Cell, Index> crowded_;
};

}  // namespace adaptmesh
