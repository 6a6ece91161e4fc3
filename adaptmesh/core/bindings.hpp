// What the binding files share.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "adaptmesh/core/metric_field.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/point.hpp"
#include "adaptmesh/core/segment.hpp"
#include "metrics/core/tensor.hpp"

namespace nb = nanobind;

void bind_predicates(nb::module_& m);
void bind_triangulate(nb::module_& m);
void bind_sampler(nb::module_& m);
void bind_generate(nb::module_& m);
void bind_edit(nb::module_& m);
void bind_transfer(nb::module_& m);
void bind_outlines(nb::module_& m);
void bind_validate(nb::module_& m);

// (n, 2) and (n, 3) arrays as the Python side hands them over: C-contiguous, right type.
using Points = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Tensors = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using IndexPairs = nb::ndarray<const std::int32_t, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using IndexTriples =
    nb::ndarray<const std::int32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Indices = nb::ndarray<const std::int32_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

using Flags = nb::ndarray<const bool, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Values = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

inline std::vector<adaptmesh::Point> to_points(const Points& array) {
    static_assert(sizeof(adaptmesh::Point) == 2 * sizeof(double));
    std::vector<adaptmesh::Point> points(array.shape(0));
    if (!points.empty()) {
        std::memcpy(points.data(), array.data(), points.size() * sizeof(adaptmesh::Point));
    }
    return points;
}

inline std::vector<adaptmesh::Segment> to_segments(const IndexPairs& array) {
    std::vector<adaptmesh::Segment> segments(array.shape(0));
    for (std::size_t i = 0; i < segments.size(); ++i) segments[i] = {array(i, 0), array(i, 1)};
    return segments;
}

inline std::vector<metrics::Tensor> to_tensors(const Tensors& array) {
    static_assert(sizeof(metrics::Tensor) == 3 * sizeof(double));
    std::vector<metrics::Tensor> tensors(array.shape(0));
    if (!tensors.empty()) {
        std::memcpy(tensors.data(), array.data(), tensors.size() * sizeof(metrics::Tensor));
    }
    return tensors;
}

inline std::vector<adaptmesh::Index> to_indices(const Indices& array) {
    return {array.data(), array.data() + array.shape(0)};
}

inline std::vector<char> to_flags(const Flags& array) {
    return {array.data(), array.data() + array.shape(0)};
}

inline void expect_rows(std::size_t got, std::size_t expected, const char* what) {
    if (got != expected) {
        throw nb::value_error((std::string(what) + ": " + std::to_string(got) + " rows, expected " +
                               std::to_string(expected))
                                  .c_str());
    }
}

// A numpy array that owns `values`; no copy.
template <typename T>
nb::object to_numpy(std::vector<T>&& values, std::vector<std::size_t> shape) {
    auto* kept = new std::vector<T>(std::move(values));
    nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, T>(kept->data(), shape.size(), shape.data(), owner));
}

// An (n, 2) array with a copy of the points.
inline nb::object to_numpy(const std::vector<adaptmesh::Point>& points) {
    std::vector<double> flat;
    flat.reserve(2 * points.size());
    for (adaptmesh::Point p : points) flat.push_back(p.x), flat.push_back(p.y);
    return to_numpy(std::move(flat), {points.size(), 2});
}

// (n,) flags.
inline nb::object to_numpy_flags(std::vector<std::uint8_t>&& flags) {
    const std::size_t n = flags.size();
    return to_numpy(std::move(flags), {n}).attr("view")("bool");
}

// A metric of Python: a function of an (n, 2) array that returns (n, 3) packed metrics, which have
// been checked. The core works without the GIL; what the function raises goes through it.
inline adaptmesh::MetricField metric_of(const nb::callable& function) {
    return [&function](const std::vector<adaptmesh::Point>& points,
                       std::vector<metrics::Tensor>& tensors) {
        nb::gil_scoped_acquire gil;
        const auto answer = nb::cast<Tensors>(function(to_numpy(points)));
        expect_rows(answer.shape(0), points.size(), "metrics at points");
        tensors = to_tensors(answer);
    };
}

// Lets Ctrl-C through, and tells a function of Python how far the work is.
class PythonMonitor : public adaptmesh::Monitor {
  public:
    PythonMonitor() = default;
    PythonMonitor(adaptmesh::Index max_vertices, adaptmesh::Index expected_vertices,
                  nb::callable progress)
        : Monitor(max_vertices, expected_vertices), progress_(std::move(progress)) {}

    void report(const char* stage, double fraction) override {
        nb::gil_scoped_acquire gil;
        if (progress_.is_valid()) progress_(stage, fraction);
    }

  protected:
    void stop_if_asked() override {
        const auto now = std::chrono::steady_clock::now();
        if (now - last_ < std::chrono::milliseconds(100)) return;
        last_ = now;
        nb::gil_scoped_acquire gil;
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
    }

  private:
    nb::callable progress_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};
