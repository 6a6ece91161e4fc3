#include "adaptmesh/core/bindings.hpp"

void bind_mesher(nb::module_&) {}
