#include "adaptmesh/core/mesher/split.hpp"

#include <algorithm>
#include <cmath>

namespace adaptmesh {

namespace {

constexpr double GOOD_QUALITY = 0.3;  // no new triangle worse than this, unless ...
constexpr double QUALITY_KEPT = 0.3;  // ... this share of the old worst is kept

// Half way in the metric, the size taken to be geometric along the edge: at
// log((1 + r) / 2) / log r, with r the ratio of the speeds at its ends.
Vertex middle(const Vertex& b, const Vertex& c) {
    const double dx = c.at.x - b.at.x, dy = c.at.y - b.at.y;
    const double r = std::sqrt(c.metric.q(dx, dy) / b.metric.q(dx, dy));
    const double s = std::abs(r - 1) < 1e-3 ? 0.5 : std::log(0.5 * (1 + r)) / std::log(r);
    return Vertex::make({b.at.x + s * dx, b.at.y + s * dy},
                        metrics::log_mean(b.metric, c.metric, s));
}

}  // namespace

bool Splitter::try_split(Place edge, double length) {
    const Quad q = quad_around(mesh_.topology, edge);
    const Vertex &a = mesh_.vertices[q.a], &b = mesh_.vertices[q.b];
    const Vertex &c = mesh_.vertices[q.c], &d = mesh_.vertices[q.d];
    const Vertex p = middle(b, c);
    // None of the new edges may be as far from unit as the one that goes.
    const double now_off = ratio_to_unit(length);
    if (ratio_to_unit(0.5 * length) >= now_off ||
        ratio_to_unit(inherited_length(p, a, q.a, q)) >= now_off ||
        ratio_to_unit(inherited_length(p, d, q.d, q)) >= now_off)
        return false;
    const Index across = mesh_.triangle(edge.triangle).n[edge.slot];
    const Place far{triangle_of(across), slot_of(across)};
    const double area = mesh_.euclidean_area(edge.triangle) + mesh_.euclidean_area(far.triangle);
    if (area * p.sqrt_det < 4 * LEAST_AREA) return false;
    const double then =
        std::min(std::min(MetricMesh::quality(a, b, p), MetricMesh::quality(a, p, c)),
                 std::min(MetricMesh::quality(d, c, p), MetricMesh::quality(d, p, b)));
    const double now = std::min(MetricMesh::quality(a, b, c), MetricMesh::quality(d, c, b));
    if (then < GOOD_QUALITY && then < QUALITY_KEPT * now) return false;
    if (!mesh_.stays_positive(edge, p.at) || !mesh_.stays_positive(far, p.at)) return false;
    mesh_.interpolated.push_back(put_on_edge(mesh_, edge, p, around_));
    return true;
}

// The edge from p, on (b, c), to a vertex opposite is corrected like those from b and c.
double Splitter::inherited_length(const Vertex& p, const Vertex& opposite, Index o,
                                  const Quad& q) const {
    const double ratio = mesh_.corrections.of(q.b, o) * mesh_.corrections.of(q.c, o);
    return std::sqrt(ratio) * MetricMesh::length(p, opposite);
}

}  // namespace adaptmesh
