#include "adaptmesh/core/placements/front.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "adaptmesh/core/mesher/point_inserter.hpp"

namespace adaptmesh {

namespace {

constexpr double ACCEPTED = 1.35;  // a triangle ahead whose other sides are shorter stays as it is
constexpr double SPACING = 0.8;    // a point nearer than this to a vertex is refused
constexpr double TARGET = 1.0;     // length of the sides to be made, before `Books`
constexpr double LOWEST = 0.6, HIGHEST = 1.26;  // height of the new triangle
constexpr double TAKEN = 0.75;        // one expected to be nearer to a vertex is not asked about
constexpr double AT_REST = 0.01;      // a point that would move less than this stays where it is
constexpr double MAY_MOVE = 0.1;      // so few of a layer that would move stay, too
constexpr int TRIALS = 3;             // how often a point is asked about, at most
constexpr std::size_t COARSEST = 32;  // of every so many points of a layer one goes in first

struct FrontEdge {
    Index a, b;
};

// A point to be put ahead of an edge.
struct Candidate {
    FrontEdge edge;
    Point at;
    Index near;     // the triangle it lies in, NONE if it is out of sight
    Tensor metric;  // at the point, as soon as it is known; until then what is expected
    Index vertex;   // that it has become, or NONE
};

// Triangles accepted lately, and how many unit triangles their metric area is worth. Where the
// metric grows finer ahead of the front, sides are on average above the target; where it is
// curved, unit sides enclose less than a unit triangle. Both would show in the count.
class Books {
  public:
    void age() { made_ *= MEMORY, worth_ *= MEMORY; }
    void enter(double area) { made_ += 1, worth_ += area / (0.25 * std::sqrt(3.0)); }
    double correction() const {
        return made_ < FEWEST ? 1 : std::min(std::max(made_ / worth_, 1 / MOST), MOST);
    }

  private:
    static constexpr double MEMORY = 0.95;  // share of the account that outlives a layer
    static constexpr double FEWEST = 20;    // triangles before the account is heeded
    static constexpr double MOST = 1.07;
    double made_ = 0, worth_ = 0;
};

class Front {
  public:
    // Begins at the constraints.
    explicit Front(MetricMesh& mesh) : mesh_(mesh) {
        for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
            const Triangle& T = mesh.triangle(t);
            for (int slot = 0; slot < 3; ++slot) {
                if (is_locked(T.n[slot])) edges_.push_back({T.v[next(slot)], T.v[prev(slot)]});
            }
        }
    }

    // Accepts what it can; returns the points to be put ahead of the other edges, where the metric
    // is expected to have them.
    std::vector<Candidate> next_layer(Monitor& monitor) {
        std::vector<Candidate> layer;
        candidate_at_.resize(mesh_.vertices.size(), NONE);
        books_.age();
        for (std::size_t i = 0; i < edges_.size(); ++i) {  // grows on the way
            monitor.poll(i);
            consider(edges_[i], layer);
        }
        edges_.clear();
        for (const Candidate& c : layer) candidate_at_[c.edge.a] = candidate_at_[c.edge.b] = NONE;
        return layer;
    }

    // Finds where the points of a layer belong with the metric that is there.
    void find_places(std::vector<Candidate>& layer, const MetricField& metric) const {
        struct Move {
            std::size_t candidate;
            Point to;
        };
        std::vector<std::size_t> open(layer.size());
        std::iota(open.begin(), open.end(), 0);
        for (int trial = 1; !open.empty(); ++trial) {
            std::vector<Point> points;
            for (std::size_t i : open) points.push_back(layer[i].at);
            const std::vector<Tensor> tensors = evaluate(metric, points);
            std::vector<Move> moves;
            for (std::size_t k = 0; k < open.size(); ++k) {
                Candidate& c = layer[open[k]];
                c.metric = tensors[k];
                if (trial == TRIALS) continue;
                const Point better = apex(c.edge, c.metric);
                const double x = better.x - c.at.x, y = better.y - c.at.y;
                if (c.metric.q(x, y) >= AT_REST * AT_REST) moves.push_back({open[k], better});
            }
            open.clear();
            if (double(moves.size()) <= MAY_MOVE * double(layer.size())) return;
            for (const Move& move : moves) {
                Candidate& c = layer[move.candidate];
                c.at = move.to;
                if (is_in_sight(c))
                    open.push_back(move.candidate);
                else
                    c.near = NONE;
            }
        }
    }

