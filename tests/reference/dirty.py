"""Random dirty outlines, each from a seed: what a repair has to cope with."""

import numpy as np

SCALES = [1e-6, 1e-3, 1.0, 1e3, 1e6]
OFFSETS = [0.0, 1.0, 1e3, 1e6]  # times the scale


def dirty_outline(seed):
    """(what it is, what `repair` takes): a ring, rings, or polygons."""
    rng = np.random.default_rng(seed)
    kind = list(MAKERS)[seed % len(MAKERS)]
    shift = rng.choice(OFFSETS) * rng.uniform(-1, 1, 2)
    return kind, placed(MAKERS[kind](rng), rng.choice(SCALES), shift)


def placed(outline, scale, shift):
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
    )
}
