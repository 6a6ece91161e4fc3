"""The domain that a mesh covers, read back from its constrained edges."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator

import numpy as np

from adaptmesh.checks import check_range
from adaptmesh.curves import Curve
from adaptmesh.domain.data import DomainData, with_fields
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import labelled
from adaptmesh.domain.periodic_corners import domain_with_pair
from adaptmesh.errors import DomainError
from adaptmesh.mesh.validate.subject import Finding, Subject
from adaptmesh.topology import edge_keys, regions_beside
from adaptmesh.types import Bools, Ints

from .cleaned import with_edges_once
from .data import MeshData
from .fit_curves import smooth_curves
from .seeds import hole_points, region_points
from .straight_sides import Straightness, needed_corners
from .validate import local


def domain_of_mesh(
    mesh: MeshData, corner_angle: float | None = None, straight_tolerance: float | None = None
) -> Domain:
    """Corners, segments, holes, regions and names of a mesh.

    Chains of constrained edges with one name, between the same two regions, become one segment
    where they are straight, to a tolerance; vertices on them are dropped. Curved boundaries stay as
    the mesh has them, or become the curves of `smooth_curves`. Required vertices stay points, and
    required edges frozen segments.

    The tolerance found from the digits of the coordinates is not used where it makes what is no
    domain, such as sides that are nearer to each other than that.
    """
    mesh = with_edges_once(mesh)
    if not len(mesh.triangles):
        raise DomainError("the mesh has no triangles, so it covers no domain")
    _refuse_what_is_no_mesh(mesh)
    edges, tags = with_interfaces(mesh)
    if straight_tolerance is not None:
        straight = Straightness.given(straight_tolerance)
        return _domain(mesh, edges, tags, corner_angle, straight)
    straight = Straightness.of(mesh.points, edges)
    exact = Straightness.exact(mesh.points)
    if straight.tolerance > exact.tolerance:
        try:
            return _domain(mesh, edges, tags, corner_angle, straight)
        except DomainError:
            pass
    return _domain(mesh, edges, tags, corner_angle, exact)


def _domain(
    mesh: MeshData, edges: Ints, tags: Ints, corner_angle: float | None, straight: Straightness
) -> Domain:
    """The domain inside these edges, whose border is straight to a tolerance."""
    segments, segment_edges = [], []  # the latter: one of the edges on each
    curves: list[Curve] = []
    curve_edges: list[int] = []
    is_required = np.zeros(len(edges), bool)
    is_required[mesh.required_edges] = True
    is_stop = np.zeros(len(mesh.points), bool)
    is_stop[mesh.required_points] = is_stop[edges[is_required]] = True
    degree = np.bincount(edges.ravel())
    tolerance = straight.tolerance
    beside = regions_beside(mesh.triangles, mesh.regions, edges, len(mesh.points))
    for chain, edge in _chains(edges, tags, np.sort(beside, axis=1), is_stop):
        is_ring = chain[0] == chain[-1] and degree[chain[0]] == 2 and not is_stop[chain[0]]
        corners = needed_corners(mesh.points, chain, is_ring, tolerance)
        segments += list(itertools.pairwise(corners))
        segment_edges += [edge] * (len(corners) - 1)
        if corner_angle is not None:
            smooth = smooth_curves(mesh.points, chain, corners, corner_angle, is_ring, tolerance)
            curves += smooth
            curve_edges += [edge] * len(smooth)

    used, renumbered = np.unique(np.array(segments), return_inverse=True)
    points, pairs = mesh.points[used], renumbered.reshape(-1, 2).astype(np.int32)
    holes, regions = hole_points(mesh, points, pairs), region_points(mesh, edges)
    lone = mesh.points[np.setdiff1d(np.intersect1d(mesh.required_points, mesh.triangles), edges)]
    if corner_angle is None:
        points = np.concatenate([points, lone])
        names = labelled(tags[segment_edges])
        domain = Domain(points, pairs, holes, regions, names, mesh.names, mesh.region_names)
        frozen = is_required[segment_edges]
    else:
        domain = Domain.from_curves(
            curves,
            names=labelled(tags[curve_edges]),
            holes=holes,
            regions=regions,
            tags=mesh.names,
            region_tags=mesh.region_names,
            points=lone,
            corner_angle=0.0,  # every end of these curves is a corner
        )
        frozen = is_required[curve_edges][domain.curved.segment_curves]
    found = straight.found(len(used), len(np.unique(edges)))
    data: DomainData = with_fields(domain, corners_found=found)
    for sides in mesh.periodic:
        data = domain_with_pair(data, sides.first, sides.second, sides.motion, None)
    domain = Domain.of_data(data)
    return domain.with_frozen(segments=np.flatnonzero(frozen)) if frozen.any() else domain


def _refuse_what_is_no_mesh(mesh: MeshData) -> None:
    """Refuse triangles and edges that are not what the rest takes them for."""
    subject = Subject(mesh)
    _refuse_if_found(subject, local.finite_points, local.indices_in_range)
    check_range(mesh.points, "vertex")
    clockwise = np.flatnonzero(mesh.areas < 0)
    if len(clockwise):
        i = int(clockwise[0])
        raise DomainError(
            f"triangle {i}, {mesh.triangles[i].tolist()}, is clockwise ({len(clockwise)} of "
            f"{len(mesh.triangles)} are): turn them, triangles[:, ::-1]"
        )
    used = np.unique(mesh.triangles)
    order = used[np.lexsort(mesh.points[used].T)]
    same = np.flatnonzero((mesh.points[order[1:]] == mesh.points[order[:-1]]).all(axis=1))
    if len(same):
        i, j = sorted(order[same[0] : same[0] + 2].tolist())
        x, y = mesh.points[i].tolist()
        raise DomainError(
            f"vertices {i} and {j} of the mesh are the same, ({x:.17g}, {y:.17g}): "
            "make them one, mesh.cleaned(merge=0.0)"
        )
    _refuse_if_found(
        subject,
        local.positive_triangles,
        local.two_triangles_an_edge,
        local.same_orientation,
        local.constrained_are_edges,
    )


def _refuse_if_found(subject: Subject, *looks: Callable[[Subject], Finding]) -> None:
    for look in looks:
        found = look(subject)
        if found.broken:
            raise DomainError(
                f"the mesh covers no domain: {found.note}; {found.offenders[0]}; its validate() "
                "lists what is wrong"
            )


def with_interfaces(mesh: MeshData) -> tuple[Ints, Ints]:
    """The constrained edges and their tags; then, with tag 0, what else bounds or parts regions."""
    edges = mesh.unique_edges
    n = len(mesh.points)
    sides = regions_beside(mesh.triangles, mesh.regions, edges, n)
    known = edge_keys(mesh.edges, n)
    parting = sides[:, 0] != sides[:, 1]
    parting &= ~np.isin(edge_keys(edges, n), known)
    missing = edges[parting]
    return (
        np.concatenate([mesh.edges, missing]),
        np.concatenate([mesh.edge_tags, np.zeros(len(missing), np.int32)]),
    )


def _chains(
    edges: Ints, tags: Ints, sides: Ints, is_stop: Bools
) -> Iterator[tuple[list[int], int]]:
    """Walk the edges in chains of vertices along which the tag and the sides stay the same.

    Each comes with the number of one of its edges. A chain ends at a stop, and where its vertex has
    not exactly two such edges; a closed one starts and ends at its lowest vertex number.
    """
    at: dict[int, list[int]] = {}
    for e, (a, b) in enumerate(edges.tolist()):
        at.setdefault(a, []).append(e)
        at.setdefault(b, []).append(e)
    kind = [(int(t), int(s[0]), int(s[1])) for t, s in zip(tags, sides, strict=True)]

    def passes(v: int) -> bool:
        return len(at[v]) == 2 and kind[at[v][0]] == kind[at[v][1]] and not is_stop[v]

    pairs = edges.tolist()
    walked = [False] * len(pairs)
    # Open chains start at their ends; what is left then is closed and may start anywhere.
    for start in [*(v for v in sorted(at) if not passes(v)), *sorted(at)]:
        for first in at[start]:
            if walked[first]:
                continue
            chain, e = [start], first
            while True:
                walked[e] = True
                a, b = pairs[e]
                chain.append(b if chain[-1] == a else a)
                if chain[-1] == start or not passes(chain[-1]):
                    break
                e = next(other for other in at[chain[-1]] if other != e)
            yield chain, first
