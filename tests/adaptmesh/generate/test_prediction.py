"""How many vertices are predicted on domains of curves: from areas, and against the meshes made."""

import numpy as np
import pytest
from reference.curved import CASES, DISC, box

import adaptmesh as am
import metrics
from adaptmesh import Domain
from adaptmesh.curves import Circle

HOLE = Domain.from_curves([*box(-2, -2, 2, 2), Circle((0, 0), 1)])
RING = Domain.from_curves([Circle((0, 0), 2), Circle((0, 0), 1)])


@pytest.mark.parametrize(
    ("domain", "area", "border"),
    [
        (DISC, np.pi, 2 * np.pi),
        (HOLE, 16 - np.pi, 16 + 2 * np.pi),
        (RING, 3 * np.pi, 6 * np.pi),
    ],
    ids=["disc", "hole", "ring"],
)
def test_it_is_of_the_area_between_the_curves(domain, area, border):
    """The polygon that stands for the disc lacks one part in a hundred of it."""
    h = 0.002
    expected = 2 / np.sqrt(3) * area / h**2 + border / h / 2
    assert am.predict(domain, h) == pytest.approx(expected, rel=5e-4)


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("height", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("domain", [DISC, HOLE], ids=["disc", "hole"])
def test_layers_thinner_than_the_chords_of_the_domain_are_high(domain, height):
    """They are beside the chord, in the domain (disc) or not (hole)."""
    wall = DISC.outline(height / 50)
    layer = metrics.BoundaryLayer(wall, height, 1.2, 0.02, h_max=0.2)
    mesh = am.generate(domain, layer)
    assert am.predict(domain, layer) == pytest.approx(len(mesh.points), rel=0.06)


@pytest.mark.parametrize("name", ["aerofoil", "two regions", "disc of two halves", "slanted"])
def test_the_prediction_is_near(name):
    make, size = CASES[name]
    domain = make()
    assert am.predict(domain, size) == pytest.approx(
        len(am.generate(domain, size).points), rel=0.06
    )


def test_sizes_below_the_rounding_of_coordinates_end_as_well():
    assert am.predict(DISC, 1e-17) == pytest.approx(2 / np.sqrt(3) * np.pi * 1e34, rel=1e-3)
