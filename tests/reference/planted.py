"""Faults planted in right meshes: each gives a mesh, the invariant it breaks, and its place.

``FAULTS[name](mesh)`` returns (mesh, invariants, place): one of the invariants has to be broken,
and its offenders have to show the place, a piece of text. None if the mesh has nothing of that
kind. ``HARMLESS`` are changes that leave a right mesh right.
"""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np

import adaptmesh as am

FAULTS = {}
HARMLESS = {}


def fault(function):
    FAULTS[function.__name__.replace("_", " ")] = function
    return function


def harmless(function):
    HARMLESS[function.__name__.replace("_", " ")] = function
    return function


# --- what there is in a mesh ----------------------------------------------------------------


def sides(mesh):
    """The triangles of each side, by its sorted vertices."""
    out = {}
    for k, t in enumerate(mesh.triangles.tolist()):
        for i in range(3):
            out.setdefault(tuple(sorted((t[i], t[i - 1]))), []).append(k)
    return out


def constrained(mesh):
    return {tuple(sorted(e)) for e in mesh.edges.tolist()}


def inner_vertices(mesh):
    return np.setdiff1d(mesh.triangles, mesh.edges)


def border_edges(mesh):
    return [e for e, owners in sides(mesh).items() if len(owners) == 1]


def inner_lines(mesh):
    """Numbers of constrained edges with a triangle on both sides."""
    both = sides(mesh)
    return [k for k, e in enumerate(mesh.edges.tolist()) if len(both[tuple(sorted(e))]) == 2]


def corners(mesh):
    """Vertices that are points of the domain."""
    known = {tuple(p) for p in mesh.domain.points[mesh.domain.curved.is_vertex].tolist()}
    return [v for v, p in enumerate(mesh.points.tolist()) if tuple(p) in known]


def cuts(mesh, is_curved, is_border=True):
    """Vertices within lines, each with its neighbours (v, before, after) along them."""
    at = {}
    for k, (a, b) in enumerate(mesh.edges.tolist()):
        at.setdefault(a, []).append((b, k))
        at.setdefault(b, []).append((a, k))
    borders = set(itertools.chain(*border_edges(mesh)))
    out = []
    for v in np.setdiff1d(mesh.edges, corners(mesh)).tolist():
        if (v in borders) != is_border or len(at[v]) != 2:
            continue
        (a, _), (b, _) = at[v]
        turn = cross(mesh.points[v] - mesh.points[a], mesh.points[b] - mesh.points[v])
        size = np.prod([np.hypot(*(mesh.points[v] - mesh.points[w])) for w in (a, b)])
        if (abs(turn) > 1e-6 * size) == is_curved:
            out.append((v, a, b))
    return out


def cross(u, v):
    return u[0] * v[1] - u[1] * v[0]


def size(mesh, v):
    """The length of the shortest side at a vertex."""
    near = np.unique(mesh.triangles[(mesh.triangles == v).any(axis=1)])
    off = np.hypot(*(mesh.points[near[near != v]] - mesh.points[v]).T)
    return off.min()


def moved(mesh, v, place):
    points = mesh.points.copy()
    points[v] = place
    return replace(mesh, points=points)


def at(*vertices):
    return f"{vertices[0]} ("


def with_triangles(mesh, triangles, regions=None, **more):
    if regions is None:
        regions = np.resize(mesh.regions, len(triangles))
    return replace(mesh, triangles=triangles, regions=regions, **more)


def without_triangle(mesh, k):
    left = np.arange(len(mesh.triangles)) != k
    return with_triangles(mesh, mesh.triangles[left], mesh.regions[left])


def split(mesh, a, b, place):
    """The edge ab divided, with its triangles, by a new vertex."""
    v = len(mesh.points)
    triangles, regions = [], []
    for t, region in zip(mesh.triangles.tolist(), mesh.regions.tolist(), strict=True):
        halves = [[v if w == x else w for w in t] for x in (a, b)]
        parts = halves if a in t and b in t else [t]
        triangles += parts
        regions += [region] * len(parts)
    k = next(i for i, e in enumerate(mesh.edges.tolist()) if sorted(e) == sorted((a, b)))
    edges = np.concatenate([mesh.edges, [[v, b]]])
    edges[k] = [a, v]
    return replace(
        mesh,
        points=np.concatenate([mesh.points, [place]]),
        triangles=np.array(triangles),
        regions=np.array(regions),
        edges=edges,
        edge_tags=np.append(mesh.edge_tags, mesh.edge_tags[k]),
    )