    // Puts the points into the mesh, each with the metric there; new edges join the front, in the
    // order of the old ones.
    //
    // The points go in from coarse to fine along the front. Where a void lies ahead, the triangles
    // that reach across it are shared by the points of the layer; one after the other, each point
    // would take nearly all of those of the point before:
    //
    //      \    |    /  .-'             \   |    \   |    \   |
    //       .---.---.-'- - -             .---.----.---.----.---.
    //      one after the other           every other, then those between
    void insert(std::vector<Candidate>& layer, Monitor& monitor) {
        PointInserter inserter(mesh_, SPACING);
        const auto put_in = [&](std::size_t first, std::size_t step) {
            for (std::size_t i = first, done = 0; i < layer.size(); i += step, ++done) {
                monitor.poll(done);
                Candidate& c = layer[i];
                if (c.near == NONE) continue;  // out of sight
                if (inserter.insert(c.at, c.metric, c.near) == PointInserter::Outcome::inserted)
                    c.vertex = Index(mesh_.vertices.size()) - 1;
            }
        };
        put_in(0, COARSEST);
        for (std::size_t step = COARSEST; step > 1; step /= 2) put_in(step / 2, step);

        for (const Candidate& c : layer) {
            if (c.vertex == NONE) continue;
            edges_.push_back(c.edge);
            edges_.push_back({c.vertex, c.edge.b});
            edges_.push_back({c.edge.a, c.vertex});
        }
    }

  private:
    double metric_area(Index t) const {
        double density = 0;
        for (Index v : mesh_.triangle(t).v) density += mesh_.vertices[v].sqrt_det;
        return mesh_.euclidean_area(t) * density / 3;
    }

    void consider(FrontEdge e, std::vector<Candidate>& layer) {
        if (is_candidate(e, layer)) return;
        const Place place = mesh_.topology.find_edge(e.a, e.b);
        if (place.triangle == NONE) return;
        Triangle& T = mesh_.topology.triangles[place.triangle];
        if (!(T.pending & TO_ADVANCE)) return;
        const Index opposite = T.v[place.slot];
        if (mesh_.length(e.b, opposite) < ACCEPTED && mesh_.length(opposite, e.a) < ACCEPTED) {
            T.pending &= ~TO_ADVANCE;
            books_.enter(metric_area(place.triangle));
            edges_.push_back({opposite, e.b});
            edges_.push_back({e.a, opposite});
            return;
        }
        const Tensor ahead = expected_metric(e, T.n[place.slot]);
        Candidate c{e, apex(e, ahead), place.triangle, ahead, NONE};
        if (is_near_another(c, layer) || !is_in_sight(c) || is_at_corner(c)) return;
        candidate_at_[e.a] = candidate_at_[e.b] = Index(layer.size());
        layer.push_back(c);
    }

    // An edge may come twice in a layer, on its own and as a side of a triangle that is accepted.
    bool is_candidate(FrontEdge e, const std::vector<Candidate>& layer) const {
        const Index k = candidate_at_[e.a];
        return k != NONE && layer[k].edge.a == e.a && layer[k].edge.b == e.b;
    }

    // Whether a neighbour along the front has its point in about the same place: only the first of
    // them would be put in.
    bool is_near_another(const Candidate& c, const std::vector<Candidate>& layer) const {
        const Vertex p = Vertex::make(c.at, c.metric);
        const auto is_near = [&](Index k) {
            if (k == NONE) return false;
            const Candidate& other = layer[k];
            return MetricMesh::length(p, Vertex::make(other.at, other.metric)) < TAKEN;
        };
        return is_near(candidate_at_[c.edge.a]) || is_near(candidate_at_[c.edge.b]);
    }

