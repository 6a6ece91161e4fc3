#include "adaptmesh/core/mesher/point_inserter.hpp"

#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/mesher/swap.hpp"
#include "adaptmesh/core/triangulation/locate.hpp"

namespace adaptmesh {

PointInserter::Outcome PointInserter::insert(Point at, const Tensor& metric, Index& near) {
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

bool PointInserter::has_room(const Vertex& p, Index home) {
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
            if (MetricMesh::in_circle(frame, mesh_.at(U.v[0]), mesh_.at(U.v[1]), mesh_.at(U.v[2]),
                                      p.at, 0.0)) {
                const Index apex = U.v[slot_of(T.n[slot])];
                if (MetricMesh::length(p, mesh_.vertices[apex]) < spacing_) return refused(p, apex);
                cavity_.push_back(triangle_of(T.n[slot]));
            }
        }
    }
    if (area * p.sqrt_det >= LEAST_AREA * double(cavity_.size() + 2)) return true;
    return refused(p, NONE);
}

bool PointInserter::refused(const Vertex& p, Index too_near) {
    if (cavity_.size() > MANY) crowded_[cell_of(p)] = too_near;
    return false;
}

bool PointInserter::is_known_to_be_crowded(const Vertex& p) const {
    if (crowded_.empty()) return false;
    const auto known = crowded_.find(cell_of(p));
    if (known == crowded_.end()) return false;
    return known->second == NONE || MetricMesh::length(p, mesh_.vertices[known->second]) < spacing_;
}

}  // namespace adaptmesh
