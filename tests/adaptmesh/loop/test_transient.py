"""The fixed point in time: meshes that are fine where the front is going to be."""

import numpy as np
import pytest
from reference.transforms import SIMILARITIES

import adaptmesh as am
from adaptmesh import TransientError, transient_loop
from adaptmesh.loop.target_in_time import TargetInTime

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
    """The mean area of the triangles across the line at x."""
    corners = mesh.points[mesh.triangles][:, :, 0]
    across = (corners.min(axis=1) <= x) & (x <= corners.max(axis=1))
    return mesh.areas[across].mean()


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
    assert repr(history) == "<TransientHistory: 3 sweeps of 2 intervals>"
    assert history.seconds.total > history.seconds.solve > 0
    assert len(repr(history.intervals[0])) < 300


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


@pytest.mark.parametrize("transform", SIMILARITIES[1:], ids=str)
@pytest.mark.parametrize("keep_bounds", [False, True])
def test_fields_are_carried_on_slanted_domains(transform, keep_bounds):
    """What no step changes stays, from mesh to mesh: a linear field, and the integral of noise."""
    corners = transform([(0, 0), (2, 0.3), (1.8, 1.2), (0.1, 1)])
    domain = am.Domain.polygon(corners)
    changes = []

    def place(mesh):
        return transform.inverse(mesh.points)

    def fields(mesh, t, kept):
        return {"front": np.tanh(20 * (place(mesh)[:, 0] - 0.5 - t)), **kept}

    def initial(mesh):
        noise = np.random.default_rng(len(mesh.points)).random(len(mesh.points))
        return fields(mesh, 0, {"linear": place(mesh) @ [1, 2], "noise": noise})

    def integral(mesh, values):
        return mesh.areas @ values[mesh.triangles].mean(axis=1) / mesh.areas.sum()

    def advance(mesh, given, t0, t1):
        kept = {name: given[name] for name in ("linear", "noise")}
        off = np.abs(kept["linear"] - place(mesh) @ [1, 2]).max()
        changes.append((off, integral(mesh, kept["noise"])))
        yield 0.5 * (t0 + t1), fields(mesh, 0.5 * (t0 + t1), kept)
        yield t1, fields(mesh, t1, kept)

    transient_loop(
        advance,
        initial,
        am.generate(domain, 0.15 * transform.scale),
        [0, 0.3, 0.6, 0.9],
        target_vertices=300,
        sweeps=1,
        fields=["front"],
        keep_bounds=keep_bounds,
    )
    off, integrals = np.transpose(changes)
    assert len(off) == 3
    # Within bounds a linear field may be cut off at its extremes.
    assert off.max() < (0.1 if keep_bounds else 1e-12 + 1e3 * transform.rounding)
    np.testing.assert_allclose(integrals, integrals[0], rtol=1e-13 + 10 * transform.rounding)


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
    target = TargetInTime(target_vertices=100, recovery="least squares", in_time="average")
    times = np.array([0.0, 0.1, 0.7, 1.0])
    samples = [{"u": np.array([[1 + t, 0.0, 2.0]])} for t in times]
    mean = target.over_time(times, samples)["u"]
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
    says = "sweep 0, interval 1, advance: RuntimeError: diverged"
    with pytest.raises(TransientError, match=says) as e:
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
        (
            lambda mesh, t1: np.zeros(3),
            "the solution: expected 72 values at the vertices .*, got 3",
        ),
        (
            lambda mesh, t1: iter([front(mesh, t1)]),
            "expected a time and the fields then.*yielded ndarray",
        ),
        (lambda mesh, t1: None, "advance returned None"),
        (lambda mesh, t1: {"u": front(mesh, t1)}, "advance gave 'u' at t = 0.5, but began with 's"),
        (lambda mesh, t1: front(mesh, t1) * 1j, "no field that the mesh can be adapted to"),
        (
            lambda mesh, t1: np.ones((len(mesh.points), 3)) * [1, 0, 1],
            "in time meshes are adapted to fields only",
        ),
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
        ({"target_vertices": np.nan}, "target_vertices=nan"),
        ({"target_vertices": 2}, "target_vertices=2"),
        ({"fields": "u"}, "give a list of names"),
        ({"fields": []}, "give the names"),
        ({"p": 0.5}, "p is that of"),
        ({"recovery": "magic"}, "'least squares'"),
        ({"h_min": 3}, "h_min <= h_max"),
        ({"sweeps": 1.5}, "whole number"),
        ({"callback": 3}, "callback must be a function"),
        ({"target_vertices": 8}, "raise h_max, or ask for more"),
    ]:
        given = {"times": TIMES, "target_vertices": 100, **options}
        with pytest.raises((ValueError, TypeError), match=says):
            transient_loop(known, lambda m: front(m, 0), mesh, **given)


def test_sums_of_steps_need_not_end_at_the_last_bit():
    def advance(mesh, u, t0, t1):
        t = t0
        for _ in range(10):
            t += (t1 - t0) / 10
            yield t, front(mesh, t)

    mesh = am.generate(DOMAIN, 0.2)
    times = [0, 0.3, 0.9]
    got = transient_loop(advance, lambda m: front(m, 0), mesh, times, target_vertices=100, sweeps=1)
    assert [i.times[-1] for i in got.intervals] == times[1:]


