"""From domain and metric to mesh: conforming, valid, named; refused early when it cannot be."""

import os
import re
import signal
import threading
import time

import numpy as np
import pytest

import adaptmesh as am
import metrics


@pytest.fixture
def square():
    return am.Domain.rectangle(0, 0, 1, 1)


def graded(x):
    return 0.01 + 0.1 * np.hypot(x[:, 0], x[:, 1])


def layer(x):
    """Sizes 0.004 across and 0.08 along y = 1/2 + sin(2 pi x) / 5, growing away from it."""
    k = 2 * np.pi
    phi = x[:, 1] - 0.5 - 0.2 * np.sin(k * x[:, 0])
    gx, gy = -0.2 * k * np.cos(k * x[:, 0]), np.ones(len(x))
    g = np.hypot(gx, gy)
    across = 1 / np.minimum(0.004 + 0.4 * abs(phi) / g, 0.08) ** 2
    along = 1 / 0.08**2
    nx, ny = gx / g, gy / g
    return np.stack(
        [
            across * nx * nx + along * ny * ny,
            (across - along) * nx * ny,
            across * ny * ny + along * nx * nx,
        ],
        axis=1,
    )


def assert_unit(mesh, metric, share):
    report = am.measure(mesh, metric)
    assert am.validate(mesh), am.validate(mesh)
    assert report.unit_fraction >= share, report
    assert 0.85 <= report.count_ratio <= 1.2, report


@pytest.mark.parametrize(
    ("metric", "share"),
    [(0.03, 0.999), (graded, 0.999), (layer, 0.99)],
    ids=["0.03", "graded", "layer"],
)
def test_edges_are_unit(square, metric, share):
    assert_unit(am.generate(square, metric), metric, share)


def test_the_three_forms_of_a_callable_make_the_same_mesh(square):
    def packed(x):
        m = 1 / (graded(x) * graded(x))
        return np.stack([m, 0 * m, m], axis=1)

    def tensors(x):
        return packed(x)[:, 0, None, None] * np.eye(2)

    one, two, three = (am.generate(square, metric) for metric in (graded, packed, tensors))
    assert np.array_equal(one.points, two.points)
    assert np.array_equal(one.points, three.points)


def test_same_input_same_bits(square):
    first = am.generate(square, layer)
    am.generate(square, 0.05)
    second = am.generate(square, layer)
    assert np.array_equal(first.points, second.points)
    assert np.array_equal(first.triangles, second.triangles)


def test_threads_make_the_same_meshes_as_alone(square):
    alone = {name: am.generate(square, metric) for name, metric in (("a", layer), ("b", graded))}
    together = {}

    def work(name, metric):
        together[name] = am.generate(square, metric)

    threads = [threading.Thread(target=work, args=item) for item in (("a", layer), ("b", graded))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for name, mesh in alone.items():
        assert np.array_equal(mesh.points, together[name].points)


def test_corners_holes_regions_and_names_are_kept(plate):
    mesh = am.generate(plate, 0.2)
    assert am.validate(mesh), am.validate(mesh)
    assert mesh.areas.sum() == pytest.approx(8 - 0.25, abs=1e-12)
    assert {tuple(p) for p in plate.points} <= {tuple(p) for p in mesh.points}

    def length(name):
        p = mesh.points[mesh.edges_named(name)]
        return np.linalg.norm(p[:, 1] - p[:, 0], axis=1).sum()

    assert length("bottom") == pytest.approx(4)
    assert length("interface") == pytest.approx(2)
    assert length("hole") == pytest.approx(2)
    assert mesh.areas[mesh.triangles_in("left")].sum() == pytest.approx(4 - 0.25)
    assert mesh.areas[mesh.triangles_in("right")].sum() == pytest.approx(4)


def test_dangling_segments_and_isolated_points_are_in_the_mesh():
    points = [(0, 0), (1, 0), (1, 1), (0, 1), (0.2, 0.31), (0.8, 0.57), (0.33, 0.84)]
    domain = am.Domain(points, [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5)], names={"slit": [4]})
    mesh = am.generate(domain, 0.1)
    assert am.validate(mesh), am.validate(mesh)
    assert len(mesh.edges_named("slit")) == 7  # length 0.65
    assert (mesh.points == points[6]).all(axis=1).any()


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_scale_and_place_do_not_matter(scale, offset):
    x0 = offset * scale
    domain = am.Domain.rectangle(x0, x0, x0 + scale, x0 + scale)
    mesh = am.generate(domain, 0.09 * scale)
    assert am.validate(mesh), am.validate(mesh)
    assert am.measure(mesh, 0.09 * scale).unit_fraction > 0.99


@pytest.mark.parametrize("h", [0.3, 0.7, 1.0, 1.5, 5.0, 1e6])
def test_sizes_up_to_far_larger_than_the_domain(square, h):
    mesh = am.generate(square, h)
    assert am.validate(mesh), am.validate(mesh)
    assert mesh.areas.sum() == pytest.approx(1)
    assert len(mesh.triangles) >= 2


