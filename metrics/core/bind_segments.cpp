// Segments and what spreads from them, for Python.
#include <tuple>
#include <vector>

#include "metrics/core/bindings.hpp"
#include "metrics/core/segments.hpp"

using namespace nb::literals;

namespace {

using Ends = nb::ndarray<const double, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu>;
using Numbers = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using EndSizes = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;

// Calls visit(i, x, y) for all points, neighbours one soon after the other, so that what was found
// for one is a good hint for the next.
template <typename Visit>
void in_curve_order(const Points& points, Visit visit) {
    const double* p = points.data();
    std::vector<metrics::Box> boxes(points.shape(0));
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].include(p[2 * i], p[2 * i + 1]);
    for (std::int32_t i : metrics::curve_order(boxes))
        visit(std::size_t(i), p[2 * i], p[2 * i + 1]);
}

void construct_segments(metrics::Segments* self, Ends ends) {
    require(ends.shape(0) > 0, "at least one segment is needed");
    nb::gil_scoped_release release;
    new (self) metrics::Segments(ends.data(), ends.shape(0));
}

auto nearest(const metrics::Segments& segments, Points points) {
    const std::size_t n = points.shape(0);
    Result<Index> number(n);
    Result<double> share(n);
    Result<double, 2> foot(n);
    {
        nb::gil_scoped_release release;
        Index hint = -1;
        in_curve_order(points, [&](std::size_t i, double x, double y) {
            const metrics::OnSegment place = segments.nearest(x, y, hint);
            number.data[i] = hint = place.segment, share.data[i] = place.share;
            foot.data[2 * i] = place.x, foot.data[2 * i + 1] = place.y;
        });
    }
    return std::make_tuple(number.numpy(), share.numpy(), foot.numpy());
}

void prepare_rings(metrics::Segments& segments, Numbers left) {
    require(left.shape(0) == segments.size(), "a number for each segment is needed");
    nb::gil_scoped_release release;
    segments.prepare_rings(left.data());
}

auto encloses(const metrics::Segments& segments, Points points) {
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

auto spread(const metrics::Spreading& spreading, Points points) {
    Result<double> out(points.shape(0));
    {
        nb::gil_scoped_release release;
        Index hint = -1;
        in_curve_order(points, [&](std::size_t i, double x, double y) {
            std::tie(out.data[i], hint) = spreading.at(x, y, hint);
        });
    }
    return out.numpy();
}

}  // namespace

void bind_segments(nb::module_& m) {
    nb::class_<metrics::Segments>(m, "Segments")
        .def("__init__", &construct_segments, "ends"_a)
        .def("nearest", &nearest, "points"_a,
             "Segments (n,), shares of the way along them (n,), nearest points (n, 2).")
        .def("prepare_rings", &prepare_rings, "left"_a,
             "Before `encloses`: the lowest x of the ring of each segment, (n,).")
        .def("encloses", &encloses, "points"_a, "Whether points are inside closed rings, (n,).");
    nb::class_<metrics::Spreading>(m, "Spreading")
        .def("__init__", &construct_spreading, "segments"_a, "sizes"_a, "growth"_a)
        .def("at", &spread, "points"_a, "Sizes (n,).");
}
