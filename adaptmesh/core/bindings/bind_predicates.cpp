// The predicates over arrays: for tests, and for Python code that needs an exact answer.
#include <cmath>
#include <stdexcept>
#include <string>

#include "adaptmesh/core/bindings/arrays.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"

namespace {

using adaptmesh::Point;

struct Argument {
    const char* name;
    const Points& array;

    Point operator[](std::size_t i) const { return {array(i, 0), array(i, 1)}; }
};

void check_point(const Argument& argument, std::size_t i) {
    const Point p = argument[i];
    if (std::isfinite(p.x) && std::isfinite(p.y)) return;
    throw std::invalid_argument(std::string(argument.name) + "[" + std::to_string(i) + "] = (" +
                                std::to_string(p.x) + ", " + std::to_string(p.y) +
                                ") is not finite; the predicates need finite coordinates.");
}

void check_length(const Argument& argument, const Argument& first) {
    const std::size_t n = argument.array.shape(0), expected = first.array.shape(0);
    if (n == expected) return;
    throw std::invalid_argument(std::string(argument.name) + " has " + std::to_string(n) +
                                " points but " + first.name + " has " + std::to_string(expected) +
                                "; pass arrays of equal length.");
}

// predicate(first[i], others[i]...) for all i.
template <typename Predicate, typename... Arguments>
auto over_arrays(Predicate predicate, const Argument& first, const Arguments&... others) {
    (check_length(others, first), ...);
    std::vector<std::int8_t> signs(first.array.shape(0));
    {
        nb::gil_scoped_release release;
        for (std::size_t i = 0; i < signs.size(); ++i) {
            check_point(first, i);
            (check_point(others, i), ...);
            signs[i] = std::int8_t(predicate(first[i], others[i]...));
        }
    }
    return column(std::move(signs));
}

auto orient2d(const Points& a, const Points& b, const Points& c) {
    return over_arrays(adaptmesh::orient2d, Argument{"a", a}, Argument{"b", b}, Argument{"c", c});
}

auto incircle(const Points& a, const Points& b, const Points& c, const Points& d) {
    return over_arrays(adaptmesh::incircle, Argument{"a", a}, Argument{"b", b}, Argument{"c", c},
                       Argument{"d", d});
}

}  // namespace

void bind_predicates(nb::module_& m) {
    m.def("orient2d", &orient2d, nb::arg("a"), nb::arg("b"), nb::arg("c"),
          R"(Exact orientation of the triangles abc.

Parameters
----------
a, b, c : (n, 2) float64 arrays
    Finite coordinates, of any magnitude.

Returns
-------
(n,) int8 array
    1 counter-clockwise, -1 clockwise, 0 exactly on one line.

Raises
------
ValueError
    If the lengths differ or a coordinate is not finite.
)");
    m.def("incircle", &incircle, nb::arg("a"), nb::arg("b"), nb::arg("c"), nb::arg("d"),
          R"(Whether d lies in the circle through abc, exactly.

Parameters
----------
a, b, c, d : (n, 2) float64 arrays
    Finite coordinates, of any magnitude.

Returns
-------
(n,) int8 array
    For abc counter-clockwise: 1 if d is strictly inside, 0 exactly on the circle, -1 outside;
    the opposite signs for abc clockwise. For abc on one line, the sign of the same determinant.

Raises
------
ValueError
    If the lengths differ or a coordinate is not finite.
)");
}
