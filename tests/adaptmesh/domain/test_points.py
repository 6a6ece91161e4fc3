"""Pairs of points of a domain of curves remember their curves, `domain.points[domain.segments]`."""

import copy
import pickle

import numpy as np
import pytest
from reference.transforms import TRANSFORMS, Moved

import metrics
from adaptmesh import Domain, Mesh, generate
from adaptmesh.curves import Arc, Circle, Line


def plate(transform=None):
    """A half disc with a hole: an arc, a straight side, a circle; the arc ends at corners."""
    curves = [
        Arc((0.0, 0.0), 2.0, 0.0, np.pi),
        Line((-2.0, 0.0), (2.0, 0.0)),
        Circle((0.0, 1.0), 0.5),
    ]
    if transform is not None:
        curves = [Moved(curve, transform) for curve in curves]
    return Domain.from_curves(curves, names={"arc": [0], "floor": [1], "hole": [2]})


def on_hole(transform, n=400):
    a = np.linspace(0, 2 * np.pi, n)
    return transform(np.stack([0.5 * np.cos(a), 1 + 0.5 * np.sin(a)], axis=1))


def on_arc(transform, n=400):
    a = np.linspace(0, np.pi, n)
    return transform(2 * np.stack([np.cos(a), np.sin(a)], axis=1))


def rows(domain, name):
    return domain.segments[domain.segment_tags == domain.names[name]]


def off(geometry, places):
    return metrics.Geometry(geometry).distances(places).max()


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_distances_are_those_from_the_curves(transform):
    domain = plate(transform)
    extent = np.ptp(np.asarray(domain.points), axis=0).max()
    small = 1e-8 * extent + 100 * np.spacing(np.abs(domain.points).max())
    hole, arc = rows(domain, "hole"), rows(domain, "arc")
    assert off(np.asarray(domain.points)[hole], on_hole(transform)) > 1e-4 * extent  # the chords
    assert off(domain.points[hole], on_hole(transform)) < small
    assert off(domain.points[arc], on_arc(transform)) < small
    assert off(domain.points[domain.segments], on_hole(transform)) < small
    for chosen in (hole[:, ::-1], hole[::-1], hole.tolist(), hole.astype(np.uint8)):
        assert off(domain.points[chosen], on_hole(transform)) < small
    assert off(domain.points[hole - len(domain.points)], on_hole(transform)) < small
    assert off(domain.points[hole, :], on_hole(transform)) < small
    straight = domain.points[rows(domain, "floor")]
    places = transform(np.stack([np.linspace(-2, 2, 30), np.zeros(30)], axis=1))
    assert off(straight, places) < small


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_rows_of_pairs_and_pairs_one_by_one(transform):
    domain = plate(transform)
    extent = np.ptp(np.asarray(domain.points), axis=0).max()
    small = 1e-8 * extent + 100 * np.spacing(np.abs(domain.points).max())
    is_hole = domain.segment_tags == domain.names["hole"]
    everything = domain.points[domain.segments]
    assert off(everything[is_hole], on_hole(transform)) < small
    assert off(everything[np.flatnonzero(is_hole)], on_hole(transform)) < small
    assert off(list(everything[is_hole]), on_hole(transform)) < small
    assert off([domain.points[s] for s in rows(domain, "hole")], on_hole(transform)) < small
    assert off(everything[is_hole].copy(), on_hole(transform)) < small
    walls = [domain.points[rows(domain, name)] for name in ("arc", "hole")]
    assert off(walls, on_arc(transform)) < small
    for join in (np.concatenate, np.vstack, tuple):
        assert off(join(walls), on_arc(transform)) < small
        assert off(join(walls), on_hole(transform)) < small
    singly = np.stack([domain.points[s] for s in rows(domain, "hole")])
    assert off(singly, on_hole(transform)) < small
    half = rows(domain, "hole")[::2]  # every other chord, each with its curve
    d = metrics.Geometry(domain.points[half]).distances(on_hole(transform))
    assert (d < small).sum() > 150 and d.max() > 1e-3 * extent


