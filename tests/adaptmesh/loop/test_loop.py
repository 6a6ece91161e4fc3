"""The loop: convergence, what it takes and returns, what ends it."""

import dataclasses
import gc

import numpy as np
import pytest
from reference.transforms import SIMILARITIES

import adaptmesh as am
import metrics
from adaptmesh.loop.first_mesh import default_h_max


def front(x):
    return np.tanh(20 * (x[:, 1] - 0.5 - 0.2 * np.sin(2 * np.pi * x[:, 0])))


def sampled(mesh):
    return front(mesh.points)


@pytest.fixture(scope="module")
def square():
    return am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.08)


def test_it_converges_to_the_count_asked_for(square):
    history = am.adapt_loop(sampled, square, target_vertices=1500)
    assert history.converged
    assert len(history) <= 8
    assert history.counts[-1] == pytest.approx(1500, rel=0.03)
    assert history.errors["solution"][-1] < history.errors["solution"][0] / 20
    last = history[-3:]
    for numbers in ([it.n_points for it in last], [it.errors["solution"] for it in last]):
        assert max(numbers) <= 1.02 * min(numbers)
    assert all(it.unit_fraction > 0.99 for it in history[1:])
    assert np.isnan(history[0].unit_fraction)
    assert history.mesh is history[-1].mesh
    assert np.array_equal(history.fields["solution"], front(history.mesh.points))
    assert all(am.validate(mesh) for mesh in history.meshes)


def test_it_converges_to_the_error_asked_for(square):
    history = am.adapt_loop(sampled, square, error=2e-3)
    assert history.converged
    assert history.errors["solution"][-1] == pytest.approx(2e-3, rel=0.05)
    finer = am.adapt_loop(sampled, history.mesh, error=1e-3)
    assert finer.counts[-1] / history.counts[-1] == pytest.approx(2, rel=0.1)


def test_the_number_of_vertices_grows_no_faster_than_allowed(square):
    history = am.adapt_loop(sampled, square, target_vertices=3000, growth=2, max_iterations=3)
    ratios = history.counts[1:] / history.counts[:-1]
    np.testing.assert_allclose(ratios, 2, rtol=0.05)


@pytest.mark.parametrize("bare", [True, False])
def test_previous_is_the_last_result_on_the_new_mesh(square, bare):
    seen = []

    def solve(mesh, previous):
        seen.append(previous)
        u = front(mesh.points)
        return u if bare else {"u": u, "v": np.stack([u, 2 * u], axis=1), "cell": mesh.areas}

    am.adapt_loop(solve, square, target_vertices=500, max_iterations=1)
    assert seen[0] is None
    if bare:
        assert seen[1].ndim == 1
        u = seen[1]
    else:
        assert list(seen[1]) == ["u", "v", "cell"]
        u = seen[1]["u"]
        np.testing.assert_allclose(seen[1]["v"], np.stack([u, 2 * u], axis=1))
        assert len(seen[1]["cell"]) != len(u)
    new = am.adapt_loop(solve, square, target_vertices=500, max_iterations=1).mesh
    np.testing.assert_array_equal(u, am.transfer(sampled(square), square, new))


def test_a_solve_with_other_needs_is_refused(square):
    with pytest.raises(TypeError, match=r"needs 2 arguments, mesh, guess.*`previous`"):
        am.adapt_loop(lambda mesh, guess: None, square, target_vertices=500)
    with pytest.raises(TypeError, match="function of a mesh, got ndarray"):
        am.adapt_loop(np.ones(3), square, target_vertices=500)


def test_the_mesh_is_adapted_to_a_metric_as_it_is_or_scaled(square):
    def sizes(x):
        return 0.02 + 0.1 * x[:, 0]

    history = am.adapt_loop(lambda mesh: metrics.as_control_space(sizes), square)
    assert history.converged
    assert am.measure(history.mesh, sizes).unit_fraction > 0.98
    assert history.errors == {}
    packed = am.adapt_loop(
        lambda mesh: metrics.as_control_space(sizes)(mesh.points), square, target_vertices=600
    )
    assert packed.counts[-1] == pytest.approx(600, rel=0.05)


