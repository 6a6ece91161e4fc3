"""Domains and metrics that have broken meshers: each named by what it guards against.

Whatever is asked for, the outcome is a valid mesh, or an error that names the place and the remedy.
How unit the mesh is depends on what is possible: where boundaries are closer than a unit, or where
the metric turns within an edge, no mesh is unit.
"""

import time

import numpy as np
import pytest

import adaptmesh as am

BOX = [(0, 0), (1, 0), (1, 1), (0, 1)]
SIDES = [(0, 1), (1, 2), (2, 3), (3, 0)]
UNIT_SQUARE = am.Domain.polygon(BOX)


def tensors(along, across, angle):
    """Packed metrics with a size along a direction, and one across it."""
    c, s = np.cos(angle), np.sin(angle)
    a, b = np.asarray(along, float) ** -2, np.asarray(across, float) ** -2
    parts = (a * c * c + b * s * s, (a - b) * c * s, a * s * s + b * c * c)
    return np.stack(np.broadcast_arrays(*parts), axis=-1)


def constant(along, across, angle):
    return lambda x: np.tile(tensors(along, across, angle), (len(x), 1))


def distance(x, centre):
    return np.hypot(x[:, 0] - centre[0], x[:, 1] - centre[1])


def meshed(domain, metric, unit=0.0, ratio=None, **options):
    """The mesh, once it has been found valid, and as unit as it can be."""
    mesh = am.generate(domain, metric, **options)
    validity = am.validate(mesh)
    assert validity, validity
    report = am.measure(mesh, metric)
    assert report.unit_fraction >= unit, report
    if ratio is not None:
        assert ratio[0] <= report.count_ratio <= ratio[1], report
    return mesh


# --- meshes of a few triangles ---------------------------------------------------------------


@pytest.mark.parametrize("h", [1.2, 1.0, 0.8, 0.7, 0.6, 0.5, 0.4, 0.35, 0.3, 0.25, 0.2, 0.1])
def test_small_meshes_of_a_square_are_unit(h):
    meshed(UNIT_SQUARE, h, unit=1.0, ratio=(0.8, 1.75))


@pytest.mark.parametrize("h", [1.0, 0.7, 0.5, 0.4, 0.34, 0.3, 0.2])
def test_small_meshes_of_an_equilateral_triangle_are_unit(h):
    triangle = am.Domain.polygon([(0, 0), (1, 0), (0.5, 0.75**0.5)])
    meshed(triangle, h, unit=1.0, ratio=(0.8, 2.0))


def test_sides_of_a_whole_number_of_units_are_no_reason_to_cut_each_square_in_four():
    meshed(am.Domain.rectangle(0, 0, 10, 1), 1.0, unit=0.97, ratio=(0.8, 1.2))


# --- nowhere room for a unit -----------------------------------------------------------------


@pytest.mark.parametrize("width", [0.5, 0.1, 1e-3, 1e-6, 1e-9])
def test_strips_thinner_than_a_unit_get_no_inner_point(width):
    mesh = meshed(am.Domain.rectangle(0, 0, 10, width), 1.0)
    assert len(mesh.points) == 22


@pytest.mark.parametrize("degrees", [10, 1, 0.1, 0.01])
@pytest.mark.parametrize("h", [0.5, 0.05])
def test_spikes(degrees, h):
    width = 2 * np.tan(np.radians(degrees) / 2)
    teeth = [p for k in range(10) for p in ((k * width, 0.0), ((k + 0.5) * width, 1.0))]
    comb = am.Domain.polygon([*teeth, (10 * width, 0.0), (10 * width, -0.3), (0.0, -0.3)])
    meshed(comb, h)


def test_sizes_larger_than_the_domain_add_nothing():
    points = np.random.default_rng(0).uniform(0.01, 0.99, (500, 2))
    mesh = meshed(am.Domain(np.concatenate([BOX, points]), SIDES), 1e6)
    assert len(mesh.points) == 504


# --- what touches, nearly touches, or ends inside --------------------------------------------


def slit(*points, segments, **more):
    return am.Domain([*BOX, *points], segments, **more)


