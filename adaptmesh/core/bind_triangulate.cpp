#include "adaptmesh/core/bindings.hpp"

void bind_triangulate(nb::module_&) {}
