// A metric mesh and the stages that work on it in place, with arrays in and out.
#pragma once

#include "adaptmesh/core/bindings.hpp"
#include "adaptmesh/core/edges.hpp"
#include "adaptmesh/core/front.hpp"
#include "adaptmesh/core/improve.hpp"
#include "adaptmesh/core/load.hpp"
#include "adaptmesh/core/metric_mesh.hpp"
#include "adaptmesh/core/outline.hpp"
#include "adaptmesh/core/recut.hpp"
#include "adaptmesh/core/settle.hpp"
#include "adaptmesh/core/smooth.hpp"
#include "adaptmesh/core/swap.hpp"
#include "adaptmesh/core/triangulate.hpp"
#include "adaptmesh/core/zone.hpp"

namespace adaptmesh {

class Mesher {
  public:
    // A constrained Delaunay triangulation of the domain's points, with the metric at each.
    Mesher(const Points& points, const Tensors& tensors, const IndexPairs& segments,
           const Points& holes, const Points& seeds, bool nesting) {
        const std::size_t n = points.shape(0);
        expect_rows(tensors.shape(0), n, "tensors");
        const std::vector<Point> at = to_points(points);
        const std::vector<Segment> lines = to_segments(segments);
        const CarveOptions options{to_points(holes), to_points(seeds), nesting};

        nb::gil_scoped_release release;
        Triangulation outside;
        mesh_.topology = triangulate(at, lines, options, poll_, &outside).triangulation;
        outside_ = Outside(std::move(outside), at);
        for (std::size_t i = 0; i < n; ++i)
            mesh_.vertices.push_back(Vertex::make(at[i], tensor_in(tensors, i), FIXED));
        mesh_.take_fans_apart();
    }

    // A mesh that is already there: the label of each triangle, its constrained edges, and what
    // holds each vertex (FREE, FIXED, or a segment).
    Mesher(const Points& points, const Tensors& tensors, const IndexTriples& triangles,
           const Indices& labels, const IndexPairs& edges, const Indices& held_by) {
        const std::size_t n = points.shape(0);
        expect_rows(tensors.shape(0), n, "tensors");
        expect_rows(held_by.shape(0), n, "held_by");
        expect_rows(labels.shape(0), triangles.shape(0), "labels");
        std::vector<std::array<Index, 3>> corners(triangles.shape(0));
        for (std::size_t t = 0; t < corners.size(); ++t)
            corners[t] = {triangles(t, 0), triangles(t, 1), triangles(t, 2)};
        const std::vector<Index> label(labels.data(), labels.data() + labels.shape(0));
        const std::vector<Segment> locked = to_segments(edges);

        nb::gil_scoped_release release;
        mesh_.topology = load(Index(n), corners, label, locked);
        for (std::size_t i = 0; i < n; ++i) {
            mesh_.vertices.push_back(
                Vertex::make({points(i, 0), points(i, 1)}, tensor_in(tensors, i), held_by(i)));
        }
        mesh_.take_fans_apart();
    }

    // Cuts the constrained edges with these ends, pieces of these segments; of each cut, `piece`
    // tells on which it lies; they are in the order of the pieces, and on each from its first end.
    // Returns of each cut whether it could be made.
    nb::object cut_outline(const IndexPairs& ends, const Indices& segments, const Points& cuts,
                           const Tensors& tensors, const Indices& piece) {
        expect_rows(segments.shape(0), ends.shape(0), "segments");
        expect_rows(tensors.shape(0), cuts.shape(0), "tensors");
        expect_rows(piece.shape(0), cuts.shape(0), "piece");
        std::vector<Piece> pieces(ends.shape(0));
        for (std::size_t i = 0; i < pieces.size(); ++i)
            pieces[i] = {ends(i, 0), ends(i, 1), segments(i), 0, {}};
        for (std::size_t i = 0; i < cuts.shape(0); ++i) {
            Piece& p = pieces[piece(i)];
            if (p.cuts.empty()) p.first_cut = i;
            p.cuts.push_back(
                Vertex::make({cuts(i, 0), cuts(i, 1)}, tensor_in(tensors, i), p.segment));
        }
        OutlineCutter cutter(mesh_, outside_);
        {
            nb::gil_scoped_release release;
            constrained_ = cutter.cut(pieces, poll_);
            outside_ = Outside();
        }
        return to_numpy(std::move(cutter.is_made), {cuts.shape(0)}).attr("view")("bool");
    }

