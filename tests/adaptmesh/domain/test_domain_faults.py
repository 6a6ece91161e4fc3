"""Every fault that the core can find has a sentence; curves within the join tolerance vanish."""

import re
from pathlib import Path

import numpy as np
import pytest
from adaptmesh._core import InputFault
from reference.transforms import SIMILARITIES

import adaptmesh as am
from adaptmesh.curves import Arc, Circle, Line
from adaptmesh.domain.messages import fault_text

CORE = Path(__file__).parents[3] / "adaptmesh" / "core"


def test_all_kinds_of_faults_are_found_somewhere():
    found = set()
    for path in CORE.rglob("*.cpp"):
        if path.parent.name != "bindings":
            found |= set(re.findall(r"InputFault::(\w+)", path.read_text()))
    assert found == {kind.name for kind in InputFault}


@pytest.mark.parametrize("kind", InputFault)
def test_every_fault_has_a_sentence_with_a_remedy(kind):
    square = am.Domain.rectangle(0, 0, 1, 1)
    text = fault_text(square, kind, 1, 2, 0.25, 0.75)
    assert kind.name not in text
    assert len(text.split()) >= 6


def outline(transform, gap):
    """A rectangle of area 2 as lines, closed by one that is as short as the gap."""
    corners = [(0, 0), (2, 0), (2, 1), (0, 1), (0, gap)]
    p = [tuple(transform(c)) for c in corners]
    return [Line(a, b) for a, b in zip(p, [*p[1:], p[0]], strict=True)]


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
@pytest.mark.parametrize("gap", [1e-3, 3e-7])
@pytest.mark.parametrize("ratio", [1.01, 3])
def test_curves_shorter_than_the_join_tolerance_vanish(transform, gap, ratio):
    tolerance = ratio * gap * transform.scale
    domain = am.Domain.from_curves(
        outline(transform, gap), names={"short": [4], "side": [3]}, join_tolerance=tolerance
    )
    assert domain.area == pytest.approx(2 * transform.scale**2, rel=2 * gap)
    assert len(domain.points) == 4
    mesh = am.generate(domain, 0.3 * transform.scale)
    assert am.validate(mesh), am.validate(mesh)
    assert len(mesh.edges_named("short")) == 0
    assert len(mesh.edges_named("side")) > 1
    if gap > 1e-6:  # a shorter one that stays would be refused far from the origin
        longer = am.Domain.from_curves(
            outline(transform, gap), join_tolerance=0.9 * gap * transform.scale
        )
        assert len(longer.points) == 5


def test_arcs_vanish_and_smooth_joints_stay_smooth():
    """Half circles joined by tiny pieces of them: still one smooth line."""
    half, t = np.pi, 1e-7
    curves = [
        Arc((0, 0), 1, 0, half),
        Arc((0, 0), 1, half, half + t),
        Arc((0, 0), 1, half + t, 2 * half),
    ]
    domain = am.Domain.from_curves(curves, join_tolerance=1e-6)
    assert np.count_nonzero(domain.curved.is_vertex) == 1
    assert domain.area == pytest.approx(np.pi, rel=1e-6)


def test_several_short_lines_vanish_together_and_what_they_would_close_is_refused():
    corners = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 2e-3), (0, 1e-3)]
    lines = [Line(a, b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    domain = am.Domain.from_curves(lines, join_tolerance=1.5e-3)
    assert len(domain.points) == 4
    x = np.linspace(0, 1, 11)
    ring = [(v, 0.0) for v in x] + [(0.5, 0.05)]
    lines = [Line(a, b) for a, b in zip(ring, [*ring[1:], ring[0]], strict=True)]
    with pytest.raises(am.DomainError, match=r"curve 10 .*: choose a smaller join_tolerance"):
        am.Domain.from_curves(lines, join_tolerance=0.11)
    ring = [(0, 0), (0.5, 0.1), (1, 0), (0.5, -0.1)]
    lozenge = [Line(a, b) for a, b in zip(ring, [*ring[1:], ring[0]], strict=True)]
    with pytest.raises(am.DomainError, match="all curves are shorter than join_tolerance"):
        am.Domain.from_curves(lozenge, join_tolerance=0.6)


def test_a_small_circle_stays():
    curves = [Line((0, 0), (1, 0)), Line((1, 0), (1, 1)), Line((1, 1), (0, 0))]
    domain = am.Domain.from_curves([*curves, Circle((0.7, 0.3), 1e-4)], join_tolerance=1e-3)
    assert domain.area == pytest.approx(0.5 - np.pi * 1e-8, abs=1e-12)
