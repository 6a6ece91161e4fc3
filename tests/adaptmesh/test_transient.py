"""The fixed point in time: meshes that are fine where the front is going to be."""

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh import TransientError, transient_loop

DOMAIN = am.Domain.rectangle(0, 0, 2, 1)
TIMES = [0, 0.5, 1.0]


def front(mesh, t):
    return np.tanh(30 * (mesh.points[:, 0] - 0.5 - t))


def known(mesh, fields, t0, t1):
    """A solver that knows the solution: a front that moves to the right."""
    for t in np.linspace(t0, t1, 6)[1:-1]:
        yield t, front(mesh, t)
    yield t1, front(mesh, t1)


@pytest.fixture(scope="module")
def history():
    mesh = am.generate(DOMAIN, 0.1)
    return transient_loop(known, lambda m: front(m, 0), mesh, TIMES, target_vertices=800)


def finest(mesh, x):
    """The area of the smallest triangle beside the line at x."""
    centre = mesh.points[mesh.triangles].mean(axis=1)[:, 0]
    return mesh.areas[np.abs(centre - x) < 0.05].mean()


def test_the_meshes_are_fine_where_the_front_will_be(history):
    first, second = (interval.mesh for interval in history.intervals)
    for x in (0.6, 0.7, 0.8):
        assert finest(first, x) < 0.25 * finest(second, x)
    for x in (1.2, 1.3, 1.4):
        assert finest(second, x) < 0.25 * finest(first, x)


def test_the_mean_number_of_vertices_is_met(history):
    assert len(history.sweeps) == 3
    for sweep in (1, 2):
        assert history.mean_vertices(sweep) == pytest.approx(800, rel=0.06)
    assert "vertices, averaged over time" in str(history)


def test_intervals_of_another_length_count_by_their_length():
    mesh = am.generate(DOMAIN, 0.1)
    got = transient_loop(
        known, lambda m: front(m, 0), mesh, [0, 0.2, 1.0], target_vertices=600, sweeps=3
    )
    assert got.mean_vertices() == pytest.approx(600, rel=0.06)
    short, long = (len(i.mesh.points) for i in got.intervals)
    assert short < long  # the front covers less ground in the short one


def test_the_error_is_less_than_on_one_mesh(history):
    """At the end, on meshes of as many vertices."""
    fine = am.generate(DOMAIN, 0.01)

    def error(mesh, values):
        return np.sqrt(np.mean((am.transfer(values, mesh, fine) - front(fine, 1.0)) ** 2))

    last = history.intervals[-1]
    uniform = am.generate(DOMAIN, 0.054)
    assert len(uniform.points) > 800
    assert error(last.mesh, last.last["solution"]) < 0.3 * error(uniform, front(uniform, 1.0))


def test_fields_are_carried_from_interval_to_interval(history):
    one, two = history.intervals
    whole = (
        (mesh.areas * values[mesh.triangles].mean(axis=1)).sum()
        for mesh, values in ((one.mesh, one.last["solution"]), (two.mesh, two.first["solution"]))
    )
    assert next(whole) == pytest.approx(next(whole), abs=1e-12)
    assert (one.start, one.end, two.end) == (0, 0.5, 1.0)
    np.testing.assert_allclose(one.times, np.linspace(0, 0.5, 6))


def test_intersection_and_several_fields():
    def advance(mesh, fields, t0, t1):
        assert set(fields) == {"u", "v", "flag"}
        return {"u": front(mesh, t1), "v": mesh.points[:, 1] ** 2, "flag": fields["flag"]}

    def initial(mesh):
        flag = np.zeros(len(mesh.triangles))
        return {"u": front(mesh, 0), "v": mesh.points[:, 1] ** 2, "flag": flag}

    got = transient_loop(
        advance,
        initial,
        am.generate(DOMAIN, 0.1),
        TIMES,
        target_vertices=500,
        sweeps=2,
        in_time="intersection",
        fields=["u"],
        transfer="interpolation",
    )
    assert got.mean_vertices() == pytest.approx(500, rel=0.06)
    assert len(got.intervals[-1].last["flag"]) == len(got.intervals[-1].mesh.triangles)


