"""Meshes and their fields in files.

=================  ==============================================================================
``.vtu``           VTK XML, for ParaView and pyvista; keeps everything as it is
``.vtk``           the same in VTK's legacy format, binary (or text)
``.msh``           Gmsh, version 4.1 (or 2.2), binary (or text); names are physical groups
``.mesh .meshb``   Medit, for Mmg, BAMG, FreeFEM; metric and fields in ``.sol``, ``.solb`` beside it
``.ele``           Triangle, with ``.node`` and ``.poly`` beside it; names are in comments
``.xdmf .xmf``     for DOLFIN, FEniCSx, ParaView; keeps everything, its arrays in ``.h5`` beside it
others             by way of meshio: Abaqus, Nastran, SU2, MED, Netgen, Exodus, Tecplot, ...; what
                   they cannot hold is said by a `FormatWarning`
=================  ==============================================================================

From our own formats, points, triangles, regions, constrained edges with their tags, and the names
of both come back as they were, points bit for bit. A file is written whole or not at all.
"""

from .formats import FORMATS, Format
from .metric import read_metric
from .read import read, read_fields
from .solutions import read_sol, write_sol
from .write import write

__all__ = [
    "FORMATS",
    "Format",
    "read",
    "read_fields",
    "read_metric",
    "read_sol",
    "write",
    "write_sol",
]