@pytest.mark.parametrize("angle", [1, 5, 30])
def test_sharp_corners(angle):
    tip = np.radians(angle)
    wedge = am.Domain.polygon([(0, 0), (1, 0), (np.cos(tip), np.sin(tip))])
    mesh = am.generate(wedge, 0.02)
    assert am.validate(mesh), am.validate(mesh)


def test_extreme_anisotropy(square):
    metric = np.array([[1 / 0.2**2, 0.0, 1 / 2e-7**2]])  # 1e6
    strip = am.Domain.rectangle(0, 0, 1, 1e-5)
    field = lambda x: np.repeat(metric, len(x), axis=0)  # noqa: E731
    assert_unit(am.generate(strip, field), field, 0.97)


def test_slanted_extreme_anisotropy(square):
    c, s = np.cos(0.4), np.sin(0.4)
    fine, coarse = 1 / 1e-4**2, 1 / 0.1**2
    m = [fine * c * c + coarse * s * s, (fine - coarse) * c * s, fine * s * s + coarse * c * c]
    field = lambda x: np.repeat([m], len(x), axis=0)  # noqa: E731
    small = am.Domain.rectangle(0, 0, 0.01, 0.01)
    mesh = am.generate(small, field)
    assert am.validate(mesh), am.validate(mesh)


def test_discontinuous_sizes(square):
    def jump(x):
        return np.where(np.hypot(x[:, 0] - 0.45, x[:, 1] - 0.55) < 0.2, 0.01, 0.1)

    mesh = am.generate(square, jump)
    assert am.validate(mesh), am.validate(mesh)
    assert am.measure(mesh, jump).unit_fraction > 0.9


# --- refusals ------------------------------------------------------------------------------------


def test_too_large_a_mesh_is_refused_at_once(square):
    start = time.perf_counter()
    with pytest.raises(am.BudgetError, match=r"1.15e\+08 vertices, but max_vertices is 5,000,000"):
        am.generate(square, 1e-4)
    assert time.perf_counter() - start < 1
    with pytest.raises(am.BudgetError, match=r"about \d\d,\d{3} vertices, .* is 100:"):
        am.generate(square, 0.01, max_vertices=100)


def test_the_prediction_is_near(square):
    for metric in (0.02, graded, layer):
        assert am.predict(square, metric) == pytest.approx(
            len(am.generate(square, metric).points), rel=0.1
        )


@pytest.mark.parametrize(
    ("metric", "message"),
    [
        (-1.0, "size"),
        (0.0, "size"),
        (np.nan, "size"),
        (lambda x: x[:, 0] - 0.5, "size"),
        (lambda x: np.full(len(x), np.nan), r"at point 0 \(.*\) is not finite: nan"),
        (lambda x: np.ones((len(x), 4)), "shape"),
        (lambda x: 0.1, "shape"),
        (lambda x: np.ones(3), "shape"),
        (lambda x: np.tile([1.0, 2.0, 1.0], (len(x), 1)), "positive definite"),
        (lambda x: 1 / 0, "ZeroDivisionError"),
        ("0.1", None),
    ],
)
def test_bad_metrics_are_named(square, metric, message):
    with pytest.raises((am.MetricError, TypeError), match=message):
        am.generate(square, metric)


def test_what_is_no_domain():
    with pytest.raises(am.DomainError, match="expected a Domain, got list"):
        am.generate([(0, 0), (1, 0), (0, 1)], 0.1)


@pytest.mark.parametrize("placement", ["random", None, 1, [], {}, ["front"], np.ones(2)], ids=repr)
def test_unknown_placement(square, placement):
    message = rf"placement: expected .* got {re.escape(repr(placement))}"
    with pytest.raises(ValueError, match=message):
        am.generate(square, 0.1, placement=placement)


# --- long work -----------------------------------------------------------------------------------


def test_progress_rises_to_one(square):
    seen = []
    am.generate(square, layer, progress=lambda stage, fraction: seen.append((stage, fraction)))
    fractions = [fraction for _, fraction in seen]
    assert fractions == sorted(fractions)
    assert fractions[0] == 0.0
    assert seen[-1] == ("done", 1.0)


def test_progress_may_stop_the_work(square):
    class EnoughError(Exception):
        pass

    def stop(stage, fraction):
        if stage == "smoothing":
            raise EnoughError

    with pytest.raises(EnoughError):
        am.generate(square, 0.05, progress=stop)


@pytest.mark.skipif(os.name == "nt", reason="signals are not sent this way on Windows")
def test_ctrl_c_stops_within_a_second(square):
    # A process started in the background of a shell ignores SIGINT; here it must not.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    sent = []

    def interrupt():
        time.sleep(0.5)
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            am.generate(square, 0.001)  # a million vertices
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.perf_counter() - sent[0] < 1


def test_metric_is_a_control_space(square):
    field = metrics.as_control_space(0.1) & graded
    mesh = am.generate(square, field)
    assert am.measure(mesh, field).unit_fraction > 0.99