def test_beside_a_metric_fields_are_watched_until_they_settle(square):
    """Not only the number of vertices, which is right at once."""

    def solve(mesh):
        metric = metrics.metric_from_solution(
            mesh.points, mesh.triangles, sampled(mesh), target_vertices=400, h_max=0.25
        )
        return am.Solution({"u": sampled(mesh), "still": np.ones(len(mesh.points))}, metric=metric)

    history = am.adapt_loop(solve, square, target_vertices=400)
    assert history.converged
    assert list(history.errors) == ["u"]
    assert max(history.errors["u"][-3:]) <= 1.02 * min(history.errors["u"][-3:])
    alone = am.adapt_loop(lambda mesh: solve(mesh).metric, square, target_vertices=400)
    assert len(alone) < len(history)


@pytest.mark.slow
def test_fields_are_chosen_by_name_and_each_has_its_error(square):
    def solve(mesh):
        x = mesh.points
        return {"u": front(x), "v": front(x[:, ::-1]), "still": np.ones(len(x))}

    both = am.adapt_loop(solve, square, error={"u": 2e-3, "v": 8e-3, "still": 1})
    assert list(both.errors) == ["u", "v"]
    last = both[-1].errors
    assert max(last["u"] / 2e-3, last["v"] / 8e-3) == pytest.approx(1, rel=0.05)
    one = am.adapt_loop(solve, square, error=1e-2, fields=["u"])
    assert list(one.errors) == ["u"]
    assert one.counts[-1] < both.counts[-1]


def test_the_solvers_own_error_counts(square):
    def solve(mesh):
        return am.Solution(sampled(mesh), errors=100 / len(mesh.points))

    history = am.adapt_loop(solve, square, error=0.1)
    assert history.converged
    assert history.errors["error"][-1] == pytest.approx(0.1, rel=0.03)

    def slow(mesh):  # of half the order
        return am.Solution(sampled(mesh), errors={"energy": len(mesh.points) ** -0.5})

    history = am.adapt_loop(slow, square, error=0.04, order=0.5)
    assert history.counts[-1] == pytest.approx(625, rel=0.05)


@pytest.mark.slow
def test_regions_names_and_areas_are_kept_by_many_iterations(plate):
    mesh = am.generate(plate, 0.3)
    bare = dataclasses.replace(mesh, domain=None)
    angles = iter(np.linspace(0, 3, 100))

    def turning(mesh):
        a = next(angles)
        return np.tanh(5 * (mesh.points @ [np.cos(a), np.sin(a)] - 1))

    history = am.adapt_loop(turning, bare, target_vertices=300, max_iterations=30, tolerance=0)
    assert len(history) == 31
    for later in (history[15].mesh, history.mesh):
        assert later.names == mesh.names
        assert later.region_names == mesh.region_names
        for name in mesh.region_names:
            assert later.areas[later.triangles_in(name)].sum() == pytest.approx(
                mesh.areas[mesh.triangles_in(name)].sum(), rel=1e-13
            )
        for name in mesh.names:
            ends = [m.points[m.edges_named(name)] for m in (mesh, later)]
            assert len({len(e) for e in ends}) >= 1
            lengths = [np.linalg.norm(e[:, 1] - e[:, 0], axis=1).sum() for e in ends]
            assert lengths[1] == pytest.approx(lengths[0], rel=1e-13)
    assert len(history[15].mesh.domain.points) == len(history.mesh.domain.points)


@pytest.mark.slow
def test_meshes_that_nobody_keeps_are_let_go(square, tmp_path):
    def alive():
        gc.collect()
        return sum(isinstance(o, am.Mesh) for o in gc.get_objects())

    before = alive()
    counts = []

    def solve(mesh):
        counts.append(alive() - before)
        return sampled(mesh)

    history = am.adapt_loop(
        solve,
        square,
        target_vertices=300,
        tolerance=0,
        max_iterations=6,
        save=tmp_path / "run",
        keep_last=1,
    )
    assert counts[-1] <= 2  # the last, and the one that is solved on
    assert [len(mesh.points) for mesh in history.meshes] == history.counts.tolist()


# What ends it


