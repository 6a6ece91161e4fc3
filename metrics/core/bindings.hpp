// What the binding files share.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <utility>

namespace nb = nanobind;

void bind_segments(nb::module_& m);
void bind_nodal(nb::module_& m);

// Arrays as the Python side hands them over: C-contiguous, right type.
using Index = std::int32_t;
using Values = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Points = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Tensors = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Matrices = nb::ndarray<const double, nb::shape<-1, 2, 2>, nb::c_contig, nb::device::cpu>;
using Triangles = nb::ndarray<const Index, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Indices = nb::ndarray<const Index, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

// A numpy array of n numbers, or with COLUMNS of n rows, in the making: `data` is filled without
// the lock, `numpy` hands it over.
template <typename T, int COLUMNS = 0>
struct Result {
    using Shape = std::conditional_t<COLUMNS == 0, nb::shape<-1>, nb::shape<-1, COLUMNS>>;
    using Array = nb::ndarray<nb::numpy, T, Shape, nb::c_contig>;

    std::size_t rows;
    T* data;
    nb::capsule owner;

    explicit Result(std::size_t rows)
        : rows(rows),
          data(new T[rows * (COLUMNS ? COLUMNS : 1)]),
          owner(data, [](void* p) noexcept { delete[] static_cast<T*>(p); }) {}

    Array numpy() const {
        const std::size_t shape[2] = {rows, COLUMNS};
        return Array(data, COLUMNS ? 2 : 1, shape, owner);
    }
};

inline void require(bool condition, const char* message) {
    if (!condition) throw std::invalid_argument(message);
}
