"""Periodic boundaries get vertices that correspond, in every mesh."""

import numpy as np
import pytest
from reference.periodic import assert_periodic, by, sector, wave, wavy_channel

import adaptmesh as am
from adaptmesh.curves import Line
from adaptmesh.errors import DomainError


def sizes(x):
    """Finer to the left, and not the same on both sides."""
    return 0.02 + 0.1 * x[:, 0] + 0.05 * x[:, 1] ** 2


def test_a_square_periodic_both_ways():
    square = am.Domain.rectangle(0, 0, 1, 1)
    domain = square.with_periodic("left", "right").with_periodic("bottom", "top")
    mesh = am.generate(domain, sizes)
    for _ in range(3):
        assert_periodic(mesh, "left", "right", by(1, 0))
        assert_periodic(mesh, "bottom", "top", by(0, 1))
        mesh = am.adapt(mesh, sizes(mesh.points))
    # fine enough for both sides: "left" asks for the smaller sizes
    alone = am.generate(square, sizes)
    assert len(mesh.edges_named("right")) >= len(alone.edges_named("left"))
    assert not square.periodic


def test_slanted_sides_in_pieces():
    """A parallelogram, a point on one of its sides; the other direction of each segment."""
    points = [(0, 0), (2, 0), (2.5, 1), (0.5, 1), (0.25, 0.5), (2.25, 0.5)]
    domain = am.Domain(
        points,
        [(0, 1), (2, 1), (2, 3), (0, 4), (3, 4)],
        names={"a": [3, 4], "b": [1]},
    )
    mesh = am.generate(domain.with_periodic("a", "b"), sizes)
    assert_periodic(mesh, "a", "b", by(2, 0))


def test_curved_sides():
    mesh = am.generate(wavy_channel().with_periodic("left", "right"), sizes)
    for _ in range(2):
        assert_periodic(mesh, "left", "right", by(1, 0))
        mesh = am.adapt(mesh, 0.5 * sizes(mesh.points))


def test_rotation():
    domain = sector().with_periodic("low", "high", rotation=60)
    a = np.radians(60)
    turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
    mesh = am.generate(domain, lambda x: 0.02 + 0.05 * np.abs(x[:, 1]))
    assert_periodic(mesh, "low", "high", lambda x: x @ turn.T)


def test_a_side_that_needs_more_chords_takes_the_other_along():
    """An island close to one side only."""
    y = np.linspace(0.3, 0.7, 9)
    near = np.stack([0.012 + 0.1 * np.sin(2 * np.pi * y), y], axis=1)
    island = np.concatenate([near, [[0.4, 0.7], [0.4, 0.3]]])
    curves = [wave(0), Line((0, 0), (1, 0)), wave(1), Line((0, 1), (1, 1))]
    ring = np.roll(island, -1, axis=0)
    curves += [Line(a, b) for a, b in zip(island, ring, strict=True)]
    domain = am.Domain.from_curves(curves, names={"left": [0], "right": [2]})
    mesh = am.generate(domain.with_periodic("left", "right"), 0.4)
    assert_periodic(mesh, "left", "right", by(1, 0))


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_at_any_scale(scale):
    domain = am.Domain.rectangle(0, 0, scale, scale).with_periodic("left", "right")
    mesh = am.generate(domain, lambda x: scale * sizes(x / scale))
    assert_periodic(mesh, "left", "right", by(scale, 0), atol=1e-12 * scale)


def test_what_does_not_correspond_is_named():
    square = am.Domain.rectangle(0, 0, 1, 1)
    with pytest.raises(DomainError, match="no boundary is named 'lef'"):
        square.with_periodic("lef", "right")
    with pytest.raises(DomainError, match="with itself"):
        square.with_periodic("left", "left")
    with pytest.raises(DomainError, match="check the motion"):
        square.with_periodic("left", "bottom")
    with pytest.raises(DomainError, match=r"would be carried to \(2, "):
        square.with_periodic("left", "right", translation=(2, 0))
    with pytest.raises(DomainError, match="periodic already"):
        square.with_periodic("left", "right").with_periodic("right", "top")
    with pytest.raises(DomainError, match="not both"):
        square.with_periodic("left", "right", translation=(1, 0), rotation=90)
    with pytest.raises(DomainError, match="two finite numbers"):
        square.with_periodic("left", "right", translation=(np.nan, 0))
    with pytest.raises(DomainError, match="rotation=inf: expected a finite number"):
        square.with_periodic("left", "bottom", rotation=np.inf)
    quarter = square.with_periodic("left", "bottom", rotation=-90, centre=(0, 0), tolerance=1e-9)
    assert quarter.periodic[0].first == "left"
    divided = am.Domain(
        [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0.5)],
        [(0, 1), (1, 2), (2, 3), (3, 0)],
        names={"left": [3], "right": [1]},
    )
    with pytest.raises(DomainError, match="2 straight pieces"):
        divided.with_periodic("left", "right")
