// What is computed from values at the vertices of a mesh: measures, graded metrics, recovered
// derivatives.
#include <nanobind/nanobind.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "metrics/core/adjacency.hpp"
#include "metrics/core/bindings.hpp"
#include "metrics/core/edge_sides.hpp"
#include "metrics/core/gradation.hpp"
#include "metrics/core/lumped.hpp"
#include "metrics/core/nodal.hpp"
#include "metrics/core/recovery.hpp"

using namespace nb::literals;
using metrics::Tensor;

namespace {

static_assert(sizeof(Tensor) == 3 * sizeof(double), "packed tensors are three numbers in a row");

Tensor load(const double* p) {
    return {p[0], p[1], p[2]};
}

// The edges of triangles with numbers below `count`, sorted; and which of them each side is on.
auto mesh_edges(Triangles triangles, std::size_t count) {
    const std::size_t m = triangles.shape(0);
    Result<Index, 3> sides(m);
    std::vector<Index> found;
    {
        nb::gil_scoped_release release;
        const metrics::EdgeSides by_edge(triangles.data(), m, count);
        found.reserve(3 * m + 6);
        by_edge.for_each_edge([&](Index low, Index high, const auto* side, const auto* end) {
            for (; side != end; ++side) sides.data[side->side] = Index(found.size() / 2);
            found.push_back(low), found.push_back(high);
        });
    }
    Result<Index, 2> edges(found.size() / 2);
    std::copy(found.begin(), found.end(), edges.data);
    return std::make_tuple(edges.numpy(), sides.numpy());
}

auto lengths_by_quadrature(Tensors logs_at_start, Tensors logs_at_end, Points edges) {
    const std::size_t k = edges.shape(0);
    require(logs_at_start.shape(0) == k && logs_at_end.shape(0) == k,
            "one tensor at each end of each edge is needed");
    Result<double> out(k);
    {
        nb::gil_scoped_release release;
        const double *start = logs_at_start.data(), *end = logs_at_end.data(), *e = edges.data();
        for (std::size_t i = 0; i < k; ++i) {
            out.data[i] = metrics::length_by_quadrature(load(start + 3 * i), load(end + 3 * i),
                                                        e[2 * i], e[2 * i + 1]);
        }
    }
    return out.numpy();
}

// Metric areas of triangles, negative for clockwise ones.
auto areas(Points points, Triangles triangles, Tensors tensors) {
    const std::size_t n = points.shape(0), m = triangles.shape(0);
    require(tensors.shape(0) == n, "one tensor for each point is needed");
    Result<double> out(m);
    {
        nb::gil_scoped_release release;
        std::vector<double> log_density(n);
        for (std::size_t i = 0; i < n; ++i) {
            log_density[i] = 0.5 * std::log(metrics::det(load(tensors.data() + 3 * i)));
        }
        for (std::size_t t = 0; t < m; ++t) {
            const Index* v = triangles.data() + 3 * t;
            const double *p = points.data() + 2 * v[0], *q = points.data() + 2 * v[1],
                         *r = points.data() + 2 * v[2];
            const double doubled = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
            out.data[t] = doubled * metrics::mean_exponential(log_density[v[0]], log_density[v[1]],
                                                              log_density[v[2]]);
        }
    }
    return out.numpy();
}

// Along the edge opposite each corner, how much the derivative changes from end to end, times the
// length of the edge.
auto bends(Points points, Triangles triangles, Points gradients) {
    require(gradients.shape(0) == points.shape(0), "one gradient for each point is needed");
    Result<double, 3> out(triangles.shape(0));
    {
        nb::gil_scoped_release release;
        const double *p = points.data(), *g = gradients.data();
        const Index* v = triangles.data();
        for (std::size_t side = 0; side < 3 * out.rows; ++side) {
            const std::size_t corner = side / 3 * 3;
            const Index a = v[corner + (side + 1) % 3], b = v[corner + (side + 2) % 3];
            out.data[side] = (g[2 * b] - g[2 * a]) * (p[2 * b] - p[2 * a]) +
                             (g[2 * b + 1] - g[2 * a + 1]) * (p[2 * b + 1] - p[2 * a + 1]);
        }
    }
    return out.numpy();
}

// The square of the shortest edge at each vertex, infinite where there is none.
auto shortest_squares(Points points, Triangles triangles) {
    Result<double> out(points.shape(0));
    {
        nb::gil_scoped_release release;
        std::fill_n(out.data, out.rows, std::numeric_limits<double>::infinity());
        const double* p = points.data();
        const Index* v = triangles.data();
        for (std::size_t side = 0; side < 3 * triangles.shape(0); ++side) {
            const Index a = v[side], b = v[side % 3 == 2 ? side - 2 : side + 1];
            const double dx = p[2 * b] - p[2 * a], dy = p[2 * b + 1] - p[2 * a + 1];
            const double square = dx * dx + dy * dy;
            out.data[a] = std::min(out.data[a], square);
            out.data[b] = std::min(out.data[b], square);
        }
    }
    return out.numpy();
}

auto graded(Tensors tensors, Points points, Triangles triangles, int law, double log_beta,
            double tolerance) {
    const std::size_t n = points.shape(0);
    require(tensors.shape(0) == n, "one tensor for each point is needed");
    Result<double, 3> out(n);
    {
        nb::gil_scoped_release release;
        const metrics::Adjacency mesh(triangles.data(), triangles.shape(0), n);
        std::vector<Tensor> work(n);
        for (std::size_t i = 0; i < n; ++i) work[i] = load(tensors.data() + 3 * i);
        const metrics::Gradation rule{metrics::GradationLaw(law), log_beta, tolerance};
        metrics::grade(points.data(), work.data(), mesh, rule);
        for (std::size_t i = 0; i < n; ++i) {
            double* m = out.data + 3 * i;
            m[0] = work[i].a, m[1] = work[i].b, m[2] = work[i].c;
        }
    }
    return out.numpy();
}

auto quadratic_fit(Points points, Triangles triangles, Values values) {
    const std::size_t n = points.shape(0);
    require(values.shape(0) == n, "one value for each point is needed");
    Result<double, 2> gradients(n);
    Result<double, 3> hessians(n);
    std::int64_t undetermined = -1;
    {
        nb::gil_scoped_release release;
        const metrics::Adjacency mesh(triangles.data(), triangles.shape(0), n);
        metrics::QuadraticFit fit(points.data(), values.data(), mesh);
        for (std::size_t i = 0; i < n; ++i) {
            metrics::Derivatives d{};
            if (!fit.at(metrics::Index(i), d) && undetermined < 0) undetermined = std::int64_t(i);
            double *g = gradients.data + 2 * i, *h = hessians.data + 3 * i;
            g[0] = d.dx, g[1] = d.dy;
            h[0] = d.hessian.a, h[1] = d.hessian.b, h[2] = d.hessian.c;
        }
    }
    return std::make_tuple(gradients.numpy(), hessians.numpy(), undetermined);
}

auto projected_gradients(Points points, Triangles triangles, Values values) {
    const std::size_t n = points.shape(0);
    require(values.shape(0) == n, "one value for each point is needed");
    Result<double, 2> out(n);
    {
        nb::gil_scoped_release release;
        metrics::project_gradient(points.data(), n, triangles.data(), triangles.shape(0),
                                  values.data(), out.data);
    }
    return out.numpy();
}

// By Green's formula inside, and at the border of the quadratic fit.
auto green_hessians(Points points, Triangles triangles, Values values) {
    const std::size_t n = points.shape(0), m = triangles.shape(0);
    require(values.shape(0) == n, "one value for each point is needed");
    Result<double, 3> out(n);
    std::int64_t undetermined = -1;
    {
        nb::gil_scoped_release release;
        const std::vector<Tensor> by_green =
            metrics::green_hessians(points.data(), n, triangles.data(), m, values.data());
        std::vector<std::ptrdiff_t> around(n, 0);  // how many triangles
        for (std::size_t i = 0; i < 3 * m; ++i) ++around[triangles.data()[i]];
        const metrics::Adjacency mesh(triangles.data(), m, n);
        metrics::QuadraticFit fit(points.data(), values.data(), mesh);
        for (std::size_t i = 0; i < n; ++i) {
            metrics::Derivatives d{0, 0, by_green[i]};
            // All around a vertex inside there are as many triangles as neighbours.
            const bool inside = mesh.of(Index(i)).size() == around[i];
            if (!inside && !fit.at(Index(i), d) && undetermined < 0) undetermined = std::int64_t(i);
            double* h = out.data + 3 * i;
            h[0] = d.hessian.a, h[1] = d.hessian.b, h[2] = d.hessian.c;
        }
    }
    return std::make_tuple(out.numpy(), undetermined);
}

}  // namespace

void bind_nodal(nb::module_& m) {
    m.def("mesh_edges", &mesh_edges, "triangles"_a, "count"_a);
    m.def("lengths_by_quadrature", &lengths_by_quadrature, "logs_at_start"_a, "logs_at_end"_a,
          "edges"_a);
    m.def("areas", &areas, "points"_a, "triangles"_a, "tensors"_a);
    m.def("bends", &bends, "points"_a, "triangles"_a, "gradients"_a);
    m.def("shortest_squares", &shortest_squares, "points"_a, "triangles"_a);
    m.def("graded", &graded, "tensors"_a, "points"_a, "triangles"_a, "law"_a, "log_beta"_a,
          "tolerance"_a);
    m.def("quadratic_fit", &quadratic_fit, "points"_a, "triangles"_a, "values"_a,
          "Gradients (n, 2), packed Hessians (n, 3), the first vertex without (-1: none).");
    m.def("projected_gradients", &projected_gradients, "points"_a, "triangles"_a, "values"_a);
    m.def("green_hessians", &green_hessians, "points"_a, "triangles"_a, "values"_a,
          "Packed Hessians (n, 3), the first vertex where the border has none (-1: none).");
}