CONSTRAINED = {
    "a slit": slit((0.3, 0.3), (0.7, 0.61), segments=[*SIDES, (4, 5)]),
    "a slit from the boundary": slit(
        (0.3, 0), (0.47, 0.61), segments=[(0, 4), (4, 1), *SIDES[1:], (4, 5)]
    ),
    "a slit from the inside of a side": slit((0.3, 0), (0.47, 0.61), segments=[*SIDES, (4, 5)]),
    "slits that meet": slit(
        (0.5, 0.5), (0.2, 0.3), (0.8, 0.3), (0.5, 0.9), segments=[*SIDES, (4, 5), (4, 6), (4, 7)]
    ),
    "slits a thousandth apart": slit(
        (0.2, 0.5), (0.8, 0.5), (0.2, 0.501), (0.8, 0.501), segments=[*SIDES, (4, 5), (6, 7)]
    ),
    "slits a billionth apart": slit(
        (0.2, 0.5), (0.8, 0.5), (0.2, 0.5 + 1e-9), (0.8, 0.5 + 1e-9),
        segments=[*SIDES, (4, 5), (6, 7)],
    ),
    "points a millionth off a side": slit(
        (0.3, 1e-6), (0.7, 1 - 1e-6), (0.5, 0.5), (0.5 + 1e-6, 0.5), segments=SIDES
    ),
    "a point next to a slanted slit": slit(
        (0.2, 0.2), (0.8, 0.5), (0.5 + 1e-6, 0.35), segments=[*SIDES, (4, 5)]
    ),
    "a point of one rounding off a side": slit((0.3, 1e-15), (0.55, 1e-300), segments=SIDES),
    "holes that touch": am.Domain.polygon(
        BOX, [[(0.2, 0.2), (0.5, 0.3), (0.5, 0.5)], [(0.5, 0.5), (0.8, 0.6), (0.6, 0.9)]]
    ),
    "a hole that touches the boundary": slit(
        (0.5, 0), (0.7, 0.5), (0.4, 0.5),
        segments=[(0, 4), (4, 1), *SIDES[1:], (4, 5), (5, 6), (6, 4)],
        holes=[(0.53, 0.3)],
    ),
    "a hole a thousandth from the boundary": am.Domain.polygon(
        BOX, [[(0.1, 0.001), (0.9, 0.001), (0.9, 0.9), (0.1, 0.9)]]
    ),
    "segments of a millionth": am.Domain.polygon(
        [(0, 0), (0.5, 0), (0.5 + 1e-6, 0), (0.5 + 1e-6, 1e-6), (0.5 + 2e-6, 1e-6), *BOX[1:]]
    ),
}  # fmt: skip


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize("domain", CONSTRAINED.values(), ids=CONSTRAINED.keys())
def test_constraints_that_crowd(domain):
    for h in (0.5, 0.1, 0.03):
        meshed(domain, h)
    meshed(domain, 0.1, unit=0.9, placement="edges")


@pytest.mark.parametrize("step", [1e-3, 1e-9, 1e-15])
def test_a_pencil_of_slits_through_one_point(step):
    angle = 0.3 + step * np.arange(20)
    tips = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    corners = [(-2, -2), (2, -2), (2, 2), (-2, 2), (0, 0)]
    slits = [(4, 5 + k) for k in range(20)]
    pencil = am.Domain(np.concatenate([corners, tips]), [*SIDES, *slits])
    mesh = am.generate(pencil, 0.1)
    broken = [check.name for check in am.validate(mesh).broken]
    # Of slits nearer to each other than rounding `validate` cannot tell whose a piece is.
    assert broken == [] or (step < 1e-12 and broken == ["segments present"])


@pytest.mark.parametrize("width", [1e-6, 1e-9, 1e-12, 2e-16])
def test_a_slanted_strip_as_thin_as_rounding(width):
    turn = np.array([[np.cos(0.3), np.sin(0.3)], [-np.sin(0.3), np.cos(0.3)]])
    strip = am.Domain.polygon(np.array([(0, 0), (1, 0), (1, width), (0, width)]) @ turn)
    validity = am.validate(am.generate(strip, 0.05))
    assert validity["positive triangles"], validity
    assert validity["area of domain"], validity


