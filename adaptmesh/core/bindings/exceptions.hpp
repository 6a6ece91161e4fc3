// Errors of the core as exceptions of Python.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <string>

namespace nb = nanobind;

// A new class of exceptions in a module. It is never released: it must outlive the interpreter's
// last exception.
inline PyObject* new_exception(nb::module_& m, const char* name, const char* doc) {
    const std::string full_name = nb::cast<std::string>(m.attr("__name__")) + "." + name;
    PyObject* const type = PyErr_NewExceptionWithDoc(full_name.c_str(), doc, nullptr, nullptr);
    m.attr(name) = nb::handle(type);
    return type;
}
