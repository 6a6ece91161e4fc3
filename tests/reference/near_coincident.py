"""Random domains with sides nearer to each other than coordinates are rounded, or nearly so."""

from __future__ import annotations

import numpy as np
from reference.exact_mesh import area_of_rings, faults_of_mesh, faults_of_segments
from reference.transforms import TRANSFORMS

import adaptmesh as am
from adaptmesh.curves import Arc, Circle, Line, Spline

TRIES = 5
"""So often a figure is drawn again whose sides cross as they are rounded."""

SQUARE = np.array([(0.0, 0), (2, 0), (2, 2), (0, 2)])


def places_off(rng, points):
    """Points moved by some units in the last place of each coordinate."""
    k = rng.choice([0, 1, 1, 2, 3, 8, 1000], np.shape(points)) * rng.choice([-1, 1])
    return points + k * np.spacing(np.abs(points))


def ring(n, first=0):
    return [(first + k, first + (k + 1) % n) for k in range(n)]


def figure(*rings):
    """Points and segments of closed rings."""
    first = np.cumsum([0, *map(len, rings)])
    segments = [e for r, k in zip(rings, first, strict=False) for e in ring(len(r), k)]
    return np.concatenate(rings), segments


def slit(rng, move):
    """A notch as thin as that from the left side to the middle."""
    y, tip = rng.uniform(0.2, 1.8), rng.uniform((0.3, 0.1), (1.7, 1.9))
    low, high = np.array([0, y]), np.array([0, y])
    outer = move(np.array([*SQUARE, high, tip, low]))
    outer[4] = places_off(rng, outer[4])
    return figure(outer), "nesting"


def needle(rng, move):
    """A hole that is hardly wider than a line, along a second one or alone."""
    a, b = rng.uniform(0.2, 1.8, (2, 2))
    holes = []
    for _ in range(rng.integers(1, 3)):
        c = a + rng.uniform(0, 1) * (b - a)
        hole = move(np.array([a, b, c]))
        hole[2] = places_off(rng, hole[2])
        holes.append(hole)
        a[1], b[1] = a[1] + 1e-15 * rng.integers(1, 9), b[1] + 1e-15 * rng.integers(1, 9)
    return figure(move(SQUARE), *holes), "nesting"


def neighbours(rng, move):
    """Two parts with a gap between them that is as wide as rounding."""
    a, b = np.array([rng.uniform(0.5, 1.5), 0]), np.array([rng.uniform(0.5, 1.5), 2])
    one, other = move(np.array([(0, 0), a, b, (0, 2)])), move(np.array([a, (2, 0), (2, 2), b]))
    other[[0, 3]] = places_off(rng, other[[0, 3]])
    return figure(one, other), "nesting"


def interfaces(rng, move):
    """Lines inside that are parallel, or that fan out of a point by less than can be seen."""
    a, b = rng.uniform(0.2, 1.8, (2, 2))
    lines = [move(np.stack([a, b]))]
    for _ in range(rng.integers(1, 4)):
        lines.append(places_off(rng, lines[-1]))
    points = np.concatenate([move(SQUARE), *lines])
    segments = ring(4) + [(4 + 2 * k, 5 + 2 * k) for k in range(len(lines))]
    return (points, segments), ()


def beside_points(rng, move):
    """Points, alone or corners of holes, an ulp off a side or an inner line."""
    a, b = rng.uniform(0.2, 1.8, (2, 2))
    on_line = move(a + rng.uniform(0.05, 0.95, (rng.integers(1, 5), 1)) * (b - a))
    on_side = move(np.array([[rng.uniform(0.1, 1.9), 0.0]]))
    points = np.concatenate([move(SQUARE), move(np.stack([a, b])), places_off(rng, on_line)])
    if rng.random() < 0.5:
        points = np.concatenate([points, places_off(rng, on_side)])
    return (points, [*ring(4), (4, 5)]), ()


def thin(rng, move):
    """A domain that is all as thin as that."""
    a, b = rng.uniform(0, 2, (2, 2))
    shares = np.sort(rng.uniform(0, 1, rng.integers(1, 6)))
    low = move(np.array([a, *(a + shares[:, None] * (b - a)), b]))
    high = places_off(rng, move(np.array([b + 0.0, *(b + shares[:, None] * (a - b))])))
    return figure(np.concatenate([low, high[1:]])), "nesting"


