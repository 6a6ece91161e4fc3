"""Every invariant is broken once, by the smallest mesh that breaks it, and named."""

from __future__ import annotations

from dataclasses import replace

import hypothesis.extra.numpy as hnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import adaptmesh as am
from adaptmesh import Domain
from adaptmesh.domain import projection as on_runs
from adaptmesh.errors import AdaptmeshError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.validate.validate import InvalidMeshError, Validity, validate

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
HALVES = np.array([[0, 1, 2], [0, 2, 3]])
RIM = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])


def bounded(points, triangles, **more) -> Mesh:
    """A mesh whose sides with a single triangle are constrained."""
    t = np.asarray(triangles)
    sides = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    edges, count = np.unique(sides, axis=0, return_counts=True)
    return Mesh(points, t, edges=edges[count == 1], **more)


def broken(mesh: Mesh) -> list[str]:
    return [check.name for check in validate(mesh).broken]


def grid(n: int) -> Mesh:
    """The unit square as 2 n² triangles."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    b, c, d = a + 1, a + n + 2, a + n + 1
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return bounded(np.stack([x.ravel(), y.ravel()], 1), triangles)


def ring(n: int, turns: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Points on two circles and the strip of triangles between them, wound so many times."""
    angle = 2 * np.pi * turns * np.arange(n) / n
    circle = np.stack([np.cos(angle), np.sin(angle)], 1)
    i, j = np.arange(n), (np.arange(n) + 1) % n
    triangles = np.concatenate([np.stack([i, i + n, j], 1), np.stack([j, i + n, j + n], 1)])
    return np.concatenate([circle, 2 * circle]), triangles


# --- meshes that are one --------------------------------------------------------------------


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9, 1e-200, 1e200])
@pytest.mark.parametrize("offset", [0.0, 1.0])
def test_grid_is_valid_at_every_scale(scale, offset):
    mesh = grid(4)
    moved = Mesh((mesh.points + offset) * scale, mesh.triangles, edges=mesh.edges)
    assert validate(moved).ok, str(validate(moved))


def test_ring_with_a_hole_is_valid():
    validity = validate(bounded(*ring(12)))
    assert validity, str(validity)
    assert "1 holes" in validity["Euler's relation"].note
    assert "pieces of border: 2" in validity["covered once"].note


def test_two_parts_may_touch_in_a_point():
    points = [[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]]
    validity = validate(bounded(points, [[0, 1, 2], [0, 3, 4]]))
    assert validity.ok
    assert "pieces of border: 1" in validity["covered once"].note


def test_a_hole_may_touch_the_border_in_a_point():
    # the square without the triangle (0, 5, 4), which touches the border at 0 only
    points = [[0, 0], [3, 0], [3, 3], [0, 3], [1, 2], [2, 1]]
    triangles = [[0, 1, 5], [1, 2, 5], [5, 2, 4], [2, 3, 4], [3, 0, 4]]
    assert validate(bounded(points, triangles)).ok


def test_tags_without_a_name_are_allowed():
    mesh = Mesh(SQUARE, HALVES, edges=RIM, edge_tags=[7, 7, 0, 2], names={"wall": 2})
    assert validate(mesh).ok


# --- each invariant broken ------------------------------------------------------------------


def test_empty():
    validity = validate(Mesh(np.empty((0, 2)), np.empty((0, 3))))
    assert [check.name for check in validity.broken] == ["not empty"]
    assert validity["single turn"].ok is None


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_point_not_finite(value):
    points = SQUARE.copy()
    points[2, 1] = value
    validity = validate(Mesh(points, HALVES, edges=RIM))
    assert [check.name for check in validity.broken] == ["finite points"]
    assert validity["finite points"].offenders == (f"point 2 (1.0, {value!r})",)
    assert validity["positive triangles"].ok is None


def test_index_out_of_range():
    validity = validate(Mesh(SQUARE, [[0, 1, 2], [0, 2, 4]], edges=[[-1, 0]]))
    check = validity["indices in range"]
    assert (check.ok, check.count) == (False, 2)
    assert check.offenders == (
        "triangle 1: [0, 2, 4], with 4 points",
        "constrained edge 0: [-1, 0], with 4 points",
    )


