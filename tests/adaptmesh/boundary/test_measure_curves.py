"""Metric lengths along curved sides, against sums over very many short steps."""

import numpy as np
import pytest
from reference.transforms import TRANSFORMS

import adaptmesh as am
import metrics
from adaptmesh.boundary.measure_curves import inscribed_chords, measure_parts
from adaptmesh.boundary.unit_polylines import unit_polylines
from adaptmesh.curves import Arc, BSpline, Line, Parametric
from adaptmesh.domain.sides.side import SidePoints

STEPS = 40_001


def bow(transform):
    """A wavy curve, a spline and two lines; the map is applied to points of the curves."""
    ends = transform(np.array([(0.0, 0), (3, 0), (3, 1), (0, 1)]))
    control = transform(np.array([(3.0, 1), (2, 2), (1, 0.7), (0, 1)]))

    def wave(t):
        return transform(np.stack([3 * t, 0.2 * np.sin(2 * np.pi * t)], axis=1))

    return am.Domain.from_curves(
        [Parametric(wave), Line(ends[1], ends[2]), BSpline(control), Line(ends[3], ends[0])]
    )


def turning(transform, rate, size, aspect):
    """Thin ellipses whose axes turn along x, in the coordinates of the map."""

    def tensors(points):
        angle = rate * transform.inverse(points)[:, 0]
        c, s = np.cos(angle), np.sin(angle)
        thin, long = size**-2.0, (size * aspect) ** -2.0
        return transform.metric(
            np.stack(
                [
                    thin * c * c + long * s * s,
                    (thin - long) * c * s,
                    thin * s * s + long * c * c,
                ],
                axis=1,
            )
        )

    return metrics.as_control_space(tensors)


def sum_of_steps(sides, side, metric):
    u = np.linspace(0, sides.lengths[side], STEPS)
    d = sides.derivative(np.full(STEPS - 1, side), 0.5 * (u[1:] + u[:-1]))
    m = metric(sides.point(np.full(STEPS - 1, side), 0.5 * (u[1:] + u[:-1])))
    squared = m[:, 0] * d[:, 0] ** 2 + 2 * m[:, 1] * d[:, 0] * d[:, 1] + m[:, 2] * d[:, 1] ** 2
    return np.sqrt(squared).sum() * u[1]


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
@pytest.mark.parametrize(
    ("rate", "size", "aspect"),
    [(0, 0.05, 1), (1, 0.02, 30), (2, 0.02, 1000), (-3, 0.05, 1e4), (7, 0.05, 1e3)],
    ids=str,
)
def test_lengths_along_curves(transform, rate, size, aspect):
    sides = bow(transform).all_sides
    metric = turning(transform, rate, size, aspect)
    parts = sides.whole().where(~sides.is_straight)
    found = measure_parts(sides, parts, inscribed_chords(sides, parts), metric, 10**7)
    for part, side in enumerate(parts.side.tolist()):
        length = found.length[found.part == part].sum()
        assert length == pytest.approx(sum_of_steps(sides, side, metric), rel=5e-3)


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_straight_and_curved_sides_are_cut_alike(transform):
    """A line, and a curve that runs along a line: as many vertices, at the same places."""
    a, b, c = transform(np.array([(0.0, 0), (2, 0), (1, 1)]))

    def along(t):
        return a + t[:, None] * (b - a)

    metric = metrics.as_control_space(
        lambda p: transform.scale * (0.02 + 0.05 * np.abs(transform.inverse(p)[:, 0] - 0.7))
    )
    rows = []
    for bottom in (Line(a, b), Parametric(along)):
        sides = am.Domain.from_curves([bottom, Line(b, c), Line(c, a)]).all_sides
        lines = unit_polylines(sides, sides.whole(), SidePoints.none(), metric, 10**6)
        on = np.flatnonzero((np.sort(sides.ends, axis=1) == sides_at(sides, a, b)).all(axis=1))
        points = sides.point(*lines.inner.where(lines.inner.side == on[0]))
        rows.append(np.sort(((points - a) @ (b - a)) / ((b - a) @ (b - a))))
    assert len(rows[0]) == len(rows[1]) > 20
    np.testing.assert_allclose(rows[0], rows[1], atol=2e-4)


def sides_at(sides, *points):
    at = [int(np.hypot(*(sides.corners - p).T).argmin()) for p in points]
    return sorted(at)


def test_images_of_a_periodic_arc_have_its_vertices():
    low, high = Arc((0, 0), 1, np.pi, 2 * np.pi), Arc((0, 3), 1, np.pi, 2 * np.pi)
    domain = am.Domain.from_curves(
        [low, Line((1, 0), (1, 3)), high, Line((-1, 3), (-1, 0))],
        names={"low": [0], "high": [2]},
    ).with_periodic("low", "high", translation=(0, 3))
    mesh = am.generate(domain, lambda p: 0.05 + 0.1 * np.abs(p[:, 1]))
    pairs = mesh.periodic_vertices()["low", "high"]
    assert len(pairs) > 25
    np.testing.assert_allclose(
        mesh.points[pairs[:, 0]] + [0, 3], mesh.points[pairs[:, 1]], atol=1e-12
    )


def test_periodic_sides_that_cannot_be_cut_alike_are_named(monkeypatch):
    """One side needs ever more vertices than its image: here as images are never accepted."""
    low, high = Arc((0, 0), 1, np.pi, 2 * np.pi), Arc((0, 3), 1, np.pi, 2 * np.pi)
    domain = am.Domain.from_curves(
        [low, Line((1, 0), (1, 3)), high, Line((-1, 3), (-1, 0))],
        names={"low": [0], "high": [2]},
    ).with_periodic("low", "high", translation=(0, 3))
    monkeypatch.setattr(
        "adaptmesh.boundary.unit_polylines._with_images",
        lambda sides, points, pairs: points.where(points.side != pairs[0][1]),
    )
    with pytest.raises(am.DomainError, match="'low' and 'high' cannot be cut alike"):
        am.generate(domain, 0.1)
