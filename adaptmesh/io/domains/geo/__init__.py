"""Gmsh's .geo scripts: the points, curves, surfaces and physical groups that describe a domain."""

from .model import read_geo

__all__ = ["read_geo"]
