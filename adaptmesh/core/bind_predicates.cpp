#include "adaptmesh/core/bindings.hpp"

void bind_predicates(nb::module_&) {}