def test_orientation_and_repetition_do_not_change_what_is_measured():
    domain = plate()
    hole = rows(domain, "hole")
    rng = np.random.default_rng(3)
    places = rng.uniform((-2, 0), (2, 2), (200, 2))
    d = metrics.Geometry(domain.sides("hole")).distances(places)
    turned = np.where((np.arange(len(hole)) % 2)[:, None], hole[:, ::-1], hole)
    for chosen in (hole, turned, np.concatenate([hole, hole[:3]])):
        np.testing.assert_allclose(
            metrics.Geometry(domain.points[chosen]).distances(places), d, rtol=1e-12, atol=1e-14
        )
    pieces = domain.points[turned].cubic_pieces()
    ends = np.concatenate([np.asarray(domain.points)[turned].reshape(-1, 2)])
    starts = pieces.ends[:, 0]
    assert (np.abs(starts[:, None] - ends).max(axis=2).min(axis=1) < 0.5).all()
    # a piece leaves its start in the direction of its derivative there
    step = ((pieces.ends[:, 1] - starts) * pieces.derivatives[:, 0]).sum(axis=1)
    assert (step > 0).all()


def test_pairs_that_are_no_segments_are_straight():
    domain = plate()
    hole = rows(domain, "hole")
    across = np.stack([hole[:, 0], np.roll(hole[:, 0], 5)], axis=1)
    places = np.random.default_rng(0).uniform((-2, 0), (2, 2), (100, 2))
    np.testing.assert_array_equal(
        metrics.Geometry(domain.points[across]).distances(places),
        metrics.Geometry(np.asarray(domain.points)[across]).distances(places),
    )


def test_pairs_whose_coordinates_are_changed_are_plain():
    domain = plate()
    hole = domain.points[rows(domain, "hole")]
    moved = hole + np.array([0.25, 0.0])
    assert type(moved) is np.ndarray
    kept = hole.copy()
    kept *= 2.0
    changed = domain.points[rows(domain, "hole")]
    np.asarray(changed)[0, 0] += 0.5
    apart = np.concatenate([hole, hole], axis=1)
    turned = np.concatenate([hole, np.zeros((1, 2, 2))])
    assert not hasattr(apart, "cubic_pieces") and not hasattr(turned, "cubic_pieces")
    for array in (moved, kept, changed):
        assert not hasattr(array, "cubic_pieces")
        metrics.Geometry(array)


def test_all_else_is_a_plain_array():
    domain = plate()
    p, pairs = domain.points, domain.points[domain.segments]
    for result in (
        p[0], p[1:3], p[:, 0], p[[0, 1, 2]], p[domain.triangles], p[p[:, 0] > 0], p + 1, 2 * p,
        -p, np.hypot(*p.T), p.min(axis=0), p.mean(axis=0), p @ np.eye(2), np.asarray(p),
        np.ptp(p, axis=0), pairs[:, 0], pairs[:, 1] - pairs[:, 0], pairs.mean(axis=1), pairs * 2,
        pairs[..., 0], np.asarray(pairs), np.array(p),
    ):  # fmt: skip
        assert type(result) is np.ndarray or np.isscalar(result), type(result)
    for result in (p.T, p.copy(), p.reshape(-1), np.concatenate([p, p]), pairs.reshape(-1, 2)):
        assert not hasattr(result, "cubic_pieces")
    assert not hasattr(p, "cubic_pieces")
    assert float(p[0, 0]) == p.tolist()[0][0]
    with pytest.raises(ValueError, match="read-only"):
        p[0] = 0
    with pytest.raises(IndexError):
        p[[[0, 10**6]]]


def test_copies_and_pickles_are_as_before():
    domain = plate()
    for again in (copy.copy(domain), copy.deepcopy(domain), pickle.loads(pickle.dumps(domain))):
        assert again == domain
        hole = again.points[rows(again, "hole")]
        assert off(hole, on_hole(lambda x: x)) < 1e-8
    assert type(pickle.loads(pickle.dumps(domain.points))) is np.ndarray
    assert type(pickle.loads(pickle.dumps(domain.points[domain.segments]))) is np.ndarray


def test_domains_of_segments_and_meshes_have_plain_points():
    square = Domain.rectangle(0, 0, 1, 1)
    assert type(square.points) is np.ndarray
    assert type(square.points[square.segments]) is np.ndarray
    mesh = generate(plate(), 0.5)
    assert isinstance(mesh, Mesh)
    assert type(mesh.points) is np.ndarray and type(mesh.points[mesh.edges]) is np.ndarray


@pytest.mark.parametrize("transform", [t for t in TRANSFORMS if "1e" not in str(t)], ids=str)
def test_layers_have_the_first_height_at_the_curve(transform):
    domain = plate(transform)
    first = 1e-4 * transform.scale
    layer = metrics.BoundaryLayer(
        domain.points[rows(domain, "hole")], first, 1.2, 500 * first, h_max=2000 * first
    )
    smaller = metrics.tensor.sizes(layer(on_hole(transform, 721)))[:, 0]
    assert smaller.max() < 1.001 * first and smaller.min() > 0.999 * first
