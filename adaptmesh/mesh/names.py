"""Names for constrained edges of a mesh, chosen by where they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import ByLabel
from adaptmesh.domain.named_sides import renamed_tags, tags_of_sides
from adaptmesh.domain.naming import Chosen, SideSamples, split_names, straight_sides
from adaptmesh.errors import DomainError
from adaptmesh.topology import edge_keys, triangles_beside
from adaptmesh.types import Ints

from .boundary_polylines import find_polylines
from .data import M, MeshData
from .to_domain import with_interfaces


def mesh_with_names(mesh: M, names: ByLabel[Chosen]) -> M:
    """As `Mesh.with_names`."""
    if mesh.domain is not None:
        return _as_its_domain(mesh, names)
    edges, old = with_interfaces(mesh) if len(mesh.triangles) else (mesh.edges, mesh.edge_tags)
    sides = _sides_of_edges(mesh, edges)
    numbers, tags = renamed_tags(names, sides, old, mesh.names, "edge")
    return replace(mesh, edges=edges, edge_tags=tags, names=numbers)


def _sides_of_edges(mesh: MeshData, edges: Ints) -> SideSamples:
    left, right = triangles_beside(mesh.triangles, edges, len(mesh.points))
    ends = mesh.points[edges]
    d = ends[:, 1] - ends[:, 0]
    to_right = np.stack([d[:, 1], -d[:, 0]], axis=1) / np.hypot(*d.T)[:, None]
    border = (left < 0) != (right < 0)
    sign = np.where(border, np.where(right < 0, 1.0, -1.0), np.nan)

    def describe(i: int) -> str:
        (x, y), (u, v) = ends[i].tolist()
        return f"edge {i} from ({x:g}, {y:g}) to ({u:g}, {v:g})"

    return straight_sides(ends, sign[:, None] * to_right, describe)


def _as_its_domain(mesh: M, names: ByLabel[Chosen]) -> M:
    """The domain gets the names, and the edges along its lines those of the lines."""
    domain = mesh.domain
    assert domain is not None
    given, selectors = split_names(names)
    numbered = [name for name in given if name not in selectors]
    if numbered:
        raise DomainError(
            f"name {numbered[0]!r} is given to numbers, but the mesh has a domain: name its sides, "
            "mesh.domain.with_names, and mesh it"
        )
    named = domain.with_names(names)
    polylines = find_polylines(mesh, domain)
    if polylines is None:
        raise DomainError(
            "the constrained edges of the mesh are not along the lines of its domain: leave the "
            "domain out, dataclasses.replace(mesh, domain=None)"
        )
    tag_of = _tags_of_sides(domain, named)
    n = len(mesh.points)
    keys = edge_keys(polylines.edges, n)
    order = np.argsort(keys)
    asked = edge_keys(mesh.edges, n)
    found = order[np.searchsorted(keys, asked, sorter=order)]
    tags = tag_of[polylines.edge_sides[found]]
    return replace(mesh, edge_tags=tags, names=named.names, domain=named)


def _tags_of_sides(domain: Domain, named: Domain) -> Ints:
    """The new tag of each side; a path of several curves has to have one."""
    if not domain.curved.curves:
        return named.all_sides.tags
    of_curve = tags_of_sides(named)
    out = of_curve[domain.curved.segment_curves[domain.all_sides.segments]]
    for path in domain.curved.paths:
        found = np.unique(of_curve[list(path.curves)])
        if len(found) > 1:
            a, b = path.curves[0], path.curves[-1]
            raise DomainError(
                f"curves {a} to {b} are one smooth line of the mesh, which has no vertex where the "
                "name changes: give names to the domain, and mesh it"
            )
    return out
