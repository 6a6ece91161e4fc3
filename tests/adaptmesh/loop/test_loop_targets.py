"""What a loop converges to: the error or the count asked for, and only for what was asked."""

import numpy as np
import pytest
from reference.transforms import SIMILARITIES, TRANSFORMS

import adaptmesh as am
from adaptmesh.loop.error_control import next_count

L_SHAPE = [(0, 0), (1, 0), (1, 0.5), (0.5, 0.5), (0.5, 1), (0, 1)]


def wavy(mesh):
    return np.tanh(20 * (mesh.points[:, 0] - 0.4)) + np.sin(5 * mesh.points[:, 1])


@pytest.fixture(scope="module")
def start():
    return am.generate(am.Domain.polygon(L_SHAPE), 0.12)


@pytest.fixture(scope="module")
def done(start):
    history = am.adapt_loop(wavy, start, target_vertices=300, tolerance=0.05)
    assert history.converged
    return history


# How many vertices the next mesh is to have


@pytest.mark.parametrize("order", [0.6, 1.0, 2.0, 3.0])
@pytest.mark.parametrize("factor", [1e-2, 0.9, 1.0, 30.0])
def test_a_power_law_is_solved_by_the_third_mesh(order, factor):
    wanted = 1000.0
    counts = [wanted * factor]
    for _ in range(2):
        counts.append(next_count(counts, [(n / wanted) ** -order for n in counts], 1.0))
    assert counts[-1] == pytest.approx(wanted, rel=0.1)


def test_the_answer_lies_between_a_mesh_too_coarse_and_one_too_fine():
    assert 100 <= next_count([100, 200], [1.1, 0.1], 1.0) <= 200
    assert 100 <= next_count([200, 100], [0.99, 50.0], 1.0) <= 200
    assert next_count([100], [1.0], 1.0) == pytest.approx(100)


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("memory", [0.0, 0.3, 0.5, 0.6])
@pytest.mark.parametrize("start", [0.1, 3.0, 300.0])
def test_errors_that_depend_on_the_mesh_before_settle(order, memory, start):
    """What is seen on one mesh shapes the next: a part of the error is that of the mesh before."""
    wanted, growth = 100.0, 4.0
    counts, errors = [wanted * start], [start**-order]
    for _ in range(25):
        n = next_count(counts, errors, 1.0, growth)
        n = min(max(n, counts[-1] / growth), counts[-1] * growth)
        seen = (n / wanted) ** (1 - memory) * (counts[-1] / wanted) ** memory
        counts.append(n)
        errors.append(seen**-order)
    assert max(errors[-4:]) < 1.5 and min(errors[-4:]) > 1 / 1.5


def test_steps_are_bounded_by_growth():
    for growth in (1.01, 1.5, 4.0):
        assert next_count([100], [1e3], 1.0, growth) == pytest.approx(100 * growth)
        assert next_count([100], [1e-3], 1.0, growth) == pytest.approx(100 / growth)


@pytest.mark.parametrize("excess", [0.0, 1e-300, 1e300, np.inf])
def test_extreme_errors_give_a_number(excess):
    assert np.isfinite(next_count([100, 120], [2.0, excess], 1.0))


# error=


FIELDS = {
    "boundary layer": lambda x: np.exp(-x[:, 1] / 0.02),
    "shock": lambda x: np.tanh(20 * (x[:, 0] - 0.4)),
    "oblique shock": lambda x: np.tanh(20 * (x @ [0.6, 0.8] - 0.7)),
    "parabola": lambda x: x[:, 1] * (1 - x[:, 1]),
}


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("name", FIELDS)
def test_fields_that_vary_in_one_direction_settle_at_the_error_asked_for(name):
    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.1)
    history = am.adapt_loop(lambda m: FIELDS[name](m.points), mesh, error=1e-3, max_iterations=14)
    ratios = history.errors["solution"][-4:] / 1e-3
    assert np.abs(np.log(ratios)).mean() < 0.1 and (ratios < 1.3).all() and (ratios > 0.75).all()


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_the_error_asked_for_is_met_wherever_the_domain_lies(transform):
    """The L² norm carries the unit of the domain: by the scale, it is the same figure."""
    mesh = am.generate(am.Domain.polygon(transform(L_SHAPE)), 0.1 * transform.scale)

    def solve(m):
        return FIELDS["oblique shock"](transform.inverse(m.points))

    asked = 2e-3 * transform.scale
    history = am.adapt_loop(solve, mesh, error=asked, max_iterations=10)
    ratios = history.errors["solution"][-3:] / asked
    assert np.abs(np.log(ratios)).mean() < 0.15