def test_clockwise_triangle():
    mesh = Mesh(SQUARE, [[0, 1, 2], [0, 3, 2]], edges=RIM)
    validity = validate(mesh)
    assert validity["positive triangles"].count == 1
    assert validity["positive triangles"].offenders[0].startswith("triangle 1 is clockwise: 0 (0.0")
    assert validity["same orientation"].ok is False


def test_flat_triangle_by_exact_signs():
    # the third point is off the diagonal by less than rounding: exact signs tell the sides apart
    points = np.array([[0, 0], [12, 12], [24, 24 + 4e-15], [24, 24], [0.5, 0.5]])
    assert validate(bounded(points[:3], [[0, 1, 2]])).ok
    flat = validate(bounded(points[[0, 1, 3]], [[0, 1, 2]]))
    assert "triangle 0 is flat" in flat["positive triangles"].offenders[0]


def test_duplicate_points():
    points = [[0, 0], [1, 0], [0, 1], [-0.0, 0], [-1, 0], [0, -1]]
    assert broken(bounded(points, [[0, 1, 2], [3, 4, 5]])) == ["distinct points"]


def test_three_triangles_on_an_edge():
    points = [[0, 0], [1, 0], [0.5, 1], [0.5, 2], [0.5, -1]]
    mesh = bounded(points, [[0, 1, 2], [0, 1, 3], [1, 0, 4]])
    check = validate(mesh)["two triangles an edge"]
    assert check.offenders == ("edge 0 (0.0, 0.0), 1 (1.0, 0.0): 3 triangles, [0, 1, 2]",)


def test_same_direction_along_an_edge():
    points = [[0, 0], [1, 0], [0.5, 1], [0.5, 2]]
    validity = validate(bounded(points, [[0, 1, 2], [0, 1, 3]]))
    assert [check.name for check in validity.broken] == ["same orientation"]
    assert validity["same orientation"].offenders[0].endswith("triangles [0, 1]")


def test_point_without_triangle():
    mesh = Mesh([*SQUARE.tolist(), [5, 5]], HALVES, edges=RIM)
    validity = validate(mesh)
    assert [check.name for check in validity.broken] == ["points used"]
    assert validity["points used"].offenders == ("point 4 (5.0, 5.0)",)
    assert validity["Euler's relation"].ok


def test_constrained_edge_that_is_no_edge():
    assert broken(Mesh(SQUARE, HALVES, edges=[*RIM.tolist(), [1, 3]])) == ["constrained are edges"]


def test_constrained_edge_listed_twice():
    validity = validate(Mesh(SQUARE, HALVES, edges=[*RIM.tolist(), [1, 0]]))
    assert [check.name for check in validity.broken] == ["constrained are edges"]
    assert "edge 4 is listed twice" in validity["constrained are edges"].offenders[0]


def test_border_not_constrained():
    validity = validate(Mesh(SQUARE, HALVES, edges=RIM[:3]))
    assert [check.name for check in validity.broken] == ["border is constrained"]
    (offender,) = validity["border is constrained"].offenders
    assert offender == "side 3 (0.0, 1.0), 0 (0.0, 0.0) of triangle 1"


def test_negative_numbers_are_right_where_no_domain_says_otherwise():
    """Labels in files of FreeFEM and Medit may be negative."""
    numbers = {"edge_tags": [0, 0, -1, 0], "regions": [0, -3]}
    mesh = Mesh(SQUARE, HALVES, edges=RIM, **numbers)
    assert validate(mesh).ok
    assert "tags" in broken(replace(am.generate(square_domain(), 2.0), regions=[0, -3]))


def test_two_turns_around_a_point():
    # a strip wound twice around the origin, closed by a fan: every triangle is positive
    n = 10
    points = ring(n, turns=2)[0]
    points = np.concatenate([points[n:] + 0.01 * np.arange(n)[:, None], [[0.03, 0.02]]])
    fan = [[i, (i + 1) % n, n] for i in range(n)]
    check = validate(bounded(points, fan))["single turn"]
    assert check.count == 1
    assert check.offenders == ("point 10 (0.03, 0.02): 2 turns",)


