"""Results of the public API by name, of all kinds: what `tests/same_bits.py` takes hashes of."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from benchmarks.cases import CASES, Problem

import adaptmesh as am
import metrics
from adaptmesh.curves import Bezier, BSpline, Circle, Line, Spline

from .figures import (
    channel,
    front,
    funnel,
    plate,
    ring,
    sector,
    solution,
    stadium,
    star,
    turned,
    wavy_cell,
)

MAKERS: dict[str, Callable[[], object]] = {}
"""What makes each result: a mesh, a domain, an array, or a list or dict of these."""


def case(name):
    """Enter a function among `MAKERS`."""

    def enter(make):
        assert name not in MAKERS, name
        MAKERS[name] = make
        return make

    return enter


# ------------------------------------------------------------------ straight domains

for _name in CASES:
    for _target in (1000, 10_000):

        @case(f"benchmark {_name} {_target}")
        def _(name=_name, target=_target):
            problem = Problem(CASES[name], target)
            return am.generate(problem.domain, problem.metric)


for _placement in ("front", "edges"):

    @case(f"plate, one size, {_placement}")
    def _(placement=_placement):
        return am.generate(plate(), 0.1, placement=placement)

    @case(f"square, wave, {_placement}")
    def _(placement=_placement):
        return am.generate(am.Domain.rectangle(0, 0, 1, 1), front, placement=placement)


@case("plate far away")
def _():
    return am.generate(plate(offset=(1e6, -1e6)), 0.1)


@case("plate scaled by 1e-6")
def _():
    return am.generate(plate(scale=1e-6, angle=2.1), 1e-7)


@case("plate scaled by 1e6")
def _():
    return am.generate(plate(scale=1e6, angle=-1.2), 1e5)


@case("stars with holes")
def _():
    holes = [turned(star(5, 0.15), angle, 1.0, (0.4 * np.cos(angle), 0.4 * np.sin(angle)))
             for angle in (0.3, 2.2, 4.4)]  # fmt: skip
    return am.generate(am.Domain.polygon(star(11, 1.5, 0.7), holes), 0.08)


@case("rings in rings")
def _():
    rings = [turned(star(4, r, 0.9), 0.2 * r) for r in (4.0, 3.0, 2.0, 1.0)]
    n = [len(r) for r in rings]
    segments = np.concatenate(
        [
            sum(n[:k]) + np.stack([np.arange(n[k]), np.roll(np.arange(n[k]), -1)], 1)
            for k in range(4)
        ]
    )
    return am.generate(am.Domain(np.concatenate(rings), segments), 0.25)


@case("points that are required, lines that end inside")
def _():
    points = turned([(0, 0), (3, 0), (3, 2), (0, 2), (0.5, 0.5), (2.5, 1.4), (1, 1.5), (2.2, 0.3)])
    return am.generate(am.Domain(points, [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5)]), 0.15)


@case("gradation")
def _():
    jump = lambda x: np.where(x[:, 0] + 0.3 * x[:, 1] < 0.5, 0.01, 0.2)  # noqa: E731
    return am.generate(am.Domain.rectangle(0, 0, 1, 1), jump, gradation=1.5)


@case("regions of given sizes")
def _():
    domain = plate()
    return am.generate(domain, metrics.RegionSizes(domain, {"left": 0.05, "right": 0.3}))


@case("distance to the sides")
def _():
    domain = plate()
    return am.generate(domain, metrics.Distance(domain.sides("hole"), h_min=0.02, growth=0.3))


@case("wall layer")
def _():
    domain = am.Domain.rectangle(0, 0, 2, 1)
    layer = metrics.BoundaryLayer(domain.sides("bottom"), 1e-3, 1.3, 0.1)
    return am.generate(domain, layer & 0.1)


@case("frozen sides")
def _():
    side = np.linspace(0, 1, 8)
    points = np.concatenate([np.stack([side, 0 * side], 1), [(1, 1), (0, 1)]])
    n = len(points)
    segments = np.stack([np.arange(n), np.roll(np.arange(n), -1)], 1)
    domain = am.Domain(turned(points), segments, names={"low": list(range(7))})
    return am.generate(domain.with_frozen("low"), 0.05)


# ------------------------------------------------------------------ curves


@case("curves: ring")
def _():
    return am.generate(ring(), funnel)


@case("curves: ring, edges")
def _():
    return am.generate(ring(), 0.1, placement="edges")


@case("curves: stadium, smooth and coarse")
def _():
    return am.generate(stadium(), 0.7)


@case("curves: stadium, named, wave")
def _():
    return am.generate(stadium(names={"floor": [0]}), front)


@case("curves: channel with an interface")
def _():
    return am.generate(channel(), 0.1)


@case("curves: holes that nearly touch")
def _():
    bolted = am.Domain.from_curves([Circle((0, 0), 1), Circle((0.97, 0.1), 0.01)])
    return am.generate(bolted, 1.0)


@case("curves: splines, Bezier and B-spline")
def _():
    curves = [
        Bezier([(0, 0), (1, -0.5), (2, 0.5), (3, 0)]),
        Spline([(3, 0), (3.3, 0.6), (2.9, 1.2), (3, 2)]),
        BSpline([(3, 2), (2, 2.5), (1, 1.5), (0, 2)]),
        Line((0, 2), (0, 0)),
    ]
    return am.generate(am.Domain.from_curves(curves), 0.12)


@case("curves: distance to the sides")
def _():
    domain = stadium()
    return am.generate(domain, metrics.Distance(domain.sides(), h_min=0.02, growth=0.3))


@case("curves: adapt")
def _():
    return am.adapt(am.generate(channel(), 0.2), front)


@case("curves: adapt and keep")
def _():
    return am.adapt(am.generate(ring(), 0.2), funnel, keep=True)


@case("curves: domain of a mesh without one")
def _():
    mesh = am.generate(ring(), 0.2)
    bare = am.Mesh(
        mesh.points, mesh.triangles, mesh.regions, mesh.edges, mesh.edge_tags, mesh.names
    )
    return am.adapt(bare, 0.12)


# ------------------------------------------------------------------ periodic


@case("periodic: turned square")
def _():
    corners = turned([(0, 0), (1, 0), (1, 1), (0, 1)])
    sides = {"bottom": [0], "right": [1], "top": [2], "left": [3]}
    domain = am.Domain(corners, [(0, 1), (1, 2), (2, 3), (3, 0)], names=sides)
    domain = domain.with_periodic("left", "right").with_periodic("bottom", "top")
    return am.generate(domain, front)


@case("periodic: wavy cell with a hole")
def _():
    return am.generate(wavy_cell(), 0.08)


@case("periodic: sector by rotation")
def _():
    return am.generate(sector(), lambda x: 0.05 + 0.05 * x[:, 1])


@case("periodic: adapt")
def _():
    return am.adapt(am.generate(wavy_cell(), 0.1), front)


@case("periodic: adapt and keep")
def _():
    return am.adapt(am.generate(sector(), 0.1), lambda x: 0.05 + 0.05 * x[:, 1], keep=True)


# ------------------------------------------------------------------ adapt and loops


@case("adapt: plate, function")
def _():
    return am.adapt(am.generate(plate(), 0.2), funnel)


@case("adapt: values at the vertices")
def _():
    mesh = am.generate(plate(), 0.1)
    return am.adapt(mesh, front(mesh.points))


@case("adapt: edges")
def _():
    return am.adapt(am.generate(plate(), 0.2), front, placement="edges")


@case("adapt: keep, twice")
def _():
    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), front)
    first = am.adapt(mesh, lambda x: front(x + np.array([0.02, 0.01])), keep=True)
    return [first, am.adapt(first, lambda x: front(x + np.array([0.04, 0.02])), keep=True)]


@case("adapt: frozen")
def _():
    return am.adapt(am.generate(plate(), 0.2), funnel, frozen=["hole"])


@case("adapt: a mesh without a domain")
def _():
    mesh = am.generate(plate(), 0.2)
    bare = am.Mesh(
        mesh.points, mesh.triangles, mesh.regions, mesh.edges, mesh.edge_tags, mesh.names
    )
    return am.adapt(bare, 0.1)


@case("loop: three iterations")
def _():
    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.1)
    history = am.adapt_loop(solution, mesh, target_vertices=800, max_iterations=3)
    return [iteration.mesh for iteration in history]


@case("loop: for an error, curved")
def _():
    mesh = am.generate(stadium(), 0.2)
    history = am.adapt_loop(solution, mesh, error=0.02, max_iterations=3)
    return [iteration.mesh for iteration in history]


@case("loop: in time")
def _():
    def advance(mesh, u, t0, t1):
        for t in np.linspace(t0, t1, 4)[1:]:
            yield t, np.tanh(30 * (mesh.points[:, 0] - 0.2 - 0.5 * t))

    def initial(mesh):
        return np.tanh(30 * (mesh.points[:, 0] - 0.2))

    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.1)
    history = am.transient_loop(advance, initial, mesh, [0, 0.5, 1], target_vertices=400, sweeps=2)
    return [interval.mesh for interval in history.intervals]


# ------------------------------------------------------------------ values, triangulations, repairs


@case("transfer: interpolation and projection")
def _():
    old, new = am.generate(plate(), 0.2), am.generate(plate(), funnel)
    u = np.sin(3 * old.points[:, 0]) * old.points[:, 1]
    of_triangles = u[old.triangles].mean(axis=1)
    return {
        "P1": am.transfer(u, old, new),
        "P1 conservative": am.transfer(u, old, new, method="conservative"),
        "P1 within bounds": am.transfer(u, old, new, method="conservative", keep_bounds=True),
        "P0 conservative": am.transfer(of_triangles, old, new, method="conservative", space="P0"),
    }


@case("transfer: between disks")
def _():
    disk = am.Domain.from_curves([Circle((0, 0), 1)])
    old, new = am.generate(disk, 0.2), am.generate(disk, funnel)
    u = np.exp(old.points[:, 0] - old.points[:, 1])
    return am.transfer(u, old, new, method="conservative")


@case("delaunay: random points")
def _():
    return am.delaunay(np.random.default_rng(3).random((5000, 2)))


@case("delaunay: a grid, turned")
def _():
    grid = np.stack(np.meshgrid(np.arange(40.0), np.arange(30.0)), axis=-1).reshape(-1, 2)
    return am.delaunay(turned(grid))


@case("repair: lines that cross")
def _():
    tangle = np.random.default_rng(8).random((40, 2))
    domain, _ = am.repair([tangle])
    return [domain, am.generate(domain, 0.1)]


@case("repair: borders that nearly match")
def _():
    rock = turned([(0, 0), (1, 0), (1, 1), (0, 1)])
    sand = turned([(1.001, 0), (2, 0), (2, 1), (0.999, 1)])
    domain, _ = am.repair({"rock": rock, "sand": sand}, tolerance=0.01)
    return [domain, am.generate(domain, 0.1)]


@case("simplify, and clean")
def _():
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    radius = 1 + 0.1 * np.sin(7 * angle) + 0.004 * np.sin(91 * angle)
    coast = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    domain, _ = am.simplify(am.Domain.polygon(coast), 0.02)
    return [domain, am.generate(domain, 0.1).cleaned()]


@case("metric of a solution")
def _():
    mesh = am.generate(plate(), 0.1)
    metric = metrics.metric_from_solution(
        mesh.points, mesh.triangles, solution(mesh), target_vertices=500
    )
    return [am.adapt(mesh, metric), metric(mesh.points)]