# Fields without curvature


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_linear_fields_give_a_uniform_mesh_of_the_count_and_converge(transform):
    mesh = am.generate(am.Domain.polygon(transform(L_SHAPE)), 0.1 * transform.scale)
    slope = np.array([2.0, -3.0]) / transform.scale
    history = am.adapt_loop(
        lambda m: 1 + (m.points - m.points[0]) @ slope, mesh, target_vertices=300
    )
    assert history.converged and len(history) <= 4
    assert (history.errors["solution"] == 0).all()
    if transform in SIMILARITIES:
        assert "linear" in history.reason
        assert history.counts[-1] == pytest.approx(300, rel=0.08)
        assert np.ptp(np.log(history.mesh.areas)) < 3


def test_a_linear_field_has_any_error_asked_for_at_once(start):
    history = am.adapt_loop(lambda m: m.points @ [2.0, 3.0] - 7, start, error=1e-6)
    assert history.converged and len(history) == 1 and "linear" in history.reason


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_a_linear_field_takes_none_of_the_mesh_of_another(transform):
    mesh = am.generate(am.Domain.polygon(transform(L_SHAPE)), 0.12 * transform.scale)

    def front(m):
        return np.tanh(30 * (transform.inverse(m.points) @ [0.6, 0.8] - 0.5))

    def both(m):
        linear = (m.points - m.points[0]) @ [1.0, 2.0] / transform.scale
        return {"front": front(m), "linear": linear}

    options = {"target_vertices": 400, "max_iterations": 4}
    alone = am.adapt_loop(lambda m: {"front": front(m)}, mesh, **options)
    beside = am.adapt_loop(both, mesh, **options)
    assert np.array_equal(beside.mesh.points, alone.mesh.points)
    assert (beside.errors["linear"] == 0).all()


def test_a_slight_bend_is_not_taken_for_none(start):
    history = am.adapt_loop(
        lambda m: 1e3 * m.points[:, 0] + 1e-6 * np.tanh(20 * (m.points[:, 1] - 0.4)),
        start,
        target_vertices=300,
        max_iterations=2,
    )
    assert "linear" not in history.reason
    assert (history.errors["solution"] > 0).all()


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_a_feature_that_falls_between_the_vertices_is_no_convergence(transform):
    """The bump is seen on the first mesh, and by no vertex of the coarse one asked for."""
    ring = [(0, 0), (1.42, 1.44), (0.54, 2.28), (-0.52, 0.86)]
    mesh = am.generate(am.Domain.polygon(transform(ring)), 0.15 * transform.scale)

    def solve(m):
        x = transform.inverse(m.points)
        return 5 * x[:, 0] + np.exp(-((x - 0.5) ** 2).sum(axis=1) / 0.005)

    history = am.adapt_loop(solve, mesh, error=1e-2 * transform.scale)
    excess = history.errors["solution"] / (1e-2 * transform.scale)
    if history.converged:
        assert 0.5 < excess[-1] < 1.1
    else:
        assert "fallen between" in history.reason or "adapted 20 times" in history.reason


def test_a_smooth_field_still_has_the_coarsest_mesh(start):
    history = am.adapt_loop(lambda m: m.points[:, 0] ** 2, start, error=1.0)
    assert history.converged and history.errors["solution"][-1] < 0.1


# Resuming with other options


def test_another_target_is_gone_on_to(start, done):
    more = am.adapt_loop(wavy, start, target_vertices=900, tolerance=0.05, resume=done)
    assert more.converged and more.counts[-1] == pytest.approx(900, rel=0.05)
    assert more.options_since == len(done) - 1
    assert more[: len(done) - 1] == done[: len(done) - 1]
    straight = am.adapt_loop(wavy, done.mesh, target_vertices=900, tolerance=0.05)
    assert np.array_equal(more.mesh.points, straight.mesh.points)


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize(
    "options",
    [
        {"p": 1},
        {"h_min": 0.02},
        {"max_anisotropy": 3},
        {"gradation": 1.2},
        {"recovery": "least squares"},
        {"fields": ["solution"]},
        {"target_vertices": None, "error": 5e-3},
    ],
    ids=str,
)
def test_nothing_found_for_other_options_counts_as_convergence(start, done, options):
    options = {"target_vertices": 300, "tolerance": 0.05, **options}
    more = am.adapt_loop(wavy, start, resume=done, **options)
    straight = am.adapt_loop(wavy, done.mesh, **options)
    assert len(more) == len(done) + len(straight) - 1 > len(done) + 1
    assert [it.errors for it in more.for_options] == [it.errors for it in straight]
    assert more.converged == straight.converged


def test_the_same_target_is_converged_at_once(start, done):
    same = am.adapt_loop(wavy, start, target_vertices=300, tolerance=0.05, resume=done)
    assert same.converged and len(same) == len(done) and same.options_since == 0


