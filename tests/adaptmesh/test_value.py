"""Objects that never change can be copied, pickled and compared, and stay what they are."""

import copy
import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest
import shapely
from reference.transforms import SIMILARITIES

import adaptmesh as am
import metrics
from adaptmesh.value import FrozenMapping


def curved_domain(transform=SIMILARITIES[0]):
    """An ellipse with a circular hole and a spline, named, and a point."""
    scale, (x, y) = transform.scale, transform((0, 0))
    outer = am.curves.EllipticArc((x, y), (2 * scale, scale), rotation=0.35)
    hole = am.curves.Circle((x, y), 0.3 * scale)
    line = am.curves.Spline(transform([(0.6, -0.3), (0.7, 0.1), (0.6, 0.4)]))
    names = {"outer": [0], "hole": [1], "line": [2]}
    return am.Domain.from_curves([outer, hole, line], names=names)


def periodic_domain():
    domain = am.Domain.rectangle(0, 0, 2, 1).with_periodic("left", "right")
    return domain.with_frozen("bottom")


def with_an_empty_part():
    return shapely.from_wkt("MULTIPOLYGON (((0 0, 1 0, 1 1, 0 0)), EMPTY)")


def things():
    square = am.Domain.rectangle(0, 0, 1, 1)
    mesh = am.generate(curved_domain(), 0.3)
    start = am.generate(square, 0.3)

    def solve(mesh):
        return {"u": np.tanh(9 * mesh.points[:, 0])}

    dirty = am.repair([(0, 0), (1, 1), (1, 0), (0, 1)])
    return {
        "domain": square,
        "domain of curves": mesh.domain,
        "periodic domain": periodic_domain(),
        "outline": am.Outline([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)]),
        "mesh": mesh,
        "mesh without a domain": am.Mesh(mesh.points, mesh.triangles),
        "kept": am.adapt(mesh, 0.4, keep=True),
        "report": am.measure(mesh, 0.3),
        "explanation": am.explain(mesh, 0.2),
        "validity": am.validate(mesh),
        "repairs": dirty[1],
        "history": am.adapt_loop(solve, start, target_vertices=60, max_iterations=2),
        "overlay": am.Overlay(mesh, am.generate(mesh.domain, 0.25)),
        "repairs without a place": am.repair(with_an_empty_part())[1],
        "nearest": am.nearest((0, 0), (1, 1)),
        "facing": am.facing((0, 1)),
        "solution": am.Solution({"u": np.array([1.0, np.nan])}, errors={"u": np.nan}),
        "circle": am.curves.Circle((0, 0), 1),
        "part": am.curves.Circle((0, 0), 1).part(0.2, 0.4),
        "uniform": metrics.Uniform(0.1),
        "intersection": metrics.Uniform(0.1) & 0.2,
        "expression": metrics.Expression("0.1 + x"),
        "background": metrics.Background.on(mesh, np.full(len(mesh.points), 0.1)),
    }


@pytest.fixture(scope="module")
def made():
    return things()


NAMES = [
    "domain",
    "domain of curves",
    "periodic domain",
    "outline",
    "mesh",
    "mesh without a domain",
    "kept",
    "report",
    "explanation",
    "validity",
    "repairs",
    "history",
    "overlay",
    "repairs without a place",
    "nearest",
    "facing",
    "solution",
    "circle",
    "part",
]
CARRIED = {
    "pickle": lambda thing: pickle.loads(pickle.dumps(thing)),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
}


@pytest.mark.parametrize("how", CARRIED)
@pytest.mark.parametrize("name", NAMES)
def test_what_is_carried_is_equal(made, name, how):
    thing = made[name]
    back = CARRIED[how](thing)
    assert type(back) is type(thing)
    assert back == thing
    assert hash(back) == hash(thing)
    assert repr(back) == repr(thing) and str(back) == str(thing)


@pytest.mark.parametrize("name", ["uniform", "intersection", "expression", "background"])
@pytest.mark.parametrize("how", CARRIED)
def test_a_control_space_that_is_carried_gives_the_same_metric(made, name, how):
    points = np.random.default_rng(0).uniform((0.6, -0.2), (1, 0.2), (50, 2))
    back = CARRIED[how](made[name])
    np.testing.assert_array_equal(back(points), made[name](points))


def test_all_are_tried(made):
    assert {*NAMES, "uniform", "intersection", "expression", "background"} == set(made)


@pytest.mark.parametrize("how", CARRIED)
def test_a_copy_stays_frozen(made, how):
    mesh = CARRIED[how](made["mesh"])
    with pytest.raises(ValueError, match="read-only"):
        mesh.points[0] = 0
    with pytest.raises(AttributeError):
        mesh.points = mesh.points + 1
    with pytest.raises(TypeError):
        mesh.names["other"] = 1
    with pytest.raises(ValueError, match="read-only"):
        mesh.domain.segments[0] = 0


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_a_domain_of_curves_that_is_carried_gives_the_same_bits(transform):
    domain = curved_domain(transform)
    back = pickle.loads(pickle.dumps(domain))
    assert back == domain
    size = 0.25 * transform.scale
    one, two = am.generate(domain, size), am.generate(back, size)
    assert one == two and one.points.tobytes() == two.points.tobytes()
    assert am.validate(pickle.loads(pickle.dumps(two)))