def test_an_outline_far_finer_than_the_mesh_keeps_all_its_points():
    angle = np.linspace(0, 2 * np.pi, 3000, endpoint=False)
    radius = 1 + 0.3 * np.sin(40 * angle)
    outline = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    mesh = meshed(am.Domain.polygon(outline), 0.3)
    assert len(mesh.points) >= 3000


# --- far from one, far from the origin -------------------------------------------------------


@pytest.mark.parametrize("scale", [1e-70, 1e-9, 1e9, 1e70])
def test_scales(scale):
    holed = am.Domain.polygon(
        np.array(BOX) * scale, [np.array([(0.3, 0.3), (0.6, 0.3), (0.5, 0.7)]) * scale]
    )
    meshed(holed, 0.05 * scale, unit=0.98, ratio=(0.9, 1.1))


@pytest.mark.parametrize("offset", [1e6, 1e9, 1e12])
def test_offsets(offset):
    turned = np.array(BOX) @ np.array([[0.955, 0.295], [-0.295, 0.955]])
    meshed(am.Domain.polygon(turned + offset), 0.05, unit=0.98, ratio=(0.9, 1.1))


def test_sizes_below_the_spacing_of_numbers_are_refused_or_met():
    tiny = am.Domain.rectangle(1e6, 1e6, 1e6 + 1e-9, 1e6 + 1e-9)
    try:
        mesh = am.generate(tiny, 1e-10)
    except am.DomainError as error:
        assert "nearer to the origin" in str(error)
    else:
        assert am.validate(mesh)["positive triangles"]


@pytest.mark.parametrize("h", [5e-152, 5e148, 1e300, 1e-300])
def test_sizes_whose_squares_are_no_numbers_are_refused(h):
    with pytest.raises(am.MetricError, match="out of range"):
        am.generate(UNIT_SQUARE, h)


def test_huge_sizes_beside_small_ones():
    meshed(UNIT_SQUARE, lambda x: np.where(x[:, 0] < 0.5, 1e70, 0.05), unit=0.9)


# --- anisotropy ------------------------------------------------------------------------------


def turned_rectangle(width, height, angle):
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return am.Domain.polygon(np.array([(0, 0), (width, 0), (width, height), (0, height)]) @ turn)


@pytest.mark.parametrize("anisotropy", [1e3, 1e4, 1e6])
def test_anisotropy_along_a_turned_domain(anisotropy):
    domain = turned_rectangle(1, 10 / anisotropy, 0.4)
    meshed(domain, constant(0.2, 0.2 / anisotropy, 0.4), unit=0.98, ratio=(0.9, 1.15))


@pytest.mark.parametrize("anisotropy", [1e2, 1e3, 1e4, 1e6])
def test_anisotropy_askew_to_the_domain(anisotropy):
    """Hung: in the metric the domain is a parallelogram of a hair's angle."""
    side = 100 / anisotropy
    meshed(am.Domain.rectangle(0, 0, side, side), constant(0.2, 0.2 / anisotropy, 0.4))


def test_anisotropy_askew_in_a_wide_domain():
    meshed(UNIT_SQUARE, constant(0.5, 2e-3, 0.4), unit=0.95, ratio=(0.9, 1.15))


@pytest.mark.parametrize(("anisotropy", "unit"), [(5, 0.95), (20, 0.85)])
def test_sizes_along_circles(anisotropy, unit):
    def vortex(x):
        angle = np.arctan2(x[:, 1] - 0.5, x[:, 0] - 0.5)
        return tensors(0.2, 0.2 / anisotropy, angle + np.pi / 2)

    meshed(UNIT_SQUARE, vortex, unit=unit)


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("turns", [3, 30, 300])
def test_axes_that_turn_within_an_edge(turns):
    """No mesh is unit in it; the count grew without end."""
    meshed(UNIT_SQUARE, lambda x: tensors(0.2, 0.04, turns * x[:, 0]), ratio=(0.7, 4))


