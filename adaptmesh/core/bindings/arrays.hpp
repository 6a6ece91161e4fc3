// Arrays of Python in, arrays of NumPy out.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"
#include "metrics/core/tensor.hpp"

namespace nb = nanobind;

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

// Numpy arrays that own their numbers: (n,), and (n, COLUMNS).
template <typename T>
using Column = nb::ndarray<nb::numpy, T, nb::ndim<1>, nb::c_contig>;
template <typename T, int COLUMNS>
using Rows = nb::ndarray<nb::numpy, T, nb::shape<-1, COLUMNS>, nb::c_contig>;
template <typename T>
using Table = nb::ndarray<nb::numpy, T, nb::ndim<2>, nb::c_contig>;

// A numpy array of this type; the values are not copied.
template <typename Array, typename T>
Array to_numpy(std::vector<T>&& values, std::initializer_list<std::size_t> shape) {
    auto* kept = new std::vector<T>(std::move(values));
    nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return Array(kept->data(), shape.size(), shape.begin(), owner);
}
template <typename T>
Column<T> column(std::vector<T>&& values) {
    const std::size_t n = values.size();
    return to_numpy<Column<T>>(std::move(values), {n});
}
template <int COLUMNS, typename T>
Rows<T, COLUMNS> rows(std::vector<T>&& values) {
    const std::size_t n = values.size() / COLUMNS;
    return to_numpy<Rows<T, COLUMNS>>(std::move(values), {n, std::size_t(COLUMNS)});
}
inline Column<bool> flags(std::vector<std::uint8_t>&& values) {
    static_assert(sizeof(bool) == 1);
    const std::size_t n = values.size();
    return to_numpy<Column<bool>>(std::move(values), {n});
}

// A copy of points.
inline Rows<double, 2> rows(const std::vector<adaptmesh::Point>& points) {
    std::vector<double> flat;
    flat.reserve(2 * points.size());
    for (adaptmesh::Point p : points) flat.push_back(p.x), flat.push_back(p.y);
    return rows<2>(std::move(flat));
}