def test_budgets_end_it_in_peace(square):
    history = am.adapt_loop(sampled, square, error=1e-4, budget=am.Budget(vertices=1000))
    assert not history.converged
    assert "1,000 vertices" in history.reason
    assert history.counts.max() <= 1000
    assert history.counts[-1] > 850
    history = am.adapt_loop(sampled, square, target_vertices=900, budget=am.Budget(seconds=0))
    assert len(history) == 1
    assert "0 s" in history.reason
    fine = am.adapt_loop(lambda mesh: metrics.Uniform(0.001), square, budget=am.Budget(5000))
    assert "max_vertices is 5,000" in fine.reason
    assert len(fine) == 1


def test_the_number_of_iterations_ends_it(square):
    history = am.adapt_loop(sampled, square, target_vertices=900, max_iterations=0)
    assert len(history) == 1
    assert history.mesh.domain is square.domain
    assert "adapted 0 times" in history.reason


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"target_vertices": 500, "error": 0.1}, "one target"),
        ({"target_vertices": 2}, "at least 3"),
        ({"target_vertices": np.nan}, "at least 3"),
        ({"error": -1}, "positive"),
        ({"error": {"u": 0}}, "positive"),
        ({"target_vertices": 500, "growth": 1}, "growth"),
        ({"target_vertices": 500, "order": 0}, "order"),
        ({"target_vertices": 500, "p": 0.5}, "L"),
        ({"target_vertices": 500, "tolerance": -1}, "tolerance"),
        ({"target_vertices": 500, "max_iterations": -1}, "max_iterations"),
        ({"target_vertices": 500, "transfer": "magic"}, "magic"),
        ({"target_vertices": 500, "keep_last": 0}, "keep_last"),
        ({"target_vertices": 500, "keep_last": 1}, "save"),
        ({"target_vertices": 500, "budget": am.Budget(400)}, "more than the budget"),
        ({"target_vertices": 10}, "all sizes h_max = 0.25 a mesh has about 27; raise h_max"),
        ({"target_vertices": 500, "max_iterations": 1.5}, "whole number"),
        ({"target_vertices": 500, "recovery": "magic"}, "'least squares'"),
        ({"target_vertices": 500, "combine": "magic"}, "combined by"),
        ({"target_vertices": 500, "h_min": 1}, "h_min <= h_max"),
        ({"target_vertices": 500, "gradation": 0.5}, "beta must be above 1"),
        ({"target_vertices": 500, "max_anisotropy": 0}, "max_anisotropy"),
        ({"error": {}}, "give the error of each field"),
        ({"target_vertices": 500, "fields": []}, "give the names"),
    ],
)
def test_options_that_make_no_sense_are_refused_before_any_solve(square, options, message):
    with pytest.raises(ValueError, match=message):
        am.adapt_loop(lambda mesh: pytest.fail("solved"), square, **options)


def test_fields_is_a_list_and_the_mesh_a_mesh(square):
    with pytest.raises(TypeError, match=r"\['u'\]"):
        am.adapt_loop(sampled, square, target_vertices=500, fields="u")
    with pytest.raises(TypeError, match="expected a Mesh to begin with, got ndarray"):
        am.adapt_loop(sampled, square.points, target_vertices=500)


@pytest.mark.parametrize(
    "options",
    [
        {"target_vertices": "500"},
        {"target_vertices": None, "error": "small"},
        {"target_vertices": None, "error": {"u": None}},
        {"p": "2"},
        {"growth": None},
        {"tolerance": "a"},
        {"max_iterations": None},
        {"budget": 100},
        {"callback": 3},
    ],
)
def test_options_of_another_type_are_named(square, options):
    name = list(options)[-1]
    with pytest.raises(TypeError, match=rf"^{name}.*(wanted|expected|give|function)"):
        am.adapt_loop(sampled, square, **{"target_vertices": 500, **options})


# What goes wrong in it