    // Cuts stretches of the outline anew: stretch s has the stops from first_stop[s] on, its ends
    // and the vertices between that go, and the cuts from first_cut[s] on; places give their order
    // along it. Returns the vertices of all stretches as they are now, their places, and where each
    // stretch begins.
    nb::tuple recut(const Indices& first_stop, const Indices& stops, const Values& stop_places,
                    const Indices& first_cut, const Points& cuts, const Tensors& tensors,
                    const Values& cut_places, const Indices& segments) {
        const std::size_t n = segments.shape(0);
        expect_rows(first_stop.shape(0), n + 1, "first_stop");
        expect_rows(first_cut.shape(0), n + 1, "first_cut");
        expect_rows(stop_places.shape(0), stops.shape(0), "places of stops");
        expect_rows(tensors.shape(0), cuts.shape(0), "tensors");
        expect_rows(cut_places.shape(0), cuts.shape(0), "places of cuts");
        std::vector<Index> now, begins = {0};
        std::vector<double> places;
        {
            nb::gil_scoped_release release;
            Recutter recutter(mesh_);
            for (std::size_t s = 0; s < n; ++s) {
                std::vector<Recutter::Stop> stretch;
                for (Index i = first_stop(s); i < first_stop(s + 1); ++i)
                    stretch.push_back({stop_places(i), stops(i), true});
                std::vector<Vertex> made;
                for (Index i = first_cut(s); i < first_cut(s + 1); ++i)
                    made.push_back(
                        Vertex::make({cuts(i, 0), cuts(i, 1)}, tensor_in(tensors, i), segments(s)));
                recutter.recut(stretch, made, cut_places.data() + first_cut(s));
                for (const Recutter::Stop& stop : stretch) {
                    now.push_back(stop.vertex);
                    places.push_back(stop.place);
                }
                begins.push_back(Index(now.size()));
            }
        }
        const std::size_t m = now.size();
        return nb::make_tuple(to_numpy(std::move(now), {m}), to_numpy(std::move(places), {m}),
                              to_numpy(std::move(begins), {n + 1}));
    }

    // The constrained edges of a mesh that was loaded, and the segment of each.
    void set_constrained(const IndexPairs& edges, const Indices& segments) {
        expect_rows(segments.shape(0), edges.shape(0), "segments");
        constrained_.clear();
        for (std::size_t i = 0; i < segments.shape(0); ++i)
            constrained_.push_back({edges(i, 0), edges(i, 1), segments(i)});
    }

    // All edges (e, 2), their lengths, and whether they are constrained.
    nb::tuple edges() const {
        EdgeList list = edge_list(mesh_);
        const std::size_t n = list.lengths.size();
        return nb::make_tuple(to_numpy(std::move(list.ends), {n, 2}),
                              to_numpy(std::move(list.lengths), {n}),
                              to_numpy(std::move(list.is_constrained), {n}).attr("view")("bool"));
    }

    nb::object corners_below(double quality) const {
        std::vector<Index> corners = adaptmesh::corners_below(mesh_, quality);
        const std::size_t n = corners.size();
        return to_numpy(std::move(corners), {n});
    }

    Index hold_all_but(const Flags& in_zone) {
        expect_rows(in_zone.shape(0), mesh_.vertices.size(), "in_zone");
        return adaptmesh::hold_all_but(mesh_, [&](Index v) { return in_zone(v); });
    }

    Index remove_free(int rounds) {
        nb::gil_scoped_release release;
        const Index left = Remover(mesh_).remove_free(rounds, poll_);
        mesh_.drop_dead_triangles();
        return left;
    }

    Index vertex_count() const { return mesh_.topology.living_vertex_count(); }

    EdgesToMeasure fresh_edges(double uncut_below) {
        nb::gil_scoped_release release;
        return take_fresh_edges(mesh_, uncut_below);
    }

    Front front(double accept, double spacing, double target, double settled, int trials) {
        FrontOptions options;
        options.accept = accept, options.spacing = spacing, options.target = target;
        options.settled = settled, options.trials = trials;
        return Front(mesh_, options);
    }

    std::size_t advance(Front& front) {
        nb::gil_scoped_release release;
        return front.advance(poll_);
    }

    Index insert_ahead(Front& front) {
        nb::gil_scoped_release release;
        return front.insert(poll_);
    }

    Index insert_along_edges(const EdgesToMeasure& edges, double long_edge, double spacing,
                             Index most_vertices) {
        nb::gil_scoped_release release;
        return adaptmesh::insert_along_edges(mesh_, edges, long_edge, spacing, most_vertices,
                                             poll_);
    }

    Index insert_where_finer(const Points& points, const Tensors& tensors, double ratio,
                             double spacing) {
        expect_rows(tensors.shape(0), points.shape(0), "tensors");
        const std::vector<Point> at = to_points(points);
        nb::gil_scoped_release release;
        return adaptmesh::insert_where_finer(
            mesh_, at, [&](std::size_t i) { return tensor_in(tensors, i); }, ratio, spacing, poll_);
    }

    Index swap(int most_passes) {
        nb::gil_scoped_release release;
        return swap_changed(mesh_, DelaunayCriterion{}, most_passes, poll_);
    }