def test_overlapping_fans():
    # two triangles share the point 0; each is positive, together they make half a turn at most
    points = [[0, 0], [4, 0], [1, 4], [4, 1], [0.5, 5]]
    assert broken(bounded(points, [[0, 1, 2], [0, 3, 4]])) == ["simple border"]


def test_a_fan_within_another():
    # no two edges cross: only the layers of triangles say that one lies on the other
    points = [[0, 0], [6, -6], [6, 6], [2, -1], [2, 1]]
    validity = validate(bounded(points, [[0, 1, 2], [0, 3, 4]]))
    assert [check.name for check in validity.broken] == ["covered once"]
    assert "edge 3 (2.0, -1.0), 4 (2.0, 1.0)" in str(validity["covered once"].offenders)


def test_border_that_crosses_itself():
    points = [[0, 0], [2, 0], [0, 2], [1, -1], [3, 1], [1, 1.5]]
    validity = validate(bounded(points, [[0, 1, 2], [3, 4, 5]]))
    assert [check.name for check in validity.broken] == ["simple border"]
    assert "edges " in validity["simple border"].offenders[0]


def test_hanging_point_on_the_border():
    # 4 lies in the middle of the side (1, 2), which the upper part does not know
    points = [[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]]
    assert "simple border" in broken(bounded(points, [[0, 1, 2], [1, 3, 4], [3, 2, 4]]))


def test_part_inside_another():
    points = [[0, 0], [9, 0], [0, 9], [1, 1], [2, 1], [1, 2]]
    validity = validate(bounded(points, [[0, 1, 2], [3, 4, 5]]))
    assert [check.name for check in validity.broken] == ["covered once"]
    (first, *_), check = validity["covered once"].offenders, validity["covered once"]
    assert check.count == 3
    assert first.startswith("edge 3 (1.0, 1.0), 4 (2.0, 1.0) of triangle 1: 2 triangles")


def test_ring_wound_twice_around():
    # locally perfect: no crossing because the second turn is wider than the first
    n = 16
    angle = 4 * np.pi * np.arange(n + 1) / n
    inner = 1 + 0.8 * angle / (4 * np.pi)
    spiral = np.stack([np.cos(angle), np.sin(angle)], 1)
    points = np.concatenate([inner[:, None] * spiral, (inner + 0.9)[:, None] * spiral])
    i = np.arange(n)
    m = n + 1
    triangles = np.concatenate(
        [np.stack([i, i + m, i + 1], 1), np.stack([i + 1, i + m, i + m + 1], 1)]
    )
    assert broken(bounded(points, triangles)) == ["simple border"]


# --- the domain -----------------------------------------------------------------------------


def square_domain(**changes):
    arguments = {"points": SQUARE, "segments": RIM, "names": {1: [0], 2: [2]}}
    return Domain(**{**arguments, **changes})


def square_mesh(n=3, tags=(1, 0, 2, 0), **changes) -> Mesh:
    mesh = grid(n)
    middle = mesh.points[mesh.edges].mean(axis=1)
    side = np.select([middle[:, 1] == 0, middle[:, 0] == 1, middle[:, 1] == 1], [0, 1, 2], 3)
    arrays = {"edges": mesh.edges, "edge_tags": np.array(tags)[side], "domain": square_domain()}
    return Mesh(mesh.points, mesh.triangles, **{**arrays, **changes})


def test_domain_met():
    validity = validate(square_mesh())
    assert validity.ok, str(validity)
    assert "4 segments" in validity["segments present"].note


def test_domain_on_a_slant_is_met_to_rounding():
    turn = np.array([[0.6, 0.8], [-0.8, 0.6]]) / 3
    mesh = square_mesh(7)
    turned = Mesh(
        mesh.points @ turn,
        mesh.triangles,
        edges=mesh.edges,
        edge_tags=mesh.edge_tags,
        domain=square_domain(points=SQUARE @ turn),
    )
    assert validate(turned).ok, str(validate(turned))


def test_edges_with_another_tag():
    validity = validate(square_mesh(tags=(1, 0, 0, 0)))
    assert [check.name for check in validity.broken] == ["tags of domain"]
    assert "tag 0, but segment 2 from (1.0, 1.0) to (0.0, 1.0) has 2" in str(validity)