def test_the_same_options_in_other_words_are_the_same(start):
    def solve(mesh):
        return {"u": wavy(mesh), "v": mesh.points[:, 1] ** 2}

    one = {"error": {"u": 0.02, "v": 1}, "fields": ["u", "v"], "h_min": 0, "max_iterations": 2}
    two = {"error": {"v": 1.0, "u": np.float64(0.02)}, "fields": ("u", "v"), "h_min": 0.0}
    done = am.adapt_loop(solve, start, **one)
    same = am.adapt_loop(solve, start, resume=done, max_iterations=2, **two)
    assert same.options_since == 0 and same.options == done.options
    other = am.adapt_loop(solve, start, resume=done, **{**one, "error": {"u": 0.02, "v": 2}})
    assert other.options_since == len(done) - 1


def test_iterations_for_other_options_do_not_count(start, done):
    options = {"target_vertices": 900, "tolerance": 0, "max_iterations": 2}
    more = am.adapt_loop(wavy, start, resume=done, **options)
    assert len(more) == len(done) + 2


def test_another_target_is_saved_and_gone_on_with_from_disk(start, tmp_path):
    run = tmp_path / "run"
    am.adapt_loop(wavy, start, target_vertices=200, tolerance=0.05, save=run)
    options = {"target_vertices": 400, "tolerance": 0}
    part = am.adapt_loop(wavy, start, resume=run, save=run, max_iterations=1, **options)
    loaded = am.History.load(run, start.domain)
    assert loaded.options_since == part.options_since > 0
    assert [it.errors for it in loaded] == [it.errors for it in part]
    whole = am.adapt_loop(wavy, start, resume=part, max_iterations=3, **options)
    from_disk = am.adapt_loop(wavy, start, resume=run, save=run, max_iterations=3, **options)
    assert np.array_equal(whole.mesh.points, from_disk.mesh.points)
    assert am.History.load(run).options_since == whole.options_since


def other_fields(mesh, previous):
    """A solver that has learned another field since the history was saved."""
    assert previous is None or set(previous) == {"u", "v"}
    return {"u": wavy(mesh), "v": mesh.points[:, 1] ** 2}


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize(
    "options",
    [
        {"target_vertices": 400, "fields": ["v"]},
        {"error": {"u": 5e-3, "v": 5e-3}},
        {"error": {"v": 5e-3}, "fields": ["v"]},
    ],
    ids=str,
)
@pytest.mark.parametrize("iterations", [0, 3])
def test_what_only_the_new_solver_returns_is_solved_for_again(start, options, iterations, tmp_path):
    def old(mesh):
        return {"u": wavy(mesh)}

    run = tmp_path / "run"
    done = am.adapt_loop(old, start, target_vertices=300, max_iterations=iterations, save=run)
    more = am.adapt_loop(other_fields, start, resume=run, save=run, max_iterations=2, **options)
    assert more.options_since == iterations and len(more) == iterations + 3
    assert np.array_equal(more[iterations].mesh.points, done.mesh.points)
    straight = am.adapt_loop(other_fields, done.mesh, max_iterations=2, **options)
    assert [it.errors for it in more.for_options] == [it.errors for it in straight]
    assert np.array_equal(am.History.load(run).mesh.points, straight.mesh.points)


def test_a_name_that_no_solver_returns_is_refused(start, done):
    with pytest.raises(am.LoopError, match=r"there is no field 'w' to adapt the mesh to") as caught:
        am.adapt_loop(other_fields, start, resume=done, target_vertices=400, fields=["w"])
    assert caught.value.history.iterations == done.iterations[:-1]
    options = {"target_vertices": 400, "fields": ["v"], "max_iterations": 0}
    more = am.adapt_loop(other_fields, start, resume=caught.value.history, **options)
    assert len(more) == len(done)  # nothing is lost by the attempt
    assert np.array_equal(more.mesh.points, done.mesh.points)


def advance(mesh, u, t0, t1):
    return np.tanh(20 * (mesh.points[:, 0] - t1))


@pytest.mark.parametrize(
    "options", [{"target_vertices": 300}, {"p": 1}, {"in_time": "intersection"}], ids=str
)
def test_a_history_in_time_is_not_handed_back_for_other_options(start, options, tmp_path):
    first = {"target_vertices": 150, "sweeps": 1}

    def loop(**options):
        initial = lambda mesh: np.tanh(20 * mesh.points[:, 0])  # noqa: E731
        return am.transient_loop(advance, initial, start, times=[0, 0.2, 0.4], **options)

    done = loop(save=tmp_path, **first)
    assert loop(resume=done, **first).options == done.options
    for resume in (done, tmp_path):
        with pytest.raises(ValueError, match=f"was made with {next(iter(options))}="):
            loop(resume=resume, **{**first, **options})
