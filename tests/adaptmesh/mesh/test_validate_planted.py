"""Faults of every kind, planted in meshes of every kind, wherever they lie: found and named."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from reference.planted import FAULTS, HARMLESS
from reference.transforms import TRANSFORMS, Transform

import adaptmesh as am
from adaptmesh.curves import Arc, Circle, EllipticArc, Line, Spline

PLACEMENTS = [TRANSFORMS[i] for i in (0, 2, 3, 4, 6, 8)]


def plate(place: Transform) -> am.Mesh:
    """Straight: a hole, an interface, a line that ends inside, a point, frozen sides, names."""
    points = [(0, 0), (4, 0), (4, 3), (0, 3), (2, 0), (2.3, 3), (3, 1), (3.4, 1), (3.2, 1.6)]
    lone = [(0.5, 0.5), (1, 1.6), (1.5, 2.2)]
    segments = [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5), (6, 7), (7, 8), (8, 6)]
    domain = am.Domain(
        place(points + lone),
        [*segments, (10, 11)],
        holes=[place([3.2, 1.2])],
        regions={"left": place([1, 1]), "right": place([3.8, 2])},
        names={"inlet": [5], "interface": [6], "hole": [7, 8, 9], "fin": [10]},
    ).with_frozen("hole", segments=[0])
    return am.generate(domain, 0.5 * place.scale)


def ring(place: Transform) -> am.Mesh:
    """Curved: an ellipse around a spline and a circle, parted by a line and an arc."""
    if not np.isclose(abs(place.determinant), place.scale**2) or "sheared" in place.name:
        return None
    d = np.array(place.matrix) / place.scale
    turn = np.arctan2(d[1, 0], d[0, 0])
    flip = np.sign(place.determinant)
    p = lambda *xy: place(np.array(xy, float))  # noqa: E731

    def arc(centre, radius, start, end):
        angles = turn + flip * np.array([start, end])
        return Arc(p(*centre), radius * place.scale, *angles)

    bump = Spline(place([(-2, 0), (-1.2, -0.25), (-0.4, 0.3), (0.3, 0.2)]))
    domain = am.Domain.from_curves(
        [
            arc((0, 0), 2, 0, np.pi),
            arc((0, 0), 2, np.pi, 2 * np.pi),
            bump,
            Line(p(0.3, 0.2), p(2, 0)),
            Circle(p(0.2, 1.1), 0.3 * place.scale),
            EllipticArc(p(0, -1), np.array([0.7, 0.3]) * place.scale, turn + flip * 0.3),
        ],
        names={"top": [0], "bottom": [1], "bump": [2, 3], "hole": [4]},
        regions={"north": p(-1, 1), "south": p(-1.2, -1)},
        points=[p(1.2, 0.8)],
    )
    return am.generate(domain, 0.3 * place.scale)


def channel(place: Transform) -> am.Mesh:
    """Periodic: one pair of sides is straight, the other wavy."""
    if "sheared" in place.name:
        return None
    x = np.linspace(0, 2, 9)
    wave = lambda y: Spline(place(np.stack([x, y + 0.1 * np.sin(np.pi * x)], axis=1)))  # noqa: E731
    c = place([(0, 0), (2, 0), (2, 1), (0, 1)])
    domain = am.Domain.from_curves(
        [wave(0.0), Line(c[1], c[2]), wave(1.0), Line(c[3], c[0])],
        names={"low": [0], "right": [1], "high": [2], "left": [3]},
        regions={"fluid": place([1, 0.6])},
    )
    domain = domain.with_periodic("left", "right").with_periodic("low", "high")
    return am.generate(domain, 0.2 * place.scale)


CASES = {"plate": plate, "ring": ring, "channel": channel}


@cache
def mesh_of(case: str, place: Transform) -> am.Mesh:
    return CASES[case](place)


def meshes() -> list[am.Mesh]:
    """All cases in all places; circles are no circles where the plane is sheared."""
    found = [mesh_of(case, place) for case in CASES for place in PLACEMENTS]
    return [mesh for mesh in found if mesh is not None]


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("name", HARMLESS)
def test_right_meshes_are_valid(name):
    for mesh in meshes():
        validity = HARMLESS[name](mesh).validate()
        assert validity.ok, str(validity)


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("name", FAULTS)
def test_faults_are_found_and_named_with_their_place(name):
    planted = [plant for mesh in meshes() if (plant := FAULTS[name](mesh)) is not None]
    assert len(planted) >= 5
    for broken, invariants, place in planted:
        validity = broken.validate()
        named = [check for check in validity.broken if check.name in invariants]
        assert named, f"expected one of {invariants} broken:\n{validity}"
        assert any(place in str(check.offenders) for check in named) or not place, str(validity)


def test_there_are_many_kinds_of_faults():
    assert len(FAULTS) >= 40
