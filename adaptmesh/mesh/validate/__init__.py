"""The invariants of a mesh, one function each; `adaptmesh.validate` runs them."""