class Diffusing:
    """Steps that depend on what was carried; stopped in the middle of its k-th interval."""

    def __init__(self, stop, error=KeyboardInterrupt):
        self.left, self.error = stop, error

    def __call__(self, mesh, fields, t0, t1):
        for t in np.linspace(t0, t1, 4)[1:]:
            if not self.left and t > t0 + 0.5 * (t1 - t0):
                raise self.error
            u = 0.5 * (fields["u"] + front(mesh, t))
            fields = {"u": u, "area": mesh.areas}
            yield t, fields
        self.left -= 1


def beginning(mesh):
    return {"u": front(mesh, 0), "area": mesh.areas}


def assert_same(one, two):
    assert [len(s) for s in one.sweeps] == [len(s) for s in two.sweeps]
    for a, b in zip(sum(one.sweeps, ()), sum(two.sweeps, ()), strict=True):
        for name in ("points", "triangles", "regions", "edges", "edge_tags"):
            np.testing.assert_array_equal(getattr(a.mesh, name), getattr(b.mesh, name))
        assert a.mesh.names == b.mesh.names
        assert (a.start, a.end, a.times.tolist()) == (b.start, b.end, b.times.tolist())
        for name in ("first", "last", "hessians"):
            mine, theirs = getattr(a, name), getattr(b, name)
            assert list(mine) == list(theirs)
            for field in mine:
                np.testing.assert_array_equal(mine[field], theirs[field])


@pytest.fixture(scope="module")
def whole():
    mesh = am.generate(DOMAIN, 0.15)
    return mesh, transient_loop(
        Diffusing(-1), beginning, mesh, TIMES, target_vertices=300, fields=["u"]
    )


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("stop", [0, 1, 2, 5])
def test_stopped_in_the_middle_of_an_interval_and_resumed(whole, stop, tmp_path):
    mesh, expected = whole
    options = {"target_vertices": 300, "fields": ["u"]}
    with pytest.raises(am.TransientInterrupted, match=f"interval {stop % 2}, advance") as caught:
        transient_loop(Diffusing(stop), beginning, mesh, TIMES, save=tmp_path / "run", **options)
    left = caught.value.history
    assert sum(map(len, left.sweeps)) == stop
    in_memory = transient_loop(Diffusing(-1), beginning, mesh, TIMES, resume=left, **options)
    assert_same(in_memory, expected)
    run = tmp_path / "run"
    transient_loop(Diffusing(-1), beginning, mesh, TIMES, resume=run, save=run, **options)
    assert_same(am.TransientHistory.load(run), expected)


def test_a_history_in_time_is_saved_and_asked_for_more(whole, tmp_path):
    mesh, history = whole
    history.save(tmp_path / "a")
    again = am.TransientHistory.load(tmp_path / "a", mesh.domain)
    assert_same(again, history)
    assert again.seconds == history.seconds
    options = {"target_vertices": 300, "fields": ["u"]}
    with pytest.raises(am.FormatError, match="there is a history in this folder"):
        transient_loop(Diffusing(-1), beginning, mesh, TIMES, save=tmp_path / "a", **options)
    done = transient_loop(
        lambda *a: pytest.fail("advanced"),
        beginning,
        mesh,
        TIMES,
        resume=again,
        **options,
    )
    assert done is again
    more = transient_loop(Diffusing(-1), beginning, mesh, TIMES, resume=again, sweeps=4, **options)
    assert len(more.sweeps) == 4
    with pytest.raises(ValueError, match="not those of times"):
        transient_loop(Diffusing(-1), beginning, mesh, [0, 1], resume=history, **options)
    with pytest.raises(ValueError, match="not those of times"):
        transient_loop(Diffusing(-1), beginning, mesh, [0, 0.5, 1, 2], resume=history, **options)
    other = am.generate(DOMAIN, 0.3)
    with pytest.raises(ValueError, match="began with another mesh"):
        transient_loop(Diffusing(-1), beginning, other, TIMES, resume=history, **options)


def test_damaged_histories_in_time_are_named(whole, tmp_path):
    _, history = whole
    with pytest.raises(am.FormatError, match="no history in time here"):
        am.TransientHistory.load(tmp_path)
    history.save(tmp_path)
    file = tmp_path / "sweep_01_interval_0001.npz"
    content = file.read_bytes()
    file.write_bytes(content[:100])
    with pytest.raises(am.FormatError, match=r"sweep_01_interval_0001\.npz: is damaged"):
        am.TransientHistory.load(tmp_path)
    file.unlink()
    with pytest.raises(am.FormatError, match=r"sweep_01_interval_0001\.npz is missing"):
        am.TransientHistory.load(tmp_path)
    (tmp_path / "transient.json").write_text("[]")
    with pytest.raises(am.FormatError, match="is damaged"):
        am.TransientHistory.load(tmp_path)


def test_errors_of_the_callback_and_of_initial():
    mesh = am.generate(DOMAIN, 0.3)

    def refuse(sweep, number, interval):
        raise RuntimeError("no")

    with pytest.raises(TransientError, match="sweep 0, interval 0, callback: Runtime") as caught:
        transient_loop(
            known, lambda m: front(m, 0), mesh, TIMES, target_vertices=100, callback=refuse
        )
    assert len(caught.value.history.intervals) == 1  # it was complete
    with pytest.raises(TransientError, match="interval 0, initial: TypeError: initial returned"):
        transient_loop(known, lambda m: None, mesh, TIMES, target_vertices=100)
    with pytest.raises(TypeError, match="advance must be a function, got int"):
        transient_loop(3, lambda m: None, mesh, TIMES, target_vertices=100)