def test_segment_missing():
    domain = square_domain(segments=np.concatenate([RIM, [[0, 2]]]))
    validity = validate(square_mesh(domain=domain))
    assert [check.name for check in validity.broken] == ["segments present"]
    assert "segment 4 from (0.0, 0.0) to (1.0, 1.0)" in validity["segments present"].offenders[0]


def test_segment_with_a_gap():
    mesh = square_mesh(3)
    inner = [[4, 5], [5, 6], [9, 10]]  # two thirds of y = 1/3 and a bit of y = 2/3
    edges = np.concatenate([mesh.edges, inner])
    tags = np.concatenate([mesh.edge_tags, [0, 0, 0]])
    domain = square_domain(
        points=np.concatenate([SQUARE, mesh.points[[4, 7, 9, 10]]]),
        segments=[[0, 1], [1, 5], [5, 2], [2, 3], [3, 4], [4, 0], [4, 5], [6, 7]],
        names={1: [0], 2: [3]},
    )
    validity = validate(square_mesh(3, edges=edges, edge_tags=tags, domain=domain))
    assert [check.name for check in validity.broken] == ["segments present"]
    check = validity["segments present"]
    assert check.count == 1
    assert check.offenders[0].startswith("segment 6 ")


def test_edge_on_no_segment():
    mesh = square_mesh(1)
    edges = np.concatenate([mesh.edges, [[0, 3]]])
    validity = validate(square_mesh(1, edges=edges, edge_tags=np.append(mesh.edge_tags, 0)))
    assert [check.name for check in validity.broken] == ["edges on segments"]


def test_point_of_the_domain_missing():
    domain = square_domain(points=np.concatenate([SQUARE, [[0.4, 0.4]]]))
    validity = validate(square_mesh(domain=domain))
    assert [check.name for check in validity.broken] == ["points present"]
    assert validity["points present"].offenders == ("point 4 of the domain (0.4, 0.4)",)


def test_corner_that_is_off_by_more_than_the_tolerance():
    points = SQUARE.copy()
    points[2] += 1e3 * on_runs.TOLERANCE
    mesh = square_mesh(domain=square_domain(points=points))
    assert broken(mesh)[0] == "points present"
    assert validate(mesh, tolerance=1e4 * on_runs.TOLERANCE).ok


@pytest.mark.parametrize("what", [None, "mesh.vtu", SQUARE, [], Domain.rectangle(0, 0, 1, 1), Mesh])
def test_what_is_no_mesh(what):
    with pytest.raises(am.DomainError, match=f"expected a Mesh, got {type(what).__name__}"):
        validate(what)


def test_tolerance_is_a_length():
    with pytest.raises(ValueError, match="tolerance=-1"):
        validate(square_mesh(), tolerance=-1)


def test_names_are_not_ambiguous():
    named = lambda **names: Mesh(SQUARE, HALVES, edges=RIM, names=names)  # noqa: E731
    assert validate(named(wall=1, inlet=2)).ok
    assert broken(named(wall=1, inlet=1)) == ["names"]
    assert broken(named(wall=0)) == ["names"]
    assert "'wall': tag 0" in validate(named(wall=0))["names"].offenders[0]


def test_no_vertex_is_kept_twice():
    assert validate(Mesh(SQUARE, HALVES, edges=RIM, kept=[-1, -1, 3, 2])).ok
    assert broken(Mesh(SQUARE, HALVES, edges=RIM, kept=[-1, 3, 3, 2])) == ["kept once"]
    assert broken(Mesh(SQUARE, HALVES, edges=RIM, kept=[-2, 3, 1, 2])) == ["kept once"]


def test_required_numbers_out_of_range():
    assert broken(Mesh(SQUARE, HALVES, edges=RIM, required_points=[4])) == ["indices in range"]
    assert broken(Mesh(SQUARE, HALVES, edges=RIM, required_edges=[-1])) == ["indices in range"]


def test_numbers_that_only_the_domain_gives_may_be_negative():
    domain = square_domain(names={-3: [0]}, regions={-4: (0.5, 0.5)})
    mesh = am.generate(domain, 0.5)
    assert mesh.edge_tags.min() == -3
    assert mesh.regions.min() == -4
    assert validate(mesh).ok
    assert validate(replace(mesh, domain=None)).ok
    assert "tags" in broken(replace(mesh, regions=-9 + 0 * mesh.regions))