def broken(stage, at):
    """A solve that goes wrong in the iteration `at`."""
    calls = []

    def solve(mesh):
        u = sampled(mesh)
        calls.append(mesh)
        if len(calls) <= at:
            return u
        return {
            "raise": lambda: 1 / 0,
            "nan": lambda: np.where(np.arange(len(u)) == 7, np.nan, u),
            "short": lambda: u[:-1],
            "none": lambda: None,
            "text": lambda: "done",
            "names": lambda: np.array(["a"] * len(u)),
            "matrix": lambda: np.stack([u, u], axis=1),
            "key": lambda: {3: u},
            "empty": dict,
            "flat": lambda: np.zeros(len(u)),
            "masked": lambda: np.ma.masked_less(u, 0),
            "huge": lambda: 1e200 * u / np.abs(u).max(),
            "complex": lambda: 1j * u,
            "indefinite": lambda: np.tile([1.0, 5.0, 1.0], (len(u), 1)),
            "estimate": lambda: am.Solution(u, errors=np.nan),
        }[stage]()

    return solve


@pytest.mark.parametrize("at", [0, 2])
@pytest.mark.parametrize(
    ("stage", "cause", "message"),
    [
        ("raise", ZeroDivisionError, "division by zero"),
        ("nan", am.TransferError, r"value 7, at \(.*nan: not finite"),
        ("short", ValueError, r"expected \d+ values at the vertices .*, got \d+"),
        ("none", TypeError, "return statement"),
        ("text", TypeError, "expected an array of numbers, got str"),
        ("names", TypeError, "array of <U1"),
        ("matrix", ValueError, "go into a dict"),
        ("key", TypeError, "names of fields are strings, got 3"),
        ("empty", TypeError, "neither fields nor a metric"),
        ("flat", am.MetricError, "the fields say nothing about sizes"),
        ("indefinite", am.MetricError, "positive definite"),
        ("masked", TypeError, "masked values: fill them"),
        ("huge", am.MetricError, r"field 'solution' has values up to 1e\+200: choose a unit"),
        (
            "complex",
            am.MetricError,
            "no field that the mesh can be adapted to: expected real values",
        ),
        ("estimate", ValueError, "'error' must be finite"),
    ],
)
def test_the_history_survives_what_goes_wrong(square, stage, cause, message, at):
    with pytest.raises(am.LoopError, match=message) as caught:
        am.adapt_loop(broken(stage, at), square, target_vertices=400)
    error = caught.value
    assert str(error).startswith(f"iteration {at}, {error.stage}: {cause.__name__}: ")
    assert error.iteration == len(error.history) == at
    assert isinstance(error.__cause__, cause)


def test_it_is_an_error_to_ask_for_an_error_where_there_is_none(square):
    with pytest.raises(am.LoopError, match="no estimate of its own"):
        am.adapt_loop(lambda mesh: metrics.Uniform(0.1), square, error=0.1)
    with pytest.raises(am.LoopError, match="neither target_vertices nor error"):
        am.adapt_loop(sampled, square)
    with pytest.raises(
        am.LoopError, match=r"no field 'u' to adapt the mesh to; solve gave 'solution'"
    ):
        am.adapt_loop(sampled, square, target_vertices=500, fields=["u"])
    with pytest.raises(am.LoopError, match="error has no value for 'solution'"):
        am.adapt_loop(sampled, square, error={"u": 1})
    with pytest.raises(
        am.LoopError, match=r"error has a value for 'w', but solve gave 'solution'$"
    ):
        am.adapt_loop(sampled, square, error={"solution": 1, "w": 1})
    with pytest.raises(am.LoopError, match="error has no value for 'v'"):
        am.adapt_loop(lambda mesh: {"u": sampled(mesh), "v": sampled(mesh)}, square, error={"u": 1})


def test_an_error_that_the_coarsest_mesh_has_gives_the_coarsest_mesh(square):
    history = am.adapt_loop(sampled, square, error=1e6)
    assert history.converged
    assert len(history.mesh.points) == pytest.approx(27, abs=4)  # sizes of a quarter


def test_an_error_out_of_reach_ends_at_the_budget(square):
    history = am.adapt_loop(sampled, square, error=1e-12, budget=am.Budget(vertices=1500))
    assert not history.converged
    assert 1200 < len(history.mesh.points) <= 1500


