// The module metrics._core: arrays in, arrays out, without the interpreter lock.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "metrics/core/background.hpp"
#include "metrics/core/bindings.hpp"
#include "metrics/core/tensor.hpp"

using namespace nb::literals;
using metrics::Tensor;

namespace {

Tensor load(const double* p) {
    return {p[0], p[1], p[2]};
}
void store(double* p, Tensor t) {
    p[0] = t.a, p[1] = t.b, p[2] = t.c;
}

// Fills a packed array with make(i), and finds the first i that is not accepted (-1: all are).
template <typename Make, typename Accept>
auto checked(std::size_t n, Make make, Accept accept) {
    Result<double, 3> out(n);
    std::int64_t first = -1;
    {
        nb::gil_scoped_release release;
        for (std::size_t i = 0; i < n; ++i) {
            const Tensor t = make(i);
            store(out.data + 3 * i, t);
            if (!accept(i, t) && first < 0) first = std::int64_t(i);
        }
    }
    return std::make_pair(out.numpy(), first);
}

auto check_sizes(Values sizes) {
    const double* h = sizes.data();
    return checked(
        sizes.shape(0), [h](std::size_t i) { return metrics::from_size(h[i]); },
        [h](std::size_t i, Tensor t) { return h[i] > 0 && metrics::is_metric(t); });
}

auto check_tensors(Tensors tensors) {
    const double* m = tensors.data();
    return checked(
        tensors.shape(0), [m](std::size_t i) { return load(m + 3 * i); },
        [](std::size_t, Tensor t) { return metrics::is_metric(t); });
}

auto check_matrices(Matrices matrices, double asymmetry) {
    const double* m = matrices.data();
    return checked(
        matrices.shape(0),
        [m](std::size_t i) {
            const double* p = m + 4 * i;
            return Tensor{p[0], 0.5 * (p[1] + p[2]), p[3]};
        },
        [m, asymmetry](std::size_t i, Tensor t) {
            const double difference = std::fabs(m[4 * i + 1] - m[4 * i + 2]);
            return metrics::is_metric(t) && difference <= asymmetry * (t.a + t.c);
        });
}

// The first triangle that is not counter-clockwise with some area, -1 if there is none.
std::int64_t check_triangles(Points points, Triangles triangles) {
    nb::gil_scoped_release release;
    const double* p = points.data();
    for (std::size_t t = 0; t < triangles.shape(0); ++t) {
        const Index* v = triangles.data() + 3 * t;
        const double *a = p + 2 * v[0], *b = p + 2 * v[1], *c = p + 2 * v[2];
        if (!((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0)) {
            return std::int64_t(t);
        }
    }
    return -1;
}

template <typename Function>
auto map_tensors(Tensors tensors, Function function) {
    Result<double, 3> out(tensors.shape(0));
    {
        nb::gil_scoped_release release;
        const double* in = tensors.data();
        for (std::size_t i = 0; i < out.rows; ++i) {
            store(out.data + 3 * i, function(load(in + 3 * i)));
        }
    }
    return out.numpy();
}

template <typename Function>
auto combine(Tensors s, Tensors t, Function function) {
    require(s.shape(0) == t.shape(0), "as many tensors are needed on both sides");
    Result<double, 3> out(s.shape(0));
    {
        nb::gil_scoped_release release;
        const double *left = s.data(), *right = t.data();
        for (std::size_t i = 0; i < out.rows; ++i) {
            store(out.data + 3 * i, function(load(left + 3 * i), load(right + 3 * i)));
        }
    }
    return out.numpy();
}

auto absolute(Tensors tensors, Values floors) {
    require(tensors.shape(0) == floors.shape(0), "one floor for each tensor is needed");
    Result<double, 3> out(tensors.shape(0));
    {
        nb::gil_scoped_release release;
        const double *in = tensors.data(), *floor = floors.data();
        for (std::size_t i = 0; i < out.rows; ++i) {
            store(out.data + 3 * i, metrics::absolute(load(in + 3 * i), floor[i]));
        }
    }
    return out.numpy();
}

auto reduce(Tensors s, Tensors t) {
    require(s.shape(0) == t.shape(0), "as many tensors are needed on both sides");
    Result<double, 2> values(s.shape(0));
    Result<double, 4> vectors(s.shape(0));
    {
        nb::gil_scoped_release release;
        for (std::size_t i = 0; i < values.rows; ++i) {
            const metrics::Reduction r(load(s.data() + 3 * i), load(t.data() + 3 * i));
            const metrics::Direction low = r.basis_low(), high = r.basis_high();
            double *value = values.data + 2 * i, *vector = vectors.data + 4 * i;
            value[0] = r.low, value[1] = r.high;
            vector[0] = low.x, vector[1] = high.x;
            vector[2] = low.y, vector[3] = high.y;
        }
    }
    return std::make_pair(values.numpy(), vectors.numpy());
}

// Of each vector in its own tensor.
auto lengths_in(Tensors tensors, Points vectors) {
    require(tensors.shape(0) == vectors.shape(0), "one tensor for each vector is needed");
    Result<double> out(tensors.shape(0));
    {
        nb::gil_scoped_release release;
        const double *m = tensors.data(), *v = vectors.data();
        for (std::size_t i = 0; i < out.rows; ++i) {
            out.data[i] = metrics::exact_length(load(m + 3 * i), v[2 * i], v[2 * i + 1]);
        }
    }
    return out.numpy();
}

auto lengths(Tensors s, Tensors t, Points edges) {
    require(s.shape(0) == t.shape(0) && s.shape(0) == edges.shape(0),
            "one tensor at each end of each edge is needed");
    Result<double> out(s.shape(0));
    {
        nb::gil_scoped_release release;
        const double *start = s.data(), *end = t.data(), *e = edges.data();
        for (std::size_t i = 0; i < out.rows; ++i) {
            out.data[i] = metrics::exact_length(load(start + 3 * i), load(end + 3 * i), e[2 * i],
                                                e[2 * i + 1]);
        }
    }
    return out.numpy();
}

auto dets(Tensors tensors) {
    Result<double> out(tensors.shape(0));
    {
        nb::gil_scoped_release release;
        const double* in = tensors.data();
        for (std::size_t i = 0; i < out.rows; ++i) out.data[i] = metrics::det(load(in + 3 * i));
    }
    return out.numpy();
}

auto spectra(Tensors tensors) {
    Result<double, 2> values(tensors.shape(0));
    Result<double, 2> direction(tensors.shape(0));
    {
        nb::gil_scoped_release release;
        const double* in = tensors.data();
        for (std::size_t i = 0; i < values.rows; ++i) {
            const metrics::Spectrum s = metrics::spectrum(load(in + 3 * i));
            values.data[2 * i] = s.low, values.data[2 * i + 1] = s.high;
            direction.data[2 * i] = s.x, direction.data[2 * i + 1] = s.y;
        }
    }
    return std::make_pair(values.numpy(), direction.numpy());
}

auto evaluate(const metrics::Background& background, Points points, std::optional<Indices> hints) {
    const std::size_t n = points.shape(0);
    require(!hints || hints->shape(0) == n, "one hint for each point is needed");
    Result<double, 3> tensors(n);
    Result<double> outside(n);
    Result<Index> triangles(n);
    {
        nb::gil_scoped_release release;
        const double* p = points.data();
        const Index* hint = hints ? hints->data() : nullptr;
        for (std::size_t i = 0; i < n; ++i) {
            const metrics::Location place =
                background.locate(p[2 * i], p[2 * i + 1], hint ? hint[i] : -1);
            store(tensors.data + 3 * i, background.value(place));
            triangles.data[i] = place.triangle;
            outside.data[i] = place.outside;
        }
    }
    return std::make_tuple(tensors.numpy(), triangles.numpy(), outside.numpy());
}

void construct(metrics::Background* self, Points points, Tensors logs, Triangles triangles) {
    require(points.shape(0) == logs.shape(0), "one tensor for each point is needed");
    nb::gil_scoped_release release;
    new (self) metrics::Background(points.data(), logs.data(), points.shape(0), triangles.data(),
                                   triangles.shape(0));
}

}  // namespace

NB_MODULE(_core, m) {
    m.doc() =
        "The compiled core of metrics. Arrays are contiguous, (n, 3) tensors are packed "
        "(m11, m12, m22). The check functions return (packed copy, index of the first item that is "
        "not a metric or -1), or that index alone.";
    m.def("check_sizes", &check_sizes, "sizes"_a);
    m.def("check_tensors", &check_tensors, "tensors"_a);
    m.def("check_matrices", &check_matrices, "matrices"_a, "asymmetry"_a);
    m.def("check_triangles", &check_triangles, "points"_a, "triangles"_a);

    m.def("log", [](Tensors t) { return map_tensors(t, metrics::log_tensor); }, "tensors"_a);
    m.def("exp", [](Tensors t) { return map_tensors(t, metrics::exp_tensor); }, "tensors"_a);
    m.def(
        "power",
        [](Tensors t, double exponent) {
            return map_tensors(t, [=](Tensor s) { return metrics::power(s, exponent); });
        },
        "tensors"_a, "exponent"_a);
    m.def(
        "limited",
        [](Tensors t, double low, double high, double ratio) {
            return map_tensors(t, [=](Tensor s) { return metrics::limited(s, low, high, ratio); });
        },
        "tensors"_a, "low"_a, "high"_a, "ratio"_a,
        "Eigenvalues brought into [low, high], then the smaller to at least the larger / ratio.");
    m.def("absolute", &absolute, "tensors"_a, "floors"_a);
    m.def("det", &dets, "tensors"_a);
    m.def("spectra", &spectra, "tensors"_a,
          "Eigenvalues (n, 2) ascending, unit eigenvector (n, 2) of the larger.");
    m.def("intersect", [](Tensors s, Tensors t) { return combine(s, t, metrics::intersect); });
    m.def("unite", [](Tensors s, Tensors t) { return combine(s, t, metrics::unite); });
    m.def("reduce", &reduce, "first"_a, "second"_a,
          "Eigenvalues (n, 2) of second relative to first, ascending; basis (n, 4), row by row.");
    m.def("geometric_mean",
          [](Tensors s, Tensors t) { return combine(s, t, metrics::geometric_mean); });
    m.def("hypot", [](Tensors s, Tensors t) { return combine(s, t, metrics::hypot); });
    m.def("lengths", &lengths, "at_start"_a, "at_end"_a, "edges"_a);
    m.def("lengths_in", &lengths_in, "tensors"_a, "vectors"_a);

    nb::class_<metrics::Background>(m, "Background")
        .def("__init__", &construct, "points"_a, "logs"_a, "triangles"_a)
        .def_prop_ro("diagonal", &metrics::Background::diagonal)
        .def("evaluate", &evaluate, "points"_a, "hints"_a = nb::none(),
             "Metrics (n, 3), triangles (n,), distances from the mesh (n,).");

    bind_segments(m);
    bind_nodal(m);
}