# --- the report -----------------------------------------------------------------------------


def test_validity_reads_well():
    validity = validate(Mesh(SQUARE, HALVES, edges=RIM[:1]))
    text = str(validity)
    assert text.splitlines()[0].endswith("NOT VALID")
    assert "✗ border is constrained" in text
    assert "side 3 (0.0, 1.0), 0 (0.0, 0.0) of triangle 1" in text
    assert not validity
    with pytest.raises(InvalidMeshError, match="border is constrained"):
        validity.raise_if_invalid()
    assert issubclass(InvalidMeshError, AdaptmeshError)
    with pytest.raises(KeyError, match="simple border"):
        validity["no such check"]


def test_many_offenders_are_counted_and_a_few_named():
    validity = validate(Mesh(grid(10).points, grid(10).triangles[:, ::-1]))
    check = validity["positive triangles"]
    assert (check.count, len(check.offenders)) == (200, 5)
    assert "… and 195 more" in str(validity)


def test_valid_mesh_raises_nothing():
    mesh = Mesh(SQUARE, HALVES, edges=RIM)
    mesh.validate().raise_if_invalid()
    assert "valid" in str(mesh.validate()).splitlines()[0]


# --- garbage --------------------------------------------------------------------------------

wild = st.floats(allow_nan=True, allow_infinity=True)
tame = st.integers(-3, 3).map(float) | st.floats(-1e308, 1e308)


@pytest.mark.slow
@settings(max_examples=300, deadline=None)
@given(st.data(), st.integers(0, 7), st.integers(0, 8), st.integers(0, 4), st.booleans())
def test_garbage_never_crashes(data, n, m, k, plausible):
    low, high = (0, max(n - 1, 0)) if plausible else (-(2**31), 2**31 - 1)
    index = st.integers(low, high)
    draw = lambda shape, elements, dtype: data.draw(hnp.arrays(dtype, shape, elements=elements))  # noqa: E731
    mesh = Mesh(
        draw((n, 2), tame if plausible else wild, np.float64),
        draw((m, 3), index, np.int32),
        edges=draw((k, 2), index, np.int32),
        edge_tags=draw((k,), st.integers(-5, 5), np.int32),
    )
    validity = validate(mesh)
    assert isinstance(validity, Validity)
    assert str(validity)


@settings(max_examples=200, deadline=None)
@given(
    hnp.arrays(np.float64, (7, 2), elements=st.integers(-3, 3).map(float)),
    st.lists(st.permutations(range(7)).map(lambda p: p[:3]), min_size=2, max_size=5),
)
def test_verdict_on_overlap_agrees_with_areas(points, faces):
    """Positive triangles that overlap are never called a mesh, those that do not always are."""
    from shapely import Polygon

    corners = points[faces]
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    positive = [f if d > 0 else f[::-1] for f, d in zip(faces, area, strict=True) if d]
    if not positive:
        return
    mesh = bounded(points, np.array(positive))
    validity = validate(mesh)
    parts = [Polygon(points[t]) for t in mesh.triangles]
    pairs = [(p, q) for i, p in enumerate(parts) for q in parts[:i]]
    if any(p.intersection(q).area > 1e-9 for p, q in pairs):
        assert not validity.ok
    elif not validity.ok:  # nothing overlaps, but a point hangs, is double, or has no triangle
        names = ("simple border", "distinct points", "points used")
        assert any(validity[name].ok is False for name in names)


@pytest.mark.parametrize("size", [1.0, 700.0, 1e6])
@pytest.mark.parametrize("tiny", [5e-324, 2e-323, -1e-310, 1e-300])
def test_coordinates_of_any_size_are_judged_exactly(size, tiny):
    """A slit as wide as the smallest numbers; nothing is rounded away before signs are taken."""
    ring = np.array([(0, 0), (1, 1.8), (0, 2.8), (-1.4, 1.4), (0, 0), (0.5, -1.2)]) * size
    ring[4] = tiny, -tiny
    mesh = am.generate(am.Domain.polygon(ring), 0.4 * size)
    validity = am.validate(mesh)
    assert validity, str(validity)