# --- points ---------------------------------------------------------------------------------


@fault
def coordinate_not_a_number(mesh):
    points = mesh.points.copy()
    points[3, 1] = np.nan
    return replace(mesh, points=points), {"finite points"}, at(3)


@fault
def coordinate_infinite(mesh):
    points = mesh.points.copy()
    points[0, 0] = np.inf
    return replace(mesh, points=points), {"finite points"}, at(0)


@fault
def vertex_doubled(mesh):
    v, n = int(inner_vertices(mesh)[0]), len(mesh.points)
    triangles = mesh.triangles.copy()
    k = np.flatnonzero((triangles == v).any(axis=1))[0]
    triangles[k][triangles[k] == v] = n
    points = np.concatenate([mesh.points, mesh.points[[v]]])
    return replace(mesh, points=points, triangles=triangles), {"distinct points"}, at(n)


@fault
def vertex_without_triangle(mesh):
    points = np.concatenate([mesh.points, mesh.points[:3].mean(axis=0, keepdims=True)])
    return replace(mesh, points=points), {"points used"}, at(len(mesh.points))


@fault
def inner_vertex_out_of_its_star(mesh):
    v = int(inner_vertices(mesh)[0])
    far = mesh.points[v] + 2 * np.ptp(mesh.points, axis=0)
    return moved(mesh, v, far), {"positive triangles"}, at(v)


@fault
def inner_vertex_on_its_neighbour(mesh):
    v = int(inner_vertices(mesh)[0])
    t = mesh.triangles[(mesh.triangles == v).any(axis=1)][0]
    w = int(t[t != v][0])
    return moved(mesh, v, mesh.points[w]), {"distinct points"}, at(max(v, w))


