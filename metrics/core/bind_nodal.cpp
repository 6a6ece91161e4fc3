// What is computed from values at the vertices of a mesh: graded metrics, recovered derivatives.
#include <nanobind/nanobind.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "metrics/core/adjacency.hpp"
#include "metrics/core/bindings.hpp"
#include "metrics/core/gradation.hpp"
#include "metrics/core/recovery.hpp"

using namespace nb::literals;
using metrics::Tensor;

namespace {

static_assert(sizeof(Tensor) == 3 * sizeof(double), "packed tensors are three numbers in a row");

nb::object graded(Tensors tensors, Points points, Triangles triangles, int law, double log_beta,
                  double tolerance) {
    const std::size_t n = points.shape(0);
    require(tensors.shape(0) == n, "one tensor for each point is needed");
    Result<double> out(n, 3);
    {
        nb::gil_scoped_release release;
        const metrics::Adjacency mesh(triangles.data(), triangles.shape(0), n);
        std::vector<Tensor> work(n);
        for (std::size_t i = 0; i < n; ++i) {
            const double* m = tensors.data() + 3 * i;
            work[i] = {m[0], m[1], m[2]};
        }
        const metrics::Gradation rule{metrics::GradationLaw(law), log_beta, tolerance};
        metrics::grade(points.data(), work.data(), mesh, rule);
        for (std::size_t i = 0; i < n; ++i) {
            double* m = out.data + 3 * i;
            m[0] = work[i].a, m[1] = work[i].b, m[2] = work[i].c;
        }
    }
    return out.numpy();
}

nb::tuple quadratic_fit(Points points, Triangles triangles, Values values) {
    const std::size_t n = points.shape(0);
    require(values.shape(0) == n, "one value for each point is needed");
    Result<double> gradients(n, 2), hessians(n, 3);
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
    return nb::make_tuple(gradients.numpy(), hessians.numpy(), undetermined);
}

}  // namespace

void bind_nodal(nb::module_& m) {
    m.def("graded", &graded, "tensors"_a, "points"_a, "triangles"_a, "law"_a, "log_beta"_a,
          "tolerance"_a);
    m.def("quadratic_fit", &quadratic_fit, "points"_a, "triangles"_a, "values"_a,
          "Gradients (n, 2), packed Hessians (n, 3), the first vertex without (-1: none).");
}
