"""Adaptive anisotropic meshing of planar domains governed by a metric field."""