def touching(rng, move):
    """Parts that touch in points, and others that miss each other by rounding."""
    squares = [np.array([(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]) for i, j in
               [(0, 0), (1, 1), (2, 0), (0, 2), (2, 2)]]  # fmt: skip
    points = np.concatenate([move(s) for s in squares])
    if rng.random() < 0.7:
        k = rng.integers(len(points))
        points[k] = places_off(rng, points[k])
    points, number = np.unique(points, axis=0, return_inverse=True)
    segments = number.ravel()[[e for k in range(5) for e in ring(4, 4 * k)]]
    return (points, segments), "nesting"


STRAIGHT = [slit, needle, neighbours, interfaces, beside_points, thin, touching]


def straight(rng, transform, offset):
    """A domain of points and segments; None if what came out is none."""
    kind = STRAIGHT[rng.integers(len(STRAIGHT))]
    for _ in range(TRIES):
        (points, segments), holes = kind(rng, lambda p: transform(p) + offset)
        try:
            return kind.__name__, am.Domain(points, segments, holes)
        except am.DomainError:
            pass
    return kind.__name__, None


def periodic(rng, transform, offset):
    """Two sides that correspond, and a hole, or a line, along one of them."""
    corners = transform(SQUARE) + offset
    t = np.sort(rng.uniform(0.1, 0.9, 2))
    on_left = corners[3] + t[:, None] * (corners[0] - corners[3])
    inwards = rng.choice([1e-15, 3e-15, 1e-12]) * (corners[1] - corners[0])
    inner = np.concatenate([places_off(rng, on_left + inwards), corners.mean(axis=0)[None]])
    points = np.concatenate([corners, inner])
    segments = [*ring(4), *(ring(3, 4) if rng.random() < 0.5 else [(4, 5), (5, 6)])]
    try:
        domain = am.Domain(points, segments, names={"left": [3], "right": [1]})
        return "periodic", domain.with_periodic("left", "right")
    except am.DomainError:
        return "periodic", None


def curved(rng, transform, offset):
    """Circles and arcs whose chords come as near to others as can be told, or nearer."""
    centre = transform(np.array([1.0, 1.0])) + offset
    scale = transform.scale
    # Between, chords are told apart by making them many, and the exact check of them is slow.
    gap = 10.0 ** rng.choice([rng.uniform(-15, -12.5), rng.uniform(-3.5, -1)])
    kind = rng.integers(4)
    if kind == 0:  # a ring
        curves = [Circle(centre, scale), Circle(centre, scale * (1 - gap))]
    elif kind == 1:  # a half disc with a line, or an arc, along its arc
        a = rng.uniform(0, 6)
        b = a + rng.uniform(0.01, 3)
        arc = Arc(centre, scale, a, b)
        ends = arc.point(np.array([1.0, 0.0]))
        other = Arc(centre, scale * (1 - gap), a + 0.3 * (b - a), a + 0.5 * (b - a))
        line = Line(*other.point(np.array([0.0, 1.0])))
        curves = [arc, Line(ends[0], ends[1]), other if rng.random() < 0.5 else line]
    elif kind == 2:  # between two arcs that bulge differently by as much as the gap
        a, b = transform(rng.uniform(0, 2, (2, 2))) + offset
        side = np.array([a[1] - b[1], b[0] - a[0]])
        curves = [Spline([a, 0.5 * (a + b) + h * side, b]) for h in (0.2, 0.2 * (1 + gap))]
    else:  # a line that is tangent to a circle but for the gap
        t = rng.uniform(0, 6)
        n = np.array([np.cos(t), np.sin(t)])
        foot = centre + scale * (1 - gap) * rng.choice([1.0, 0.5]) * n
        along = 0.1 * scale * np.sqrt(gap) * np.array([-n[1], n[0]])
        curves = [Circle(centre, scale), Line(foot - along, foot + along)]
    try:
        return "curved", am.Domain.from_curves(curves, holes="nesting" if kind == 0 else ())
    except am.DomainError:
        return "curved", None


def size_of(rng, domain):
    """A size, or a metric, that gives at most some hundred triangles."""
    extent = float(np.ptp(domain.points, axis=0).max())
    h = extent * 10 ** rng.uniform(-1.3, 0.3)
    if rng.random() < 0.6:
        return h
    angle, ratio = rng.uniform(0, np.pi), 10 ** rng.uniform(0, 1.5)
    c, s, a, b = np.cos(angle), np.sin(angle), h**-2, (h * ratio) ** -2
    tensor = np.array([a * c * c + b * s * s, (a - b) * c * s, a * s * s + b * c * c])
    return lambda x: np.tile(tensor, (len(x), 1))


def random_domain(seed):
    """The kind, the domain or None if it is none, and the source of further choices."""
    rng = np.random.default_rng(seed)
    transform = TRANSFORMS[rng.integers(len(TRANSFORMS))]
    offset = rng.choice([0.0, 0.0, 1e3, 1e6]) * transform.scale * rng.uniform(-1, 1, 2)
    make = [straight, straight, straight, straight, periodic, curved][rng.integers(6)]
    return *make(rng, transform, offset), rng


def faults(domain, mesh):
    """What is wrong with a mesh of a domain."""
    out = faults_of_mesh(mesh)
    if out or domain.curved.curves:
        return out
    is_rings = domain.nesting and (np.bincount(domain.segments.ravel()) == 2).all()
    area = area_of_rings(domain.points, domain.segments) if is_rings else None
    out = faults_of_segments(mesh, domain.points, domain.segments, area)
    for pairs in mesh.periodic_vertices().values():
        if len(np.unique(pairs[:, 1])) < len(pairs):
            out.append("two vertices have the same image")
    for name, other in mesh.periodic_vertices():
        counts = [len(mesh.edges_named(n)) for n in (name, other)]
        if counts[0] != counts[1]:
            out.append(f"{counts} edges on periodic sides")
    return out


def check(seed):
    """Make a domain, mesh it, and fit the mesh to another size in one of two ways.

    Returns the kind and what came of it: "no domain", "refused" (curves only), "meshed", or what is
    wrong.
    """
    kind, domain, rng = random_domain(seed)
    if domain is None:
        return kind, "no domain"
    try:
        mesh = am.generate(domain, size_of(rng, domain))
    except am.DomainError as error:
        return kind, "refused" if domain.curved.curves else f"FAILED: {error}"
    wrong = faults(domain, mesh)
    if not wrong:
        try:
            mesh = am.adapt(mesh, size_of(rng, domain), keep=bool(rng.random() < 0.8))
        except am.DomainError as error:
            return kind, "refused" if domain.curved.curves else f"FAILED: {error}"
        wrong = [f"adapted: {w}" for w in faults(domain, mesh)]
    return kind, f"FAILED: {wrong}" if wrong else "meshed"
