"""Curves of the borders of meshes that come without any."""

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh.curves import Arc, Circle, Line, Spline
from adaptmesh.errors import DomainError
from adaptmesh.mesh.fit_curves import smooth_curves


def bare(mesh):
    """What a file would keep of a mesh."""
    return am.Mesh(
        mesh.points, mesh.triangles, mesh.regions, mesh.edges, mesh.edge_tags,
        mesh.names, mesh.region_names,
    )  # fmt: skip


def test_a_ring_of_two_circles_is_found_again():
    true = am.Domain.from_curves([Circle((0, 0), 2), Circle((0, 0), 1)], names={"hole": [1]})
    coarse = bare(am.generate(true, 0.2))
    polygon, smooth = coarse.to_domain(), coarse.to_domain(corner_angle=30)
    assert abs(smooth.area - true.area) < 0.05 * abs(polygon.area - true.area)
    fine = am.generate(smooth, 0.02)
    radii = np.hypot(*fine.points[np.unique(fine.edges)].T)
    assert np.minimum(abs(radii - 1), abs(radii - 2)).max() < 2e-5
    a, b = fine.points[fine.edges_named("hole")].transpose(1, 0, 2)
    assert np.hypot(*(b - a).T).sum() == pytest.approx(2 * np.pi, rel=1e-4)


def test_corners_stay_and_straight_sides_are_straight():
    half = [Arc((0, 0), 1, 0, np.pi), Line((-1, 0), (1, 0))]
    true = am.Domain.from_curves(half, names={"arc": [0], "base": [1]}, holes=())
    smooth = bare(am.generate(true, 0.15)).to_domain(corner_angle=30)
    kinds = sorted(type(c).__name__ for c in smooth.curved.curves)
    assert kinds == ["Line", "Spline"]
    assert smooth.area == pytest.approx(np.pi / 2, rel=1e-4)
    fine = am.generate(smooth, 0.05)
    assert {(-1.0, 0.0), (1.0, 0.0)} <= {tuple(p) for p in np.round(fine.points, 12).tolist()}
    y = fine.points[np.unique(fine.edges_named("base")), 1]
    assert abs(y).max() < 1e-15


def test_a_square_has_no_curves():
    mesh = bare(am.generate(am.Domain.rectangle(0, 0, 2, 1), 0.3))
    domain = mesh.to_domain(corner_angle=40)
    assert all(isinstance(c, Line) for c in domain.curved.curves)
    assert len(domain.points) == 4
    assert domain.names == mesh.names


def test_regions_and_tags_stay():
    curves = [Circle((0, 0), 2), Circle((0, 0), 1)]
    true = am.Domain.from_curves(
        curves, names={5: [0], 9: [1]}, holes=(), regions={3: (0, 0), 4: (1.5, 0)}
    )
    smooth = bare(am.generate(true, 0.2)).to_domain(corner_angle=30)
    mesh = am.generate(smooth, 0.1)
    assert set(mesh.edge_tags) == {5, 9}
    assert mesh.areas[mesh.regions == 3].sum() == pytest.approx(np.pi, rel=5e-3)
    assert mesh.areas[mesh.regions == 4].sum() == pytest.approx(3 * np.pi, rel=5e-3)


def test_a_chain_is_cut_at_corners_and_around_straight_sides():
    # a square with one rounded corner: vertices 0 ... 7, the third side of two edges
    p = np.array(
        [(0, 0), (2, 0), (2.4, 0.1), (2.7, 0.3), (2.9, 0.6), (3, 1), (3, 2), (3, 3), (0, 3)], float
    )
    chain = [*range(9), 0]
    corners = [0, 1, 2, 3, 4, 5, 7, 8, 0]
    curves = smooth_curves(p, chain, corners, 25, True)
    assert [type(c) for c in curves] == [Spline, Line, Line, Line]
    assert [c.start.tolist() for c in curves] == [[0, 0], [3, 1], [3, 3], [0, 3]]
    assert curves[-1].end.tolist() == [0, 0]


@pytest.mark.parametrize("corner_angle", [-1, 180, np.nan])
def test_what_is_no_angle(corner_angle):
    mesh = bare(am.generate(am.Domain.rectangle(0, 0, 2, 1), 0.5))
    with pytest.raises(DomainError, match="corner_angle"):
        mesh.to_domain(corner_angle=corner_angle)
