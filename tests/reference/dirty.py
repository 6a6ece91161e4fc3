"""Random dirty outlines, each from a seed, and what has to come of every one of them."""

import re

import numpy as np
import shapely
from reference import winding

import adaptmesh as am
from adaptmesh.convert import to_shapely

SCALES = [1e-6, 1e-3, 1.0, 1e3, 1e6]
OFFSETS = [0.0, 1.0, 1e3, 1e6]  # times the scale


def dirty_outline(seed):
    """(what it is, what `repair` takes): a ring, rings, or polygons."""
    rng = np.random.default_rng(seed)
    kind = list(MAKERS)[seed % len(MAKERS)]
    shift = rng.choice(OFFSETS) * rng.uniform(-1, 1, 2)
    return kind, placed(MAKERS[kind](rng), rng.choice(SCALES), shift)


def placed(outline, scale, shift):
    if isinstance(outline, am.Outline):
        points = placed(outline.points, scale, shift)
        return am.Outline(points, outline.segments, outline.holes, names=outline.names)
    if isinstance(outline, dict):
        return {name: placed(polygon, scale, shift) for name, polygon in outline.items()}
    if isinstance(outline, list):
        return [placed(ring, scale, shift) for ring in outline]
    return scale * (outline + shift)


def random_polygon(rng):
    return rng.uniform(0, 1, (rng.integers(3, 60), 2))


def lattice_polygon(rng):
    """Many points and segments that coincide exactly."""
    return rng.integers(0, rng.integers(2, 7), (rng.integers(3, 40), 2)) / 4.0


def star(rng, n=None, radius=0.3, wild=0.3):
    n = n or rng.integers(5, 80)
    angle = np.sort(rng.uniform(0, 2 * np.pi, n))
    r = radius * (1 + wild * rng.uniform(-1, 1, n))
    return rng.uniform(0.3, 0.7, 2) + np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1)


def near_duplicates(rng):
    """Points repeated, exactly or moved by about a tolerance."""
    ring = np.repeat(star(rng), rng.integers(1, 4), axis=0)
    return ring + rng.choice([0, 1e-12, 1e-9, 1e-8]) * rng.standard_normal(ring.shape)


def spikes(rng):
    """Lines there and back, in and out, some of them not quite on themselves."""
    ring = list(star(rng))
    for _ in range(rng.integers(1, 6)):
        i = rng.integers(len(ring))
        tip = ring[i] + rng.uniform(-0.3, 0.3, 2)
        back = ring[i] + rng.choice([0, 1e-13, 1e-10, 1e-6]) * rng.standard_normal(2)
        ring[i + 1 : i + 1] = [tip, back]
    return np.array(ring)


def slivers(rng):
    """A band that returns beside itself at a distance about the tolerance."""
    x = np.sort(rng.uniform(0, 1, rng.integers(3, 30)))
    y = 0.1 * np.sin(9 * x)
    width = rng.choice([1e-13, 1e-10, 5e-10, 1e-9, 2e-9, 1e-6])
    back = np.stack([x, y + width * rng.uniform(0.5, 1.5, len(x))], axis=1)[::-1]
    return np.concatenate([np.stack([x, y], axis=1), back, [(0.0, 1.0), (-0.5, 0.5)]])


def holes(rng):
    """Holes that cross, touch, leave and repeat each other."""
    rings = [star(rng, radius=0.5)]
    rings += [star(rng, radius=rng.uniform(0.05, 0.3)) for _ in range(rng.integers(1, 6))]
    if rng.random() < 0.5:
        rings.append(rings[-1][::-1].copy())
    return rings


def coverage(rng):
    """Neighbours that overlap, or miss each other by about a tolerance."""
    n = rng.integers(2, 5)
    edge = np.linspace(0, 1, n + 1)
    out = {}
    for i in range(n):
        for j in range(n):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            ring = np.array([(edge[a], edge[b]) for a, b in corners])
            ring += rng.choice([0, 1e-13, 3e-10, 1e-9, 1e-2]) * rng.standard_normal(ring.shape)
            ring = np.insert(ring, 1, ring[:2].mean(axis=0), axis=0)
            out[f"{i} {j}"] = ring[:: rng.choice([-1, 1])]
    return out


def fan(rng):
    """Needles that meet in a point, and many lines nearly through one."""
    n = rng.integers(4, 30)
    angle = rng.permutation(np.linspace(0, np.pi, n)) + rng.normal(0, 1e-3)
    far = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    blur = rng.choice([0, 1e-14, 1e-10]) * rng.standard_normal((n, 2))
    return np.stack([far, blur - far], axis=1).reshape(-1, 2)


def parallel(rng):
    """Segments that overlap over and over in nearly one line."""
    n = rng.integers(3, 40)
    slope = rng.uniform(-1, 1)
    x = rng.uniform(0, 1, n)
    y = slope * x + rng.choice([1e-16, 1e-12, 1e-9]) * rng.standard_normal(n)
    return np.concatenate([np.stack([x, y], axis=1), [(0.5, 2.0)]])


