"""Gmsh's .geo scripts: the points, curves, surfaces and physical groups that describe a domain."""

from .model import read_geo
from .plane_model import PlaneModel, samples_of

__all__ = ["PlaneModel", "read_geo", "samples_of"]