def _off_its_line(mesh, is_curved, is_border, share):
    found = cuts(mesh, is_curved, is_border)
    if not found:
        return None
    v, a, b = found[len(found) // 2]
    d = mesh.points[b] - mesh.points[a]
    normal = np.array([-d[1], d[0]]) / np.hypot(*d)
    # a straight line may be a part of a curve
    names = {"vertices on curves"} | (set() if is_curved else {"vertices on segments"})
    return moved(mesh, v, mesh.points[v] + share * size(mesh, v) * normal), names, at(v)


@fault
def border_vertex_off_its_segment(mesh):
    return _off_its_line(mesh, False, True, 1e-4)


@fault
def border_vertex_off_its_segment_on_the_other_side(mesh):
    return _off_its_line(mesh, False, True, -1e-4)


@fault
def inner_line_vertex_off_its_segment(mesh):
    return _off_its_line(mesh, False, False, 1e-4)


@fault
def border_vertex_off_its_curve(mesh):
    return _off_its_line(mesh, True, True, 1e-4)


@fault
def border_vertex_off_its_curve_on_the_other_side(mesh):
    return _off_its_line(mesh, True, True, -1e-4)


@fault
def inner_line_vertex_off_its_curve(mesh):
    return _off_its_line(mesh, True, False, 1e-4)


@fault
def curve_vertex_in_the_middle_of_its_chord(mesh):
    found = cuts(mesh, True)
    if not found:
        return None
    v, a, b = found[0]
    return moved(mesh, v, mesh.points[[a, b]].mean(axis=0)), {"vertices on curves"}, at(v)


@fault
def segment_vertex_past_its_neighbour(mesh):
    found = cuts(mesh, False)
    if not found:
        return None
    v, a, _ = found[0]
    place = mesh.points[a] + 0.3 * (mesh.points[a] - mesh.points[v])
    return moved(mesh, v, place), {"positive triangles"}, at(v)


@fault
def curve_vertices_exchanged(mesh):
    found = cuts(mesh, True)
    pairs = [(v, a) for v, a, _ in found if any(w == a for w, _, _ in found)]
    if not pairs:
        return None
    v, a = pairs[0]
    points = mesh.points.copy()
    points[[v, a]] = points[[a, v]]
    return replace(mesh, points=points), {"positive triangles"}, at(v)


@fault
def corner_moved(mesh):
    v = corners(mesh)[0]
    place = mesh.points[v] + 1e-5 * size(mesh, v)
    names = {"points present"}
    return moved(mesh, v, place), names, repr(float(mesh.points[v, 0]))


@fault
def lone_point_moved(mesh):
    lone = np.setdiff1d(corners(mesh), mesh.edges)
    if not len(lone):
        return None
    v = int(lone[0])
    place = mesh.points[v] + 1e-5 * size(mesh, v)
    return moved(mesh, v, place), {"points present"}, repr(float(mesh.points[v, 0]))


@fault
def all_moved(mesh):
    shift = 1e-3 * np.ptp(mesh.points, axis=0)
    return replace(mesh, points=mesh.points + shift), {"points present"}, "point 0 of the domain"


# --- triangles ------------------------------------------------------------------------------


@fault
def no_triangles(mesh):
    return with_triangles(mesh, mesh.triangles[:0]), {"not empty"}, ""


@fault
def triangle_clockwise(mesh):
    triangles = mesh.triangles.copy()
    triangles[7] = triangles[7][::-1]
    return replace(mesh, triangles=triangles), {"positive triangles"}, "triangle 7"


@fault
def all_triangles_clockwise(mesh):
    return replace(mesh, triangles=mesh.triangles[:, ::-1]), {"positive triangles"}, "triangle 0"


@fault
def triangle_without_area(mesh):
    triangles = mesh.triangles.copy()
    triangles[4, 2] = triangles[4, 1]
    return replace(mesh, triangles=triangles), {"positive triangles"}, "triangle 4 is flat"


@fault
def triangle_missing_inside(mesh):
    walls = set(mesh.edges.ravel().tolist())
    inside = [k for k, t in enumerate(mesh.triangles.tolist()) if not walls & set(t)]
    if not inside:
        return None
    a = int(mesh.triangles[inside[0], 0])
    return without_triangle(mesh, inside[0]), {"border is constrained"}, at(a)


@fault
def triangle_missing_at_the_border(mesh):
    owner = sides(mesh)[border_edges(mesh)[0]][0]
    names = {"border is constrained", "constrained are edges"}
    return without_triangle(mesh, owner), names, at(border_edges(mesh)[0][0])


@fault
def triangle_missing_but_walled_in(mesh):
    walls = set(mesh.edges.ravel().tolist())
    inside = [k for k, t in enumerate(mesh.triangles.tolist()) if not walls & set(t)]
    if not inside:
        return None
    t = mesh.triangles[inside[0]]
    more = replace(
        without_triangle(mesh, inside[0]),
        edges=np.concatenate([mesh.edges, np.stack([t, np.roll(t, -1)], axis=1)]),
        edge_tags=np.append(mesh.edge_tags, [0, 0, 0]),
    )
    return more, {"edges on segments"}, at(int(t[0]))


@fault
def triangle_listed_twice(mesh):
    triangles = np.concatenate([mesh.triangles, mesh.triangles[[5]]])
    regions = np.append(mesh.regions, mesh.regions[5])
    names = {"same orientation", "two triangles an edge"}
    return with_triangles(mesh, triangles, regions), names, "5, "


@fault
def triangle_index_out_of_range(mesh):
    triangles = mesh.triangles.copy()
    triangles[2, 0] = len(mesh.points)
    return replace(mesh, triangles=triangles), {"indices in range"}, "triangle 2"


@fault
def triangle_index_negative(mesh):
    triangles = mesh.triangles.copy()
    triangles[2, 0] = -1
    return replace(mesh, triangles=triangles), {"indices in range"}, "triangle 2"


@fault
def triangles_numbered_from_one(mesh):
    return replace(mesh, triangles=mesh.triangles + 1), {"indices in range"}, "triangle "


@fault
def third_triangle_on_an_edge(mesh):
    (a, b), (k, _) = next((e, owners) for e, owners in sides(mesh).items() if len(owners) == 2)
    far = next(v for v in range(len(mesh.points)) if v not in mesh.triangles[sides(mesh)[a, b]])
    p = mesh.points
    t = [a, b, far] if cross(p[b] - p[a], p[far] - p[a]) > 0 else [b, a, far]
    triangles = np.concatenate([mesh.triangles, [t]])
    regions = np.append(mesh.regions, mesh.regions[k])
    return with_triangles(mesh, triangles, regions), {"two triangles an edge"}, at(a)


@fault
def piece_lying_over_others(mesh):
    t = mesh.triangles[np.argmax(mesh.areas)]
    n = len(mesh.points)
    small = mesh.points[t].mean(axis=0) + 0.2 * (mesh.points[t] - mesh.points[t].mean(axis=0))
    over = replace(
        mesh,
        points=np.concatenate([mesh.points, small]),
        triangles=np.concatenate([mesh.triangles, [[n, n + 1, n + 2]]]),
        regions=np.append(mesh.regions, 0),
        edges=np.concatenate([mesh.edges, [[n, n + 1], [n + 1, n + 2], [n + 2, n]]]),
        edge_tags=np.append(mesh.edge_tags, [0, 0, 0]),
    )
    return over, {"covered once"}, at(n)


@fault
def piece_lying_over_the_border(mesh):
    a, b = border_edges(mesh)[0]
    n, p = len(mesh.points), mesh.points
    middle = 0.5 * (p[a] + p[b])
    d = p[b] - p[a]
    normal = np.array([-d[1], d[0]])
    small = np.array([middle - 0.1 * d - 0.1 * normal, middle + 0.1 * d, middle + 0.1 * normal])
    over = replace(
        mesh,
        points=np.concatenate([p, small]),
        triangles=np.concatenate([mesh.triangles, [[n, n + 1, n + 2]]]),
        regions=np.append(mesh.regions, 0),
        edges=np.concatenate([mesh.edges, [[n, n + 1], [n + 1, n + 2], [n + 2, n]]]),
        edge_tags=np.append(mesh.edge_tags, [0, 0, 0]),
    )
    return over, {"simple border"}, "("


@fault
def hanging_vertex(mesh):
    """An inner edge divided in one of its two triangles only."""
    walls = set(mesh.edges.ravel().tolist())
    for (a, b), owners in sides(mesh).items():
        if len(owners) == 2 and not {a, b} & walls:
            break
    else:
        return None
    v, k = len(mesh.points), owners[0]
    t = mesh.triangles[k].tolist()
    parts = [[v if w == x else w for w in t] for x in (a, b)]
    points = np.concatenate([mesh.points, [mesh.points[[a, b]].mean(axis=0)]])
    triangles = np.concatenate([np.delete(mesh.triangles, k, axis=0), parts])
    regions = np.append(np.delete(mesh.regions, k), [mesh.regions[k]] * 2)
    # rounding may put the vertex on either side of the edge
    names = {"border is constrained"}
    return with_triangles(replace(mesh, points=points), triangles, regions), names, at(a)


@fault
def diagonal_swapped_out_of_its_quadrilateral(mesh):
    p = mesh.points
    for (a, b), owners in sides(mesh).items():
        if len(owners) < 2 or (a, b) in constrained(mesh):
            continue
        one, two = (next(v for v in mesh.triangles[k].tolist() if v not in (a, b)) for k in owners)
        signs = [cross(p[two] - p[one], p[v] - p[one]) for v in (a, b)]
        if np.prod(np.sign(signs)) <= 0 or min(map(abs, signs)) < 1e-6 * max(map(abs, signs)):
            continue
        triangles = mesh.triangles.copy()
        triangles[owners[0]] = [one, two, a]
        triangles[owners[1]] = [two, one, b]
        names = {"positive triangles", "same orientation"}
        return replace(mesh, triangles=triangles), names, "triangle"
    return None


# --- constrained edges ----------------------------------------------------------------------


def without_edges(mesh, numbers):
    left = np.setdiff1d(np.arange(len(mesh.edges)), numbers)
    return replace(mesh, edges=mesh.edges[left], edge_tags=mesh.edge_tags[left])


def with_edge(mesh, edge, tag=0):
    return replace(
        mesh,
        edges=np.concatenate([mesh.edges, [edge]]),
        edge_tags=np.append(mesh.edge_tags, tag),
    )


@fault
def border_edge_missing(mesh):
    border = set(border_edges(mesh))
    k = next(i for i, e in enumerate(mesh.edges.tolist()) if tuple(sorted(e)) in border)
    names = {"border is constrained"}
    return without_edges(mesh, [k]), names, at(int(mesh.edges[k, 0]))


@fault
def all_edges_missing(mesh):
    return without_edges(mesh, np.arange(len(mesh.edges))), {"border is constrained"}, "side"


@fault
def edge_of_an_inner_line_missing(mesh):
    lines = inner_lines(mesh)
    if not lines:
        return None
    names = {"segments present", "curves present"}
    return without_edges(mesh, [lines[len(lines) // 2]]), names, "is no row of constrained edges"


@fault
def inner_lines_lost(mesh):
    lines = inner_lines(mesh)
    if not lines:
        return None
    names = {"segments present", "curves present"}
    return without_edges(mesh, lines), names, "is no row of constrained edges"


@fault
def edge_too_many(mesh):
    known = constrained(mesh)
    a, b = next(e for e, o in sides(mesh).items() if len(o) == 2 and e not in known)
    return with_edge(mesh, [a, b]), {"edges on segments"}, at(a)


@fault
def edge_listed_twice(mesh):
    edge, k = mesh.edges[1].tolist(), len(mesh.edges)
    place = f"edge {k} is listed twice"
    return with_edge(mesh, edge, mesh.edge_tags[1]), {"constrained are edges"}, place


@fault
def edge_listed_twice_backwards(mesh):
    edge, k = mesh.edges[1][::-1].tolist(), len(mesh.edges)
    place = f"edge {k} is listed twice"
    return with_edge(mesh, edge, mesh.edge_tags[1]), {"constrained are edges"}, place


@fault
def edge_that_is_no_side(mesh):
    known = sides(mesh)
    far = next(v for v in range(1, len(mesh.points)) if (0, v) not in known)
    return with_edge(mesh, [0, far]), {"constrained are edges"}, at(0)


@fault
def edge_index_out_of_range(mesh):
    edge = [0, len(mesh.points)]
    k = len(mesh.edges)
    return with_edge(mesh, edge), {"indices in range"}, f"constrained edge {k}"


@fault
def edge_from_a_point_to_itself(mesh):
    return with_edge(mesh, [2, 2]), {"constrained are edges"}, at(2)


@fault
def inner_line_by_a_detour(mesh):
    lines = inner_lines(mesh)
    known = constrained(mesh)
    for k in lines:
        a, b = mesh.edges[k].tolist()
        for owner in sides(mesh)[tuple(sorted((a, b)))]:
            c = next(v for v in mesh.triangles[owner].tolist() if v not in (a, b))
            ways = [tuple(sorted((a, c))), tuple(sorted((c, b)))]
            if c in mesh.edges or any(way in known for way in ways):
                continue
            tag = mesh.edge_tags[k]
            round_ = with_edge(with_edge(mesh, ways[0], tag), ways[1], tag)
            names = {"vertices on segments", "vertices on curves"}
            return without_edges(round_, [k]), names, at(c)
    return None


@fault
def inner_line_edge_swapped_away(mesh):
    p, known = mesh.points, constrained(mesh)
    for k in inner_lines(mesh):
        a, b = mesh.edges[k].tolist()
        owners = sides(mesh)[tuple(sorted((a, b)))]
        one, two = (next(v for v in mesh.triangles[o].tolist() if v not in (a, b)) for o in owners)
        turns = [
            cross(p[w] - p[v], p[x] - p[w])
            for v, w, x in ((a, one, b), (one, b, two), (b, two, a), (two, a, one))
        ]
        if not (np.all(np.array(turns) > 0) or np.all(np.array(turns) < 0)):
            continue
        if tuple(sorted((one, two))) in known:
            continue
        triangles, edges = mesh.triangles.copy(), mesh.edges.copy()
        flip = 1 if cross(p[two] - p[one], p[a] - p[one]) > 0 else -1
        triangles[owners[0]] = [one, two, a][::flip]
        triangles[owners[1]] = [two, one, b][::flip]
        edges[k] = [one, two]
        names = {"segments present", "curves present"}
        return replace(mesh, triangles=triangles, edges=edges), names, "no row"
    return None


@fault
def frozen_segment_divided(mesh):
    frozen = mesh.domain.segment_is_frozen
    if not frozen.any():
        return None
    ends = mesh.domain.points[mesh.domain.segments[np.flatnonzero(frozen)[0]]]
    a, b = (int(np.flatnonzero((mesh.points == p).all(axis=1))[0]) for p in ends)
    names = {"frozen undivided"}
    # on a slant, the middle is on the segment to rounding only: the triangles stay positive
    return split(mesh, a, b, ends.mean(axis=0)), names, repr(float(ends[0, 0]))


# --- tags, regions, names -------------------------------------------------------------------


def _tagged(mesh, k, tag):
    tags = mesh.edge_tags.copy()
    tags[k] = tag
    return replace(mesh, edge_tags=tags)


@fault
def edge_with_the_tag_of_another_boundary(mesh):
    tag = next(t for t in mesh.names.values() if t != mesh.edge_tags[0])
    return _tagged(mesh, 0, tag), {"tags of domain"}, "constrained edge 0,"


@fault
def edge_with_a_tag_that_has_no_name(mesh):
    return _tagged(mesh, 3, 99), {"tags of domain"}, "constrained edge 3,"


@fault
def edge_with_a_negative_tag(mesh):
    return _tagged(mesh, 3, -2), {"tags", "tags of domain"}, "tag -2"


@fault
def tags_all_zero(mesh):
    return replace(mesh, edge_tags=0 * mesh.edge_tags), {"tags of domain"}, "tag 0, but"


@fault
def tags_of_two_boundaries_exchanged(mesh):
    one, two = list(mesh.names.values())[:2]
    tags = mesh.edge_tags
    tags = np.select([tags == one, tags == two], [two, one], tags)
    k = int(np.flatnonzero(tags != mesh.edge_tags)[0])
    return replace(mesh, edge_tags=tags), {"tags of domain"}, f"tag {tags[k]}, but"


def _regions(mesh):
    return np.unique(mesh.regions).tolist()


@fault
def regions_exchanged(mesh):
    if len(_regions(mesh)) < 2:
        return None
    one, two = _regions(mesh)[:2]
    regions = np.select([mesh.regions == one, mesh.regions == two], [two, one], mesh.regions)
    return replace(mesh, regions=regions), {"regions of domain"}, "triangle 0,"


@fault
def regions_all_zero(mesh):
    if _regions(mesh) == [0]:
        return None
    k = int(np.flatnonzero(mesh.regions)[0])
    return replace(mesh, regions=0 * mesh.regions), {"regions of domain"}, f"triangle {k},"


@fault
def region_of_one_triangle(mesh):
    regions = mesh.regions.copy()
    regions[11] += 1
    return replace(mesh, regions=regions), {"regions of domain"}, "triangle 11,"


@fault
def region_of_one_triangle_away_from_all_lines(mesh):
    walls = set(mesh.edges.ravel().tolist())
    inside = [k for k, t in enumerate(mesh.triangles.tolist()) if not walls & set(t)]
    if not inside:
        return None
    regions = mesh.regions.copy()
    regions[inside[0]] += 1
    return replace(mesh, regions=regions), {"regions of domain"}, f"triangle {inside[0]},"


@fault
def region_unknown(mesh):
    return replace(mesh, regions=0 * mesh.regions + 17), {"regions of domain"}, "region 17"


@fault
def region_negative(mesh):
    regions = mesh.regions.copy()
    regions[1] = -5
    return replace(mesh, regions=regions), {"tags"}, "triangle 1: region -5"


def _exchanged(table):
    one, two = list(table)[:2]
    return {**table, one: table[two], two: table[one]}


@fault
def names_exchanged(mesh):
    names = _exchanged(mesh.names)
    return replace(mesh, names=names), {"names of domain"}, next(iter(names))


@fault
def name_missing(mesh):
    (first, *_), rest = mesh.names, dict(list(mesh.names.items())[1:])
    return replace(mesh, names=rest), {"names of domain"}, repr(first)


@fault
def names_all_missing(mesh):
    return replace(mesh, names={}), {"names of domain"}, next(iter(mesh.names))


@fault
def name_too_many(mesh):
    names = {**mesh.names, "ghost": 77}
    return replace(mesh, names=names), {"names of domain"}, "'ghost'"


@fault
def two_names_for_one_tag(mesh):
    names = {**mesh.names, "ghost": next(iter(mesh.names.values()))}
    return replace(mesh, names=names), {"names of domain"}, "'ghost'"


@fault
def region_names_exchanged(mesh):
    if len(mesh.region_names) < 2:
        return None
    names = _exchanged(mesh.region_names)
    return replace(mesh, region_names=names), {"region names of domain"}, next(iter(names))


@fault
def region_names_missing(mesh):
    if not mesh.region_names:
        return None
    first = next(iter(mesh.region_names))
    return replace(mesh, region_names={}), {"region names of domain"}, repr(first)


@fault
def region_name_too_many(mesh):
    names = {**mesh.region_names, "ghost": 77}
    return replace(mesh, region_names=names), {"region names of domain"}, "'ghost'"


@fault
def vertex_kept_twice(mesh):
    kept = np.full(len(mesh.points), -1)
    kept[[2, 4]] = 3
    return replace(mesh, kept=kept), {"kept once"}, at(4)


# --- the domain -----------------------------------------------------------------------------


def holes(mesh):
    """The rings of vertices around holes, clockwise, so that a hole is on their right."""
    after = {}
    for t in mesh.triangles.tolist():
        for i in range(3):
            after[t[i], t[(i + 1) % 3]] = True
    free = {a: b for a, b in after if (b, a) not in after}
    rings = []
    while free:
        ring = [next(iter(free))]
        while ring[-1] in free:
            ring.append(free.pop(ring[-1]))
        p = mesh.points[ring] - mesh.points[ring[0]]
        if sum(cross(p[i], p[i + 1]) for i in range(len(p) - 1)) < 0:
            rings.append(ring[:-1])
    return rings


@fault
def hole_filled(mesh):
    rings = holes(mesh)
    if not rings:
        return None
    ring = rings[0][::-1]
    fan = [[ring[0], ring[i], ring[i + 1]] for i in range(1, len(ring) - 1)]
    p = mesh.points[np.array(fan)]
    if min(cross(q[1] - q[0], q[2] - q[0]) for q in p) <= 0:  # three on a straight side
        v = len(mesh.points)
        fan = [[v, ring[i - 1], ring[i]] for i in range(len(ring))]
        mesh = replace(mesh, points=np.concatenate([mesh.points, [mesh.points[ring].mean(axis=0)]]))
    triangles = np.concatenate([mesh.triangles, fan])
    regions = np.append(mesh.regions, np.zeros(len(fan), int))
    return with_triangles(mesh, triangles, regions), {"fills domain"}, "lies outside"


@fault
def island_in_a_hole(mesh):
    rings = holes(mesh)
    if not rings:
        return None
    centre = mesh.points[rings[0]].mean(axis=0)
    p = mesh.points[rings[0][::-1]]
    small = centre + 0.2 * (p[[0, len(p) // 3, 2 * len(p) // 3]] - centre)
    n = len(mesh.points)
    more = replace(
        mesh,
        points=np.concatenate([mesh.points, small]),
        triangles=np.concatenate([mesh.triangles, [[n, n + 1, n + 2]]]),
        regions=np.append(mesh.regions, 0),
        edges=np.concatenate([mesh.edges, [[n, n + 1], [n + 1, n + 2], [n + 2, n]]]),
        edge_tags=np.append(mesh.edge_tags, [0, 0, 0]),
    )
    return more, {"edges on segments"}, at(n)


@fault
def region_left_out(mesh):
    """All triangles of one region removed; its border stays, where another region is beyond it."""
    if len(_regions(mesh)) < 2:
        return None
    left = mesh.regions != _regions(mesh)[-1]
    used = np.zeros(len(mesh.points), bool)
    used[mesh.triangles[left]] = True
    number = np.cumsum(used) - 1
    known = sides(with_triangles(mesh, mesh.triangles[left]))
    edges = np.array([tuple(sorted(e)) in known for e in mesh.edges.tolist()])
    part = replace(
        mesh,
        points=mesh.points[used],
        triangles=number[mesh.triangles[left]],
        regions=mesh.regions[left],
        edges=number[mesh.edges[edges]],
        edge_tags=mesh.edge_tags[edges],
    )
    return part, {"fills domain"}, "no triangle on a side"


def _tied(mesh):
    pairs = mesh.periodic_vertices()
    if not pairs:
        return None
    (first, second), rows = next(iter(pairs.items()))
    inner = [r for r in rows.tolist() if not set(r) & set(corners(mesh))]
    return first, second, inner


@fault
def periodic_partner_missing(mesh):
    if _tied(mesh) is None:
        return None
    _, second, _ = _tied(mesh)
    a, b = mesh.edges_named(second)[0].tolist()
    return split(mesh, a, b, mesh.points[[a, b]].mean(axis=0)), {"periodic boundaries"}, "edges"


@fault
def periodic_partner_moved_along_its_side(mesh):
    if _tied(mesh) is None:
        return None
    _, second, inner = _tied(mesh)
    tag = mesh.names[second]
    for _, v in inner:
        near = mesh.edges[(mesh.edges == v).any(axis=1) & (mesh.edge_tags == tag)]
        w = int(near[0][near[0] != v][0])
        place = mesh.points[v] + 1e-3 * (mesh.points[w] - mesh.points[v])
        return moved(mesh, v, place), {"periodic boundaries"}, at(v)
    return None


def _seeds(domain):
    numbers = np.unique(domain.seed_regions).tolist()
    return [(number, domain.seeds[domain.seed_regions == number]) for number in numbers]


def _other_domain(mesh, **changes):
    if mesh.domain.curved.paths:
        return None
    outline = am.Domain(
        **{
            "points": mesh.domain.points,
            "segments": mesh.domain.segments,
            "holes": "nesting" if mesh.domain.nesting else mesh.domain.holes,
            "names": {
                int(t): np.flatnonzero(mesh.domain.segment_tags == t).tolist()
                for t in np.unique(mesh.domain.segment_tags)
                if t
            },
            "regions": dict(_seeds(mesh.domain)),
            "tags": mesh.domain.names,
            "region_tags": mesh.domain.region_names,
            **changes,
        }
    )
    return replace(mesh, domain=outline)


@fault
def domain_of_another_place(mesh):
    shift = 1e-3 * np.ptp(mesh.domain.points, axis=0)
    other = _other_domain(
        mesh,
        points=mesh.domain.points + shift,
        holes=mesh.domain.holes + shift,
        regions={r: s + shift for r, s in _seeds(mesh.domain)},
    )
    return other and (other, {"points present"}, "point 0 of the domain")


@fault
def domain_with_a_point_more(mesh):
    v = int(inner_vertices(mesh)[0])
    place = mesh.points[v] + 0.1 * size(mesh, v)
    other = _other_domain(mesh, points=np.concatenate([mesh.domain.points, [place]]))
    return other and (other, {"points present"}, repr(float(place[0])))


@fault
def domain_with_a_line_more(mesh):
    if mesh.domain.curved.paths:
        return None
    free = set(inner_vertices(mesh).tolist()) - set(corners(mesh))
    ends = next(e for e in sides(mesh) if set(e) <= free)
    n, k = len(mesh.domain.points), len(mesh.domain.segments)
    other = _other_domain(
        mesh,
        points=np.concatenate([mesh.domain.points, mesh.points[list(ends)]]),
        segments=np.concatenate([mesh.domain.segments, [[n, n + 1]]]),
    )
    return other, {"segments present"}, f"segment {k} "


@fault
def domain_with_other_tags(mesh):
    other = _other_domain(mesh, names={5: [0]}, tags=mesh.domain.names)
    return other and (other, {"tags of domain"}, "has 5")


@fault
def domain_with_other_regions(mesh):
    if not len(mesh.domain.seeds):
        return None
    other = _other_domain(mesh, regions={}, region_tags=mesh.domain.region_names)
    return other and (other, {"regions of domain"}, "in the domain 0")


# --- what is no fault -----------------------------------------------------------------------


@harmless
def nothing(mesh):
    return mesh


@harmless
def edges_backwards(mesh):
    return replace(mesh, edges=mesh.edges[:, ::-1])


@harmless
def edges_in_another_order(mesh):
    order = np.random.default_rng(1).permutation(len(mesh.edges))
    return replace(mesh, edges=mesh.edges[order], edge_tags=mesh.edge_tags[order])


@harmless
def triangles_in_another_order(mesh):
    order = np.random.default_rng(2).permutation(len(mesh.triangles))
    return with_triangles(mesh, np.roll(mesh.triangles[order], 1, axis=1), mesh.regions[order])


@harmless
def vertices_in_another_order(mesh):
    order = np.random.default_rng(3).permutation(len(mesh.points))
    number = np.argsort(order)
    return replace(
        mesh, points=mesh.points[order], triangles=number[mesh.triangles], edges=number[mesh.edges]
    )


@harmless
def without_its_domain(mesh):
    return replace(mesh, domain=None)