def segments(rng):
    """A frame with named lines in it that cross, overlap and nearly meet it and each other."""
    points = [(0, 0), (1, 0), (1, 1), (0, 1)]
    pairs = [(0, 1), (1, 2), (2, 3), (3, 0)]
    blur = rng.choice([0, 1e-13, 1e-10, 1e-9])
    for _ in range(rng.integers(1, 20)):
        n = len(points)
        start = rng.choice([0.0, 0.25, 0.5, 1.0], 2) if rng.random() < 0.5 else rng.random(2)
        end = np.array([rng.choice([0.0, 1.0]), rng.random()])[:: rng.choice([-1, 1])]
        points += [np.clip(start + blur * rng.standard_normal(2), 0, 1), np.clip(end, 0, 1)]
        pairs.append((n, n + 1))
        if rng.random() < 0.2:
            pairs.append(pairs[rng.integers(len(pairs))])
    owner = rng.integers(0, 3, len(pairs))
    names = {str(k): np.flatnonzero(owner == k).tolist() for k in range(3)}
    return am.Outline(np.array(points), np.array(pairs), holes=[], names=names)


MAKERS = {
    maker.__name__: maker
    for maker in (
        random_polygon,
        lattice_polygon,
        near_duplicates,
        spikes,
        slivers,
        holes,
        coverage,
        fan,
        parallel,
        segments,
    )
}


def check(seed):
    """What came of an outline, (its kind, that, the error of the area); see `check_outline`."""
    kind, dirty = dirty_outline(seed)
    return kind, *check_outline(dirty)


def check_outline(dirty):
    """Repair an outline, mesh it, and hold it against shapely; returns what came of it.

    "refused" is fine if the message has a place. Anything that may not be raises.
    """
    try:
        domain, repairs = am.repair(dirty)
    except am.DomainError as error:
        assert re.search(r"at \(-?\d", str(error)), f"no place in: {error}"
        return "refused", 0.0
    area = sum(polygon.area for polygon in to_shapely(domain).values())
    assert_all_is_there(dirty, domain, repairs)
    mesh = am.generate(domain, np.ptp(domain.points, axis=0).max() / 8)
    assert mesh.validate().ok, str(mesh.validate())
    error = abs(mesh.areas.sum() / area - 1)
    assert error < 1e-9 + rounding(domain), f"area {mesh.areas.sum()!r} instead of {area!r}"
    assert abs(domain.area / area - 1) < 1e-12 + rounding(domain)
    return "repaired" if repairs else "clean", error


def rounding(domain):
    """What the rounding of new points on the boundary can do to its area, relatively."""
    p = domain.points[domain.pieces]
    length = np.hypot(*(p[:, 1] - p[:, 0]).T).sum()
    return np.finfo(float).eps * np.abs(domain.points).max() * length / domain.area


def assert_all_is_there(dirty, domain, repairs):
    """Names are there, and the area is that of what the rings wind around."""
    if isinstance(dirty, am.Outline):
        lost = [record for record in repairs if record.kind == "name lost"]
        used = {name for name, mine in dirty.names.items() if len(mine)}
        tags = {name for name, tag in domain.names.items() if (domain.segment_tags == tag).any()}
        assert len(used) <= len(tags) + len(lost)
        expected, p = shapely.box(*bounds(dirty.points)).area, dirty.points[dirty.segments]
        length = np.hypot(*(p[:, 1] - p[:, 0]).T).sum()
    else:
        expected, length = area_and_length(dirty)
    slack = 4 * max(repairs.displacement, repairs.tolerance) * length
    assert abs(domain.area - expected) <= slack, f"area {domain.area} instead of {expected}"


def area_and_length(dirty):
    """The area of polygons or of a polygon with holes, and the length of all rings."""
    rings = list(dirty.values()) if isinstance(dirty, dict) else dirty
    rings = rings if isinstance(rings, list) else [rings]
    rings = [ring - rings[0][0] for ring in rings]
    length = sum(shapely.LinearRing(ring).length for ring in rings)
    if isinstance(dirty, dict):
        return winding.area(rings, lambda number: number.any()), length
    depth = hole_depths(rings, 1e-13 * length * np.ptp(rings[0], axis=0).max())

    def is_inside(number):
        holes = np.flatnonzero(number[1:])
        return number[0] != 0 and (len(holes) == 0 or depth[holes].max() % 2 == 1)

    return winding.area(rings, is_inside), length


def hole_depths(rings, slack):
    """How many other holes each hole lies in."""
    n = len(rings) - 1
    outside = np.full((n, n), np.inf)  # of hole i, the area that is not in hole j
    for i in range(n):
        for j in range(n):
            if i != j:
                pair = [rings[i + 1], rings[j + 1]]
                outside[i, j] = winding.area(pair, lambda w: w[0] != 0 and w[1] == 0)
    return ((outside <= slack) & (slack < outside.T)).sum(axis=1)


def bounds(points):
    return (*points.min(axis=0), *points.max(axis=0))