@pytest.mark.parametrize("transfer", ["interpolation", "conservative"])
def test_fields_of_all_spaces_are_carried_over_regions(plate, transfer):
    def solve(mesh, previous):
        edges, n = mesh.unique_edges, len(mesh.points)
        nodes = np.concatenate([mesh.points, mesh.points[edges].mean(axis=1)])
        if previous is not None:
            sizes = {name: len(values) for name, values in previous.items()}
            assert sizes == {"u": n, "k": len(mesh.triangles), "v": n + len(edges), "w": n}
            np.testing.assert_allclose(previous["v"], nodes @ [[1, 2], [3, 4]], atol=1e-9)
        return {
            "u": sampled(mesh),
            "k": np.where(mesh.regions == mesh.regions[0], 1.0, 1e6),
            "v": nodes @ [[1.0, 2], [3, 4]],
            "w": 1j * sampled(mesh),
        }

    history = am.adapt_loop(
        solve, am.generate(plate, 0.15), target_vertices=300, max_iterations=2, transfer=transfer
    )
    assert len(history) == 3


def test_meshes_that_did_not_come_from_here(square):
    from scipy.spatial import Delaunay

    points = np.random.default_rng(0).random((60, 2))
    triangles = Delaunay(points).simplices
    history = am.adapt_loop(
        sampled, am.Mesh(points, triangles), target_vertices=150, max_iterations=2
    )
    assert history.mesh.areas.sum() == pytest.approx(am.Mesh(points, triangles).areas.sum())
    with pytest.raises(am.DomainError, match=r"triangle 0, .* is clockwise"):
        am.adapt_loop(sampled, am.Mesh(points, triangles[:, ::-1]), target_vertices=150)
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0], [1, 1]], float)
    with pytest.raises(am.DomainError, match="vertices 0 and 4 of the mesh are the same"):
        am.adapt_loop(sampled, am.Mesh(corners, [[0, 1, 2], [4, 5, 3]]), target_vertices=150)
    crossing = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.9, 0.1], [0.2, 2.0]], float)
    bowtie = am.Mesh(crossing, [[0, 1, 2], [3, 4, 5]])
    with pytest.raises(am.DomainError, match="the mesh lies over itself near"):
        am.adapt_loop(sampled, bowtie, target_vertices=150)
    loose = am.Mesh(np.vstack([square.points, [[5, 5]]]), square.triangles)
    with pytest.raises(am.LoopError, match=r"\(5.0, 5.0\) is in no triangle"):
        am.adapt_loop(sampled, loose, target_vertices=150)


def test_ctrl_c_and_errors_of_the_callback_leave_the_history(square):
    def interrupt(iteration):
        if iteration.number == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as caught:
        am.adapt_loop(sampled, square, target_vertices=400, callback=interrupt)
    assert isinstance(caught.value, am.LoopInterrupted)
    assert (len(caught.value.history), caught.value.stage) == (2, "callback")

    def fail(iteration):
        raise RuntimeError("no plotter")

    with pytest.raises(am.LoopError, match="iteration 0, callback: RuntimeError: no plotter"):
        am.adapt_loop(sampled, square, target_vertices=400, callback=fail)


def test_what_solve_does_with_its_arrays_later_does_not_matter(square):
    buffer = {}

    def solve(mesh):
        for kept in buffer.values():
            kept[:] = np.nan
        buffer[len(buffer)] = sampled(mesh)
        return buffer[len(buffer) - 1]

    history = am.adapt_loop(solve, square, target_vertices=300, max_iterations=2)
    assert np.array_equal(history[0].fields["solution"], sampled(square))
    with pytest.raises(ValueError, match="read-only"):
        history[0].fields["solution"][0] = 1


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_the_largest_size_does_not_depend_on_the_axes(transform):
    """A layer along a line is resolved across; along it, sizes are the largest allowed."""
    corners = np.array([(0, 0), (1, 0), (1, 0.4), (0.4, 0.6), (0, 0.6)])

    def solve(mesh):
        x = transform.inverse(mesh.points)
        return np.tanh(30 * (x[:, 0] + 0.3 * x[:, 1] - 0.6))

    mesh = am.generate(am.Domain.polygon(transform(corners)), 0.08 * transform.scale)
    assert default_h_max(mesh) == pytest.approx(0.25 * transform.scale, rel=1e-8)
    history = am.adapt_loop(solve, mesh, target_vertices=300, max_iterations=6)
    assert len(history.mesh.points) == pytest.approx(300, rel=0.06)
    assert history.errors["solution"][-1] / transform.scale == pytest.approx(6.9e-5, rel=0.12)