def test_the_average_in_time_is_that_of_trapezoids():
    """Of a Hessian that grows linearly in time, sampled unevenly: its value in the middle."""
    from adaptmesh.transient import _Steering
    from metrics import Limits

    steering = _Steering(None, "least squares", "average", 2.0, Limits(), "intersection", 100)
    times = np.array([0.0, 0.1, 0.7, 1.0])
    samples = [[np.array([[1 + t, 0.0, 2.0]])] for t in times]
    (mean,) = steering.over_time(times, samples)
    np.testing.assert_allclose(mean, [[1.5, 0, 2]], atol=1e-12)


@pytest.mark.parametrize("in_time", ["average", "intersection"])
def test_it_may_begin_at_rest(in_time):
    """Nothing there at first, and in the whole first interval."""

    def advance(mesh, fields, t0, t1):
        return front(mesh, t1) if t0 > 0 else fields

    got = transient_loop(
        advance,
        lambda mesh: np.zeros(len(mesh.points)),
        am.generate(DOMAIN, 0.1),
        TIMES,
        target_vertices=400,
        in_time=in_time,
    )
    assert got.mean_vertices() == pytest.approx(400, rel=0.06)
    first, second = got.intervals
    assert len(first.mesh.points) < 0.2 * len(second.mesh.points)
    with pytest.raises(TransientError, match="at least one field"):
        transient_loop(
            lambda mesh, fields, t0, t1: fields,
            lambda mesh: np.zeros(len(mesh.points)),
            am.generate(DOMAIN, 0.2),
            TIMES,
            target_vertices=100,
        )


def failing(at):
    def advance(mesh, fields, t0, t1):
        if t0 == at:
            raise RuntimeError("diverged")
        return front(mesh, t1)

    return advance


def test_an_exception_leaves_what_there_was():
    mesh = am.generate(DOMAIN, 0.2)
    with pytest.raises(TransientError, match="sweep 0, interval 1: RuntimeError: diverged") as e:
        transient_loop(failing(0.5), lambda m: front(m, 0), mesh, TIMES, target_vertices=100)
    assert len(e.value.history.intervals) == 1
    assert isinstance(e.value.__cause__, RuntimeError)


@pytest.mark.parametrize(
    ("answer", "says"),
    [
        (lambda mesh, t1: iter([(t1 / 2, front(mesh, t1))]), "stopped at t = 0.25"),
        (lambda mesh, t1: iter([(9.0, front(mesh, t1))]), "came from t = 0 to 9"),
        (lambda mesh, t1: iter([]), "stopped at t = 0"),
        (lambda mesh, t1: np.full(len(mesh.points), np.nan), "not finite|nan"),
        (lambda mesh, t1: np.zeros(3), "3 values|shape"),
    ],
)
def test_what_advance_may_not_do(answer, says):
    with pytest.raises(TransientError, match=says):
        transient_loop(
            lambda mesh, fields, t0, t1: answer(mesh, t1),
            lambda m: front(m, 0),
            am.generate(DOMAIN, 0.2),
            TIMES,
            target_vertices=100,
        )


def test_options_are_checked():
    mesh = am.generate(DOMAIN, 0.3)
    for options, says in [
        ({"times": [0, 0]}, "ascending"),
        ({"times": [1]}, "two or more"),
        ({"in_time": "maximum"}, "in_time"),
        ({"transfer": "magic"}, "transfer"),
        ({"sweeps": 0}, "sweeps"),
    ]:
        given = {"times": TIMES, "target_vertices": 100, **options}
        with pytest.raises(ValueError, match=says):
            transient_loop(known, lambda m: front(m, 0), mesh, **given)
