"""Domains with periodic boundaries, and whether a mesh has the same vertices on both."""

import numpy as np

import adaptmesh as am
from adaptmesh.curves import Arc, Line, Spline


def by(dx, dy):
    return lambda x: x + np.array([dx, dy])


def wave(x0):
    y = np.linspace(0, 1, 9)
    return Spline(np.stack([x0 + 0.1 * np.sin(2 * np.pi * y), y], axis=1))


def wavy_channel():
    curves = [wave(0), Line((0, 0), (1, 0)), wave(1), Line((0, 1), (1, 1))]
    names = {"left": [0], "bottom": [1], "right": [2], "top": [3]}
    return am.Domain.from_curves(curves, names=names)


def sector(degrees=60.0):
    """Between radii 1 and 2, curved sides as of a turbine blade."""
    a = np.radians(degrees)
    turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
    side = np.array([[1, 0], [1.3, 0.15], [1.7, 0.1], [2, 0]])
    curves = [Arc((0, 0), 1, 0, a), Arc((0, 0), 2, 0, a), Spline(side), Spline(side @ turn.T)]
    names = {"hub": [0], "shroud": [1], "low": [2], "high": [3]}
    return am.Domain.from_curves(curves, names=names)


def assert_periodic(mesh, first, second, motion, atol=1e-12):
    pairs = mesh.periodic_vertices()[first, second]
    a, b = (set(np.unique(mesh.edges_named(name)).tolist()) for name in (first, second))
    assert set(pairs[:, 0].tolist()) == a
    assert set(pairs[:, 1].tolist()) == b
    assert len(pairs) == len(a) == len(b)
    np.testing.assert_allclose(
        motion(mesh.points[pairs[:, 0]]), mesh.points[pairs[:, 1]], atol=atol
    )
    # the edges correspond as well
    image = dict(pairs.tolist())
    edges = {frozenset((image[p], image[q])) for p, q in mesh.edges_named(first).tolist()}
    assert edges == {frozenset(e) for e in mesh.edges_named(second).tolist()}
    assert mesh.validate().ok