# --- sizes -----------------------------------------------------------------------------------


@pytest.mark.parametrize("smallest", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("centre", [(0.3, 0.4), (0.0, 0.0)])
def test_sizes_that_grow_from_a_point(smallest, centre):
    metric = lambda x: smallest + 0.3 * distance(x, centre)  # noqa: E731
    mesh = am.generate(UNIT_SQUARE, metric)
    # `validate` cannot tell on which side an edge of the length of its tolerance lies
    broken = [check.name for check in am.validate(mesh).broken]
    assert broken == [] or (smallest < 1e-9 and broken == ["segments present"])
    report = am.measure(mesh, metric)
    assert report.unit_fraction > 0.995
    assert 0.85 < report.count_ratio < 1.15


@pytest.mark.parametrize("growth", [1, 3, 100])
def test_sizes_that_grow_faster_than_edges_can_follow(growth):
    meshed(UNIT_SQUARE, lambda x: 1e-3 + growth * distance(x, (0.3, 0.4)))


JUMPS = {
    "a disc": lambda x: np.where(distance(x, (0.45, 0.55)) < 0.2, 0.01, 0.1),
    "a disc of a millionth": lambda x: np.where(distance(x, (0.5, 0.5)) < 1e-5, 1e-6, 1.0),
    "a half plane": lambda x: np.where(x[:, 0] < 0.51, 0.01, 1.0),
    "a checkerboard": lambda x: np.where(np.floor(3.9 * x).sum(axis=1) % 2 == 0, 0.02, 0.15),
    "crossed anisotropy": lambda x: tensors(0.3, 0.01, np.where(x[:, 0] < 0.5, 0.3, 1.87)),
}


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("metric", JUMPS.values(), ids=JUMPS.keys())
def test_jumps(metric):
    meshed(UNIT_SQUARE, metric, unit=0.88)


@pytest.mark.slow
def test_noise_finer_than_edges():
    def noise(x):
        return 0.05 * np.exp(1.5 * np.sin(1e5 * x[:, 0] * x[:, 1] + 7e4 * x[:, 1]))

    meshed(UNIT_SQUARE, noise)


# --- functions that do not keep their word ---------------------------------------------------


class Calls:
    """A metric that depends on how often it was called."""

    def __init__(self, size):
        self.size, self.count = size, 0

    def __call__(self, x):
        self.count += 1
        return np.full(len(x), self.size(self.count))


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(
    "size",
    [lambda n: (0.1, 0.03)[n % 2], lambda n: 0.02 * 1.1**n],
    ids=["alternating", "growing"],
)
def test_sizes_that_depend_on_the_call_make_a_valid_mesh(size):
    assert am.validate(am.generate(UNIT_SQUARE, Calls(size)))


def test_sizes_that_shrink_with_each_call_end_in_a_refusal():
    with pytest.raises(am.BudgetError, match="5,000"):
        am.generate(UNIT_SQUARE, Calls(lambda n: 0.1 * 0.9**n), max_vertices=5000)


def test_random_tensors_make_a_valid_mesh():
    random = np.random.default_rng(0)

    def metric(x):
        sizes = 10 ** random.uniform(-1.5, 0, (2, len(x)))
        return tensors(*sizes, random.uniform(0, np.pi, len(x)))

    assert am.validate(am.generate(UNIT_SQUARE, metric))


def test_no_number_in_a_small_place_is_named():
    def metric(x):
        return np.where(distance(x, (0.3, 0.3)) < 0.02, np.nan, 0.02)

    with pytest.raises(am.MetricError, match=r"at point \d+ \(0\.[23]\d+, 0\.[23]\d+\)"):
        am.generate(UNIT_SQUARE, metric)


def test_no_number_after_a_while_is_named():
    late = Calls(lambda n: np.nan if n > 10 else 0.05)
    with pytest.raises(am.MetricError, match="is not finite: nan"):
        am.generate(UNIT_SQUARE, late)


def test_a_size_of_zero_in_one_point_is_named():
    with pytest.raises(am.MetricError, match=r"\(0.0, 0.0\) is not positive: h = 0.0"):
        am.generate(UNIT_SQUARE, lambda x: 0.2 * np.hypot(x[:, 0], x[:, 1]))


# --- budgets ---------------------------------------------------------------------------------


@pytest.mark.parametrize("allowed", range(115, 155, 3))
def test_a_budget_is_never_exceeded(allowed):
    """About 132 vertices are needed."""
    try:
        mesh = am.generate(UNIT_SQUARE, 0.1, max_vertices=allowed)
    except am.BudgetError as error:
        assert f"max_vertices is {allowed}" in str(error) or f"{allowed} vertices" in str(error)
        assert allowed < 145
    else:
        assert len(mesh.points) <= allowed


@pytest.mark.parametrize("wrong", [1e6, None, "many"])
def test_a_budget_is_a_whole_number(wrong):
    with pytest.raises(TypeError, match="max_vertices"):
        am.generate(UNIT_SQUARE, 0.1, max_vertices=wrong)


@pytest.mark.parametrize("plenty", [2**31, 10**12])
def test_a_budget_beyond_what_can_be_numbered_is_no_error(plenty):
    assert am.generate(UNIT_SQUARE, 0.3, max_vertices=plenty)


def test_a_vertex_of_no_size_among_large_ones_is_refused_or_met():
    """The prediction cannot see it."""
    domain = am.Domain([*BOX, (0.5, 0.5)], SIDES)
    spot = lambda x: np.where((x == 0.5).all(axis=1), 1e-70, 0.1)  # noqa: E731
    try:
        mesh = am.generate(domain, spot, max_vertices=10_000)
    except am.BudgetError as error:
        assert "max_vertices" in str(error)
    else:
        assert am.validate(mesh)


# --- loops -----------------------------------------------------------------------------------


def ring(x):
    """Thinner than its background can tell."""
    angle = np.arctan2(x[:, 1] - 0.5, x[:, 0] - 0.5)
    off = abs(distance(x, (0.5, 0.5)) - 0.3)
    return tensors(0.1, np.minimum(0.002 + 0.5 * off, 0.1), angle + np.pi / 2)


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("metric", [ring, JUMPS["a disc"]], ids=["ring", "jump"])
def test_adapting_again_and_again_settles(metric):
    mesh = am.generate(UNIT_SQUARE, 0.1)
    counts, shares = [], []
    for _ in range(10):
        values = metric(mesh.points)
        background = mesh
        mesh = am.adapt(background, values)
        counts.append(len(mesh.triangles))
        shares.append(am.measure(mesh, metric).unit_fraction)
    assert am.validate(mesh)
    assert np.ptp(counts[5:]) < 0.08 * np.mean(counts[5:])
    assert np.ptp(shares[5:]) < 0.06
    assert min(shares[5:]) > 0.9


# --- a side with far more points than units ---------------------------------------------------


def finely_divided(n):
    """The unit square, turned, with n points on one side."""
    x = np.linspace(0, 1, n)
    ring = np.concatenate([np.stack([x, 0 * x], axis=1), [(1, 1), (0, 1)]])
    c, s = np.cos(0.7), np.sin(0.7)
    return am.Domain.polygon(ring @ np.array([[c, s], [-s, c]]))


def test_time_grows_with_the_points_of_a_side_and_not_with_their_square():
    times = []
    for n in (2000, 8000):
        domain = finely_divided(n)
        start = time.process_time()
        am.generate(domain, 0.1)
        times.append(time.process_time() - start)
    assert times[1] < 8 * times[0]  # 16 times, if it were the square


def test_a_finely_divided_side_leaves_the_rest_as_it_is():
    meshed(finely_divided(200), 0.1)
    mesh = am.generate(finely_divided(1000), lambda x: 1e-3 + 0.3 * near_side(x))
    report = am.measure(mesh, lambda x: 1e-3 + 0.3 * near_side(x))
    assert report.unit_fraction > 0.97


def near_side(x):
    """Distance from the line of the side with many points."""
    return np.abs(np.cos(0.7) * x[:, 1] - np.sin(0.7) * x[:, 0])
