// The module adaptmesh._core: arrays in, arrays out. One file per part of the core binds that part.
#include "adaptmesh/core/bindings.hpp"

NB_MODULE(_core, m) {
    m.doc() = "The compiled core of adaptmesh: predicates, triangulation, mesher.";
    bind_predicates(m);
    bind_triangulate(m);
    bind_sampler(m);
    bind_generate(m);
    bind_edit(m);
    bind_transfer(m);
    bind_outlines(m);
    bind_validate(m);
}