    Index swap_worst(double below) {
        nb::gil_scoped_release release;
        for (Index t = 0; t < mesh_.topology.triangle_count(); ++t) {
            if (!mesh_.topology.is_dead(t) && mesh_.quality(t) < below)
                mesh_.topology.triangles[t].fresh |= TO_SWAP;
        }
        return swap_changed(mesh_, QualityCriterion{below}, 3, poll_);
    }

    Index smooth() {
        nb::gil_scoped_release release;
        return smooth_changed(mesh_, poll_);
    }

    Index collapse_short_edges() {
        nb::gil_scoped_release release;
        return adaptmesh::collapse_short_edges(mesh_, {}, poll_);
    }

    Index split_long_edges() {
        nb::gil_scoped_release release;
        return adaptmesh::split_long_edges(mesh_, {}, poll_);
    }

    Index search_active(double shortest, double longest, double least_quality, double step) {
        nb::gil_scoped_release release;
        return adaptmesh::search_active(mesh_, {shortest, longest, least_quality}, step, poll_);
    }

    Settler settler(double least_quality) {
        for (Triangle& t : mesh_.topology.triangles) t.fresh |= TO_IMPROVE;
        return Settler(mesh_, least_quality);
    }

    std::size_t find_sites(Settler& settler) {
        nb::gil_scoped_release release;
        return settler.find_sites();
    }

    std::size_t find_worst(Settler& settler, double below, std::size_t most) {
        nb::gil_scoped_release release;
        return settler.find_worst(below, most);
    }

    nb::object propose(Settler& settler, double step) {
        std::vector<double> points;
        {
            nb::gil_scoped_release release;
            points = settler.propose(step, poll_);
        }
        const std::size_t n = points.size() / 2;
        return to_numpy(std::move(points), {n, 2});
    }

    void set_kernels(Settler& settler, const Tensors& tensors) {
        nb::gil_scoped_release release;
        settler.set_kernels([&](std::size_t i) { return tensor_in(tensors, i); });
    }

    Index accept(Settler& settler) {
        nb::gil_scoped_release release;
        return settler.accept();
    }

    void correct_lengths(const EdgesToMeasure& edges) {
        nb::gil_scoped_release release;
        adaptmesh::correct_lengths(mesh_, edges);
    }

    // Drops vanished vertices and triangles, and numbers the rest anew.
    void compact() {
        nb::gil_scoped_release release;
        const std::vector<Index> name = mesh_.compact();
        for (SubEdge& e : constrained_) e.a = name[e.a], e.b = name[e.b];
    }

    nb::object points() const {
        std::vector<double> out;
        for (const Vertex& v : mesh_.vertices) out.push_back(v.at.x), out.push_back(v.at.y);
        return to_numpy(std::move(out), {mesh_.vertices.size(), 2});
    }

    // Where the metric was interpolated and wants to be evaluated.
    nb::object stale_points() {
        auto& stale = mesh_.stale;
        std::sort(stale.begin(), stale.end());
        stale.erase(std::unique(stale.begin(), stale.end()), stale.end());
        std::vector<double> out;
        for (Index v : stale) out.push_back(mesh_.at(v).x), out.push_back(mesh_.at(v).y);
        return to_numpy(std::move(out), {stale.size(), 2});
    }

    // The metrics at the stale points, in their order.
    void set_stale_metrics(const Tensors& tensors) {
        expect_rows(tensors.shape(0), mesh_.stale.size(), "tensors");
        for (std::size_t i = 0; i < mesh_.stale.size(); ++i) {
            Vertex& v = mesh_.vertices[mesh_.stale[i]];
            v = Vertex::make(v.at, tensor_in(tensors, i), v.held_by);
        }
        mesh_.stale.clear();
    }

    nb::object triangles() const {
        std::vector<Index> out;
        for (const Triangle& t : mesh_.topology.triangles) out.insert(out.end(), t.v, t.v + 3);
        const std::size_t n = out.size() / 3;
        return to_numpy(std::move(out), {n, 3});
    }

    nb::object labels() const {
        std::vector<Index> out;
        for (const Triangle& t : mesh_.topology.triangles) out.push_back(t.label);
        const std::size_t n = out.size();
        return to_numpy(std::move(out), {n});
    }

    // The constrained edges, and the segment of the outline that each lies on.
    nb::tuple constrained_edges() const {
        std::vector<Index> edges, owners;
        for (const SubEdge& e : constrained_) {
            edges.push_back(e.a), edges.push_back(e.b);
            owners.push_back(e.segment);
        }
        const std::size_t n = owners.size();
        return nb::make_tuple(to_numpy(std::move(edges), {n, 2}), to_numpy(std::move(owners), {n}));
    }

  private:
    MetricMesh mesh_;
    Outside outside_;  // until the outline has been cut
    std::vector<SubEdge> constrained_;
    SignalPoll poll_;
};

}  // namespace adaptmesh
