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

#include "adaptmesh/core/constrain.hpp"
#include "adaptmesh/core/point.hpp"
#include "metrics/core/tensor.hpp"

namespace nb = nanobind;

void bind_predicates(nb::module_& m);
void bind_triangulate(nb::module_& m);
void bind_sampler(nb::module_& m);
void bind_mesher(nb::module_& m);
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

inline metrics::Tensor tensor_in(const Tensors& array, std::size_t i) {
    return {array(i, 0), array(i, 1), array(i, 2)};
}

inline void expect_rows(std::size_t got, std::size_t wanted, const char* what) {
    if (got != wanted) {
        throw nb::value_error((std::string(what) + ": " + std::to_string(got) + " rows, expected " +
                               std::to_string(wanted))
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

// Called often by the long loops of the core (which run without the GIL): lets Ctrl-C through.
class SignalPoll {
  public:
    void operator()() {
        const auto now = std::chrono::steady_clock::now();
        if (now - last_ < std::chrono::milliseconds(100)) return;
        last_ = now;
        nb::gil_scoped_acquire gil;
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};
