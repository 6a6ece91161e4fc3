"""Segments made to meet only at their ends, the faces between them, and what was done for it."""

from adaptmesh.geometry.distance import first_of_equal

from .faces import Faces, find_faces
from .noding import Noded, Words, node, used_tolerance
from .record import NOWHERE, Repair, Repairs, at

__all__ = [
    "NOWHERE",
    "Faces",
    "Noded",
    "Repair",
    "Repairs",
    "Words",
    "at",
    "find_faces",
    "first_of_equal",
    "node",
    "used_tolerance",
]