@pytest.mark.slow
def test_a_process_gives_the_mesh_that_this_one_gives():
    domain = periodic_domain()
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=context) as pool:
        assert pool.submit(am.generate, domain, 0.2).result() == am.generate(domain, 0.2)


def stopped():
    error = ValueError("no such thing")
    return [
        am.LoopError(am.History(), "solve", error, iteration=3),
        am.LoopInterrupted(am.History(), "adapt", None, iteration=3),
        am.TransientError(am.TransientHistory(), "save", error, sweep=1, interval=2),
        am.TransientInterrupted(am.TransientHistory(), "advance", None, sweep=1, interval=2),
    ]


@pytest.mark.parametrize("how", CARRIED)
@pytest.mark.parametrize("error", stopped(), ids=lambda error: type(error).__name__)
def test_errors_of_loops_are_carried_whole(error, how):
    back = CARRIED[how](error)
    assert type(back) is type(error)
    assert str(back) == str(error) and vars(back) == vars(error)


@pytest.mark.slow
def test_the_error_of_a_loop_comes_back_from_a_process():
    context = multiprocessing.get_context("spawn")
    mesh = am.generate(periodic_domain(), 0.4)
    no_solver = metrics.Uniform(0.1)  # takes points, not a mesh
    with (
        ProcessPoolExecutor(1, mp_context=context) as pool,
        pytest.raises(am.LoopError, match="iteration 0, solve") as caught,
    ):
        pool.submit(am.adapt_loop, no_solver, mesh).result()
    assert len(caught.value.history) == 0 and caught.value.stage == "solve"


def test_an_overlay_that_is_carried_projects_to_the_same_bits(made):
    overlay = made["overlay"]
    back = pickle.loads(pickle.dumps(overlay))
    values = np.sin(overlay.old_mesh.points @ [3.0, 2.0])
    np.testing.assert_array_equal(back.project(values), overlay.project(values))
    with pytest.raises(ValueError, match="read-only"):
        overlay.areas[0] = 0


def test_every_field_counts():
    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.4)
    changed = {
        "points": mesh.points * 2,
        "triangles": mesh.triangles[::-1],
        "regions": np.ones_like(mesh.regions),
        "edges": mesh.edges[::-1],
        "edge_tags": mesh.edge_tags + 1,
        "names": {"bottom": 1},
        "region_names": {"all": 0},
        "domain": None,
        "kept": np.arange(len(mesh.points)),
        "required_points": [0],
        "required_edges": [0],
    }
    fields = {name: getattr(mesh, name) for name in changed}
    assert am.Mesh(**fields) == mesh
    for name, value in changed.items():
        assert am.Mesh(**(fields | {name: value})) != mesh, name
    assert mesh != "a mesh" and mesh is not None


def test_domains_that_differ_are_not_equal():
    square = am.Domain.rectangle(0, 0, 1, 1)
    assert square == am.Domain.rectangle(0, 0, 1, 1)
    assert square != am.Domain.rectangle(0, 0, 1, 2)
    assert square != square.with_frozen("left")
    assert square != square.with_periodic("left", "right")
    assert curved_domain() == curved_domain()
    assert curved_domain() != curved_domain(SIMILARITIES[1])


def test_mappings_are_read_only():
    mapping = FrozenMapping({"a": 1})
    assert (
        mapping == {"a": 1} and dict(mapping) == mapping and mapping | {"b": 2} == {"a": 1, "b": 2}
    )
    assert repr(mapping) == "{'a': 1}"
    with pytest.raises(TypeError):
        mapping["a"] = 2
    assert pickle.loads(pickle.dumps(mapping)) == mapping


def test_dir_shows_what_is_public():
    for package in (am, metrics):
        assert set(package.__all__) == {name for name in dir(package) if not name.startswith("_")}
        assert all(hasattr(package, name) for name in dir(package))


@pytest.mark.parametrize("make", [curved_domain, lambda: am.Domain.rectangle(0, 0, 1, 1)])
def test_domains_and_their_meshes_are_frozen(make):
    domain = make()
    mesh = am.generate(domain, 0.5)
    for thing in (domain, domain.with_names({"all": lambda x: x[:, 0] < 9}), mesh):
        for name in ("points", "names", "periodic", "anything"):
            with pytest.raises(AttributeError):
                setattr(thing, name, None)
        with pytest.raises(AttributeError):
            del thing.names
        with pytest.raises(ValueError, match="read-only"):
            thing.points[0] = 0
        with pytest.raises(TypeError):
            thing.names["new"] = 1
