// What the binding files share.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>

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

// A numpy array in the making: `data` is filled without the lock, `numpy` hands it over.
template <typename T>
struct Result {
    std::size_t rows, columns;  // columns 0: a one-dimensional array
    T* data;
    nb::capsule owner;

    explicit Result(std::size_t rows, std::size_t columns = 0)
        : rows(rows),
          columns(columns),
          data(new T[rows * (columns ? columns : 1)]),
          owner(data, [](void* p) noexcept { delete[] static_cast<T*>(p); }) {}

    nb::object numpy() const {
        const std::size_t shape[2] = {rows, columns};
        return nb::cast(nb::ndarray<nb::numpy, T>(data, columns ? 2 : 1, shape, owner));
    }
};

inline void require(bool condition, const char* message) {
    if (!condition) throw std::invalid_argument(message);
}
