// The module adaptmesh._core: arrays in, arrays out. One file per part of the core binds that part.
#include <nanobind/nanobind.h>

namespace nb = nanobind;

void bind_predicates(nb::module_& m);
void bind_triangulate(nb::module_& m);
void bind_sampler(nb::module_& m);
void bind_generate(nb::module_& m);
void bind_edit(nb::module_& m);
void bind_transfer(nb::module_& m);
void bind_outlines(nb::module_& m);
void bind_validate(nb::module_& m);

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