    // Whether there is a vertex already in about the same place.
    bool is_at_corner(const Candidate& c) const {
        const Vertex p = Vertex::make(c.at, c.metric);
        for (Index v : mesh_.triangle(c.near).v) {
            if (MetricMesh::length(p, mesh_.vertices[v]) < TAKEN) return true;
        }
        return false;
    }

    // The metric expected ahead of an edge, as far as vertex d is behind it: that of its middle and
    // as much more again as the middle has more than d, if that is a metric not far from it.
    //
    //            b
    //          / | .
    //         d  |   P         behind: the edge as d's triangle sees it
    //          \ | .
    //            a
    Tensor expected_metric(FrontEdge e, Index behind) const {
        const Tensor middle = 0.5 * (mesh_.vertices[e.a].metric + mesh_.vertices[e.b].metric);
        if (is_locked(behind)) return middle;
        const Index d = mesh_.triangle(triangle_of(behind)).v[slot_of(behind)];
        const Tensor ahead = 2.0 * middle - mesh_.vertices[d].metric;
        const double det = ahead.a * ahead.c - ahead.b * ahead.b;
        const double known = middle.a * middle.c - middle.b * middle.b;
        const bool is_near = ahead.a > 0 && det > 0.25 * known && det < 4 * known;
        return is_near ? ahead : middle;
    }

    // Whether the point lies in the domain, and no constraint hides it from its edge: the metric is
    // asked for nowhere else.
    bool is_in_sight(Candidate& c) const {
        if (!std::isfinite(c.at.x) || !std::isfinite(c.at.y)) return false;
        const Location where = locate(
            mesh_.topology, [this](Index v) { return mesh_.at(v); }, c.at, c.near,
            Walls::locked_edges);
        c.near = where.triangle;
        return where.where == Where::in_triangle || where.where == Where::on_edge;
    }

    // The middle of (a, b) plus the height along the M-orthogonal w of e, for sides of the target
    // length; M is the mean of the metrics at a, b and the apex. Of M only the shape gives w its
    // direction: it is scaled so that huge and tiny sizes neither overflow nor vanish.
    Point apex(FrontEdge edge, const Tensor& ahead) const {
        const Tensor sum = mesh_.vertices[edge.a].metric + mesh_.vertices[edge.b].metric + ahead;
        const double scale = 1 / (sum.a + sum.c);
        const Tensor m = scale * sum;
        const Point a = mesh_.at(edge.a), b = mesh_.at(edge.b);
        const double ex = b.x - a.x, ey = b.y - a.y;
        const double wx = -(m.b * ex + m.c * ey), wy = m.a * ex + m.b * ey;
        const double length = mesh_.length(edge.a, edge.b);
        const double target = TARGET * books_.correction();
        const double square = target * target - 0.25 * length * length;
        const double height = std::min(std::max(std::sqrt(std::max(square, 0.0)), LOWEST), HIGHEST);
        const double share = height * std::sqrt(3 * scale / m.q(wx, wy));
        return {0.5 * (a.x + b.x) + share * wx, 0.5 * (a.y + b.y) + share * wy};
    }

    MetricMesh& mesh_;
    Books books_;
    std::vector<FrontEdge> edges_;     // of the layer to come
    std::vector<Index> candidate_at_;  // of the layer at hand, by an edge at each vertex
};

}  // namespace

void place_ahead_of_front(MetricMesh& mesh, const MetricField& metric, Monitor& monitor) {
    Front front(mesh);
    while (true) {
        monitor.report_placed("placing points ahead of the front",
                              mesh.topology.living_vertex_count());
        std::vector<Candidate> layer = front.next_layer(monitor);
        if (layer.empty()) return;
        front.find_places(layer, metric);
        front.insert(layer, monitor);
        monitor.check_vertex_count(mesh.topology.living_vertex_count());
    }
}

}  // namespace adaptmesh
