"""Drawings as domains: the lines of vector graphics and of CAD, as curves with names."""

from .drawing import Drawing
from .dxf import read_dxf
from .svg import read_svg

__all__ = ["Drawing", "read_dxf", "read_svg"]
