"""The domain that a mesh covers, read back from its constrained edges."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .curves import Curve
from .domain import Domain
from .domain_input import Label, labelled
from .errors import DomainError
from .invariants import local
from .invariants.subject import Finding, Subject, edge_keys
from .mesh import Mesh
from .smoothed import smooth_curves

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

# Vertices nearer than this share of the extent of the mesh to a straight line lie on it: about what
# rounding and text files of 12 digits leave of a straight boundary.
STRAIGHT = 1e-12

OUTSIDE = -(2**40)  # a number that no region has


def domain_of_mesh(mesh: Mesh, corner_angle: float | None = None) -> Domain:
    """Corners, segments, holes, regions and names of a mesh.

    Chains of constrained edges with one name, between the same two regions, become one segment
    where they are straight (to `STRAIGHT` of the extent); vertices on them are dropped. Curved
    boundaries stay as the mesh has them, or become the curves of `smooth_curves`. Required vertices
    stay points, and required edges frozen segments.
    """
    check_is_mesh(mesh)
    if not len(mesh.triangles):
        raise DomainError("the mesh has no triangles, so it covers no domain")
    _refuse_what_is_no_mesh(mesh)
    edges, tags = with_interfaces(mesh)
    segments, segment_edges = [], []  # the latter: one of the edges on each
    curves: list[Curve] = []
    curve_edges: list[int] = []
    is_required = np.zeros(len(edges), bool)
    is_required[mesh.required_edges] = True
    is_stop = np.zeros(len(mesh.points), bool)
    is_stop[mesh.required_points] = is_stop[edges[is_required]] = True
    degree = np.bincount(edges.ravel())
    tolerance = STRAIGHT * float(np.ptp(mesh.points, axis=0).max())
    beside = regions_beside(mesh.triangles, mesh.regions, edges, len(mesh.points))
    for chain, edge in _chains(edges, tags, np.sort(beside, axis=1), is_stop):
        is_ring = chain[0] == chain[-1] and degree[chain[0]] == 2 and not is_stop[chain[0]]
        corners = _corners(mesh.points, chain, is_ring, tolerance)
        segments += list(itertools.pairwise(corners))
        segment_edges += [edge] * (len(corners) - 1)
        if corner_angle is not None:
            smooth = smooth_curves(mesh.points, chain, corners, corner_angle, is_ring)
            curves += smooth
            curve_edges += [edge] * len(smooth)

    used, renumbered = np.unique(np.array(segments), return_inverse=True)
    points, pairs = mesh.points[used], renumbered.reshape(-1, 2).astype(np.int32)
    holes, regions = _hole_points(mesh, points, pairs), _region_points(mesh, edges)
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
    return domain.with_frozen(segments=np.flatnonzero(frozen)) if frozen.any() else domain


def _refuse_what_is_no_mesh(mesh: Mesh) -> None:
    """Refuse triangles and edges that are not what the rest takes them for."""
    subject = Subject(mesh)
    _refuse_if_found(subject, local.finite_points, local.indices_in_range)
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
            f"vertices {i} and {j} of the mesh are the same, ({x:.17g}, {y:.17g}): make them one"
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


def check_is_mesh(mesh: object) -> None:
    """Refuse what is no mesh."""
    if not isinstance(mesh, Mesh):
        raise DomainError(f"a Mesh is wanted, not {type(mesh).__name__}: generate makes one")


def _half_edges(triangles: Ints) -> tuple[Ints, Ints]:
    """The directed edges of all triangles, (3 m, 2), and the triangle of each."""
    halves = np.concatenate([triangles[:, [1, 2]], triangles[:, [2, 0]], triangles[:, [0, 1]]])
    return halves, np.tile(np.arange(len(triangles), dtype=np.int32), 3)


def _triangles_beside(triangles: Ints, edges: Ints, n_points: int) -> tuple[Ints, Ints]:
    """The triangle on the left and on the right of each edge, -1 where there is none."""
    halves, owner = _half_edges(triangles)
    keys = halves[:, 0].astype(np.int64) * n_points + halves[:, 1]
    order = np.argsort(keys)
    keys, owner = keys[order], owner[order]

    def left_of(a: Ints, b: Ints) -> Ints:
        wanted = a.astype(np.int64) * n_points + b
        at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        return np.where(keys[at] == wanted, owner[at], -1).astype(np.int32)

    return left_of(edges[:, 0], edges[:, 1]), left_of(edges[:, 1], edges[:, 0])


def with_interfaces(mesh: Mesh) -> tuple[Ints, Ints]:
    """The constrained edges and their tags; then, with tag 0, what else bounds or parts regions."""
    edges = mesh.unique_edges
    n = len(mesh.points)
    sides = regions_beside(mesh.triangles, mesh.regions, edges, n)
    known = edge_keys(mesh.edges[:, 0], mesh.edges[:, 1], n)
    parting = sides[:, 0] != sides[:, 1]
    parting &= ~np.isin(edge_keys(edges[:, 0], edges[:, 1], n), known)
    missing = edges[parting]
    return (
        np.concatenate([mesh.edges, missing]),
        np.concatenate([mesh.edge_tags, np.zeros(len(missing), np.int32)]),
    )


def regions_beside(triangles: Ints, regions: Ints, edges: Ints, n_points: int) -> Ints:
    """The regions on the left and right of each edge, (e, 2), `OUTSIDE` for the outside."""
    beside = _triangles_beside(triangles, edges, n_points)
    out: Ints = np.append(regions.astype(np.int64), OUTSIDE)[np.stack(beside, axis=1)]
    return out


def _chains(
    edges: Ints, tags: Ints, sides: Ints, is_stop: NDArray[np.bool_]
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


def _corners(points: Floats, chain: list[int], is_ring: bool, tolerance: float) -> list[int]:
    """The vertices of a chain that a polyline within the tolerance needs (Douglas and Peucker).

    Its ends are among them, unless it is a ring that nothing else meets.
    """
    if is_ring:  # open it at an extreme point, which is a corner
        ring = chain[:-1]
        k = min(range(len(ring)), key=lambda i: tuple(points[ring[i]]))
        chain = [*ring[k:], *ring[: k + 1]]
    keep = {0, len(chain) - 1}
    p = points[chain]
    open_parts = [(0, len(chain) - 1)]
    while open_parts:
        i, j = open_parts.pop()
        if j - i < 2:
            continue
        k = i + 1 + int(np.argmax(_distances(p[i + 1 : j], p[i], p[j])))
        if _distances(p[k : k + 1], p[i], p[j])[0] > tolerance:
            keep.add(k)
            open_parts += [(i, k), (k, j)]
    return [chain[k] for k in sorted(keep)]


def _distances(p: Floats, a: Floats, b: Floats) -> Floats:
    """Distances of points from a line, or from a point where the line has no direction."""
    d, w = b - a, p - a
    norm = float(np.hypot(*d))
    if norm == 0.0:
        return np.hypot(w[:, 0], w[:, 1])
    out: Floats = np.abs(w[:, 0] * d[1] - w[:, 1] * d[0]) / norm
    return out


def _hole_points(mesh: Mesh, points: Floats, segments: Ints) -> Floats:
    """A point inside every hole: those parts of the filled outline that the mesh does not cover."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    nowhere = np.empty((0, 2))
    try:
        filled, _, pieces, _, _ = _core.triangulate(points, segments, nowhere, nowhere, False)
    except _core.Fault as fault:
        *_, x, y = fault.args
        raise DomainError(
            f"the mesh lies over itself near ({x:.17g}, {y:.17g}), so it covers no domain; its "
            "validate() lists what is wrong"
        ) from None
    halves, owner = _half_edges(filled)
    keys = edge_keys(halves[:, 0], halves[:, 1], len(points))
    order = np.argsort(keys, kind="stable")
    same = np.flatnonzero(keys[order][:-1] == keys[order][1:])
    open_ = same[~np.isin(keys[order][same], edge_keys(pieces[:, 0], pieces[:, 1], len(points)))]
    links = owner[order][open_], owner[order][open_ + 1]
    graph = coo_array((np.ones(len(open_)), links), shape=(len(filled), len(filled)))
    _, part = connected_components(graph, directed=False)

    # The largest triangle of each part stands for it.
    p = points[filled]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    by_area = np.argsort(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])[::-1]
    _, first = np.unique(part[by_area], return_index=True)
    centres = p[by_area[first]].mean(axis=1)
    out: Floats = centres[~_covered(mesh, centres)]
    return out


