// Segments and what spreads from them, for Python.
#include "metrics/core/bindings.hpp"
#include "metrics/core/segments.hpp"

using namespace nb::literals;

namespace {

using Ends = nb::ndarray<const double, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu>;
using EndSizes = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;

void construct_segments(metrics::Segments* self, Ends ends) {
    require(ends.shape(0) > 0, "at least one segment is needed");
    nb::gil_scoped_release release;
    new (self) metrics::Segments(ends.data(), ends.shape(0));
}

nb::tuple nearest(const metrics::Segments& segments, Points points) {
    const std::size_t n = points.shape(0);
    Result<Index> number(n);
    Result<double> share(n), foot(n, 2);
    {
        nb::gil_scoped_release release;
        const double* p = points.data();
        for (std::size_t i = 0; i < n; ++i) {
            const metrics::OnSegment place = segments.nearest(p[2 * i], p[2 * i + 1]);
            number.data[i] = place.segment, share.data[i] = place.share;
            foot.data[2 * i] = place.x, foot.data[2 * i + 1] = place.y;
        }
    }
    return nb::make_tuple(number.numpy(), share.numpy(), foot.numpy());
}

nb::object encloses(const metrics::Segments& segments, Points points) {
    Result<bool> out(points.shape(0));
    {
        nb::gil_scoped_release release;
        const double* p = points.data();
        for (std::size_t i = 0; i < out.rows; ++i) {
            out.data[i] = segments.encloses(p[2 * i], p[2 * i + 1]);
        }
    }
    return out.numpy();
}

void construct_spreading(metrics::Spreading* self, const metrics::Segments& segments,
                         EndSizes sizes, double growth) {
    require(sizes.shape(0) == segments.size(), "sizes at both ends of each segment are needed");
    nb::gil_scoped_release release;
    new (self) metrics::Spreading(segments, sizes.data(), growth);
}

nb::object spread(const metrics::Spreading& spreading, Points points) {
    Result<double> out(points.shape(0));
    {
        nb::gil_scoped_release release;
        const double* p = points.data();
        for (std::size_t i = 0; i < out.rows; ++i) {
            out.data[i] = spreading.at(p[2 * i], p[2 * i + 1]);
        }
    }
    return out.numpy();
}

}  // namespace

void bind_segments(nb::module_& m) {
    nb::class_<metrics::Segments>(m, "Segments")
        .def("__init__", &construct_segments, "ends"_a)
        .def("nearest", &nearest, "points"_a,
             "Segments (n,), shares of the way along them (n,), nearest points (n, 2).")
        .def("encloses", &encloses, "points"_a, "Whether points are inside closed rings, (n,).");
    nb::class_<metrics::Spreading>(m, "Spreading")
        .def("__init__", &construct_spreading, "segments"_a, "sizes"_a, "growth"_a)
        .def("at", &spread, "points"_a, "Sizes (n,).");
}