def _covered(mesh: Mesh, places: Floats) -> NDArray[np.bool_]:
    """Which of the places lie in a triangle of the mesh, by exact signs: some are on its sides."""
    a, b, c = mesh.points[mesh.triangles].transpose(1, 0, 2).copy()
    out = np.zeros(len(places), bool)
    for i, place in enumerate(places):
        x = np.tile(place, (len(a), 1))
        signs = [_core.orient2d(*side, x) for side in ((a, b), (b, c), (c, a))]
        out[i] = (np.min(signs, axis=0) >= 0).any()
    return out


def _region_points(mesh: Mesh, edges: Ints) -> dict[Label, ArrayLike]:
    """For each region but 0 a point in each of its parts."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    left, right = _triangles_beside(mesh.triangles, mesh.unique_edges, len(mesh.points))
    n = len(mesh.points)
    free = ~np.isin(
        edge_keys(mesh.unique_edges[:, 0], mesh.unique_edges[:, 1], n),
        edge_keys(edges[:, 0], edges[:, 1], n),
    )
    free &= (left >= 0) & (right >= 0)
    m = len(mesh.triangles)
    graph = coo_array((np.ones(free.sum()), (left[free], right[free])), shape=(m, m))
    _, part = connected_components(graph, directed=False)

    by_area = np.argsort(mesh.areas)[::-1]
    out: dict[Label, ArrayLike] = {}
    for number in np.unique(mesh.regions[mesh.regions != 0]).tolist():
        mine = by_area[mesh.regions[by_area] == number]
        _, first = np.unique(part[mine], return_index=True)
        out[number] = mesh.points[mesh.triangles[mine[first]]].mean(axis=1)
    return out
