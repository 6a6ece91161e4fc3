"""Nothing in `metrics` depends on the axes, the unit of length, or how a mesh is numbered.

Each public name has a case: a function that computes with it in a `Frame` and brings all that comes
out back to the frame of the figure, where it must be what it is there. A public name without a case
fails, and so does a case for what is no longer public.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from reference.frames import frames
from reference.meshes import from_axes, irregular_square

import metrics
from metrics import tensor

POINTS, TRIANGLES = irregular_square(10, seed=3)
POINTS = POINTS @ np.array([[1.0, 0.1], [-0.2, 0.8]])  # no side along an axis
OWN, FRAMES = frames(POINTS, TRIANGLES)
N, M = len(POINTS), len(TRIANGLES)
X, Y = POINTS.T
U = np.sin(3 * X + Y) + np.tanh(6 * (Y - 0.4 * X - 0.2))
VELOCITY = np.stack([np.sin(3 * X) * Y, np.cos(2 * Y) + X**2], axis=1)
RNG = np.random.default_rng(7)
ANISOTROPIC = from_axes(0.02 * 10 ** RNG.uniform(0, 1, N), 0.3, RNG.uniform(0, np.pi, N))
OTHER = from_axes(0.05 + 0.1 * X, 0.2 + 0.1 * Y, 1 + X)
CENTRES = POINTS[TRIANGLES].mean(axis=1)
INSIDE = CENTRES[::7] + 0.01 * RNG.uniform(-1, 1, CENTRES[::7].shape)
LOOP = np.array([(0.1, 0.1), (0.8, 0.2), (0.6, 0.7), (0.3, 0.5)])

CASES = {}
NOT_COMPUTED = {
    "AdaptmeshError": "an error",
    "MetricError": "an error",
    "Metric": "a type",
    "ControlSpace": "abstract; its operations are under as_control_space",
    "tensor": "a module; its functions have cases of their own",
    "Raster": "along the axes: tests/metrics/sizes/test_sizes_raster.py",
    "read": "a file holds numbers: tests/metrics/test_metric_files.py",
}


def case(*names, amplified=1.0):
    """Register a function of a frame for public names; `amplified`: by how much it does rounding.

    Second derivatives, for example, divide by the square of the size.
    """

    def register(function):
        CASES[function.__name__] = names, function, amplified
        return function

    return register


def test_each_public_name_has_a_case():
    public = {*metrics.__all__, *metrics.sizes.__all__} - set(NOT_COMPUTED)
    public |= {f"tensor.{name}" for name in tensor.__all__}
    covered = {name for names, *_ in CASES.values() for name in names}
    assert public - covered == set()
    assert covered - public == set()


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("name", CASES)
def test_it_is_the_same_in_any_frame(name, frame):
    _, function, amplified = CASES[name]
    wanted, got = function(OWN), function(FRAMES[frame])
    assert len(wanted) == len(got)
    tolerance = 200 * amplified * FRAMES[frame].transform.rounding
    for w, g in zip(wanted, got, strict=True):
        w, g = (np.asarray(a, float).reshape(len(a) if np.ndim(a) else 1, -1) for a in (w, g))
        assert w.shape == g.shape and np.isfinite(w).all()
        size = np.maximum(np.abs(w).max(axis=1), 1e-3 * np.abs(w).max())
        assert (np.abs(g - w).max(axis=1) <= tolerance * size + 1e-300).all()


# --- control spaces ----------------------------------------------------------------------------


def seen(frame, field):
    """A field at points inside, brought back."""
    return frame.old_tensors(field(frame.transform(INSIDE)))


def function_of(frame, values):
    """A function of points of the frame that returns what `values` is of those of the figure."""
    return lambda x: frame.metric(values(frame.old_points(x)))


def thin(x):
    return from_axes(0.01 + 0.2 * np.abs(x[:, 0] - 0.4 * x[:, 1]), 0.3 + 0 * x[:, 0], 1 + x[:, 1])


def wide(x):
    return from_axes(0.1 + 0 * x[:, 0], 0.1 + 0.3 * x[:, 1] ** 2, 2 - x[:, 0])


@case("as_control_space", "Uniform", amplified=2)
def control_spaces(f):
    k = f.scale
    a, b = (metrics.as_control_space(function_of(f, g)) for g in (thin, wide))
    fields = [a, a & b, a | b, a & (0.05 * k), a.mean(b, 0.3), a.geometric_mean(b), a.scaled(2)]
    fields += [a.limited(0.03 * k, 0.2 * k, 4), metrics.Uniform(0.2 * k)]
    return [seen(f, field) for field in fields]


@case("Background", amplified=3)
def background(f):
    field = metrics.Background(f.points, f.triangles, f.at_vertices(f.metric(ANISOTROPIC)))
    found = field.evaluate(f.transform(INSIDE))[1]
    where = np.sort(f.order[f.triangles[found]], axis=1)
    far = f.old_tensors(field(f.transform(POINTS[:20] + 0.3 * (POINTS[:20] - INSIDE.mean(0)))))
    at_vertices = [f.old_tensors(f.old_vertices(b.tensors)) for b in (field, field.graded(1.3))]
    return [seen(f, field), where, far, *at_vertices]


@case("Expression", amplified=2)
def expression(f):
    (a, b), (c, d) = np.linalg.inv(f.matrix).tolist()
    ox, oy = f.transform.offset
    x = f"({a!r}*(x - {ox!r}) + {b!r}*(y - {oy!r}))"
    y = f"({c!r}*(x - {ox!r}) + {d!r}*(y - {oy!r}))"
    size = f"{f.scale!r}*(0.01 + 0.1*hypot({x} - 0.3, {y}) + where({x} < {y}, 0.1, 0.2))"
    return [seen(f, metrics.Expression(size))]


@case("Distance", "Geometry", "Nearest", amplified=10)
def distances(f):
    curve, at, k = f.transform(LOOP), f.transform(INSIDE), f.scale
    near = metrics.Geometry(curve).nearest(at)
    polygon = metrics.Geometry.polygon(curve)
    fields = [metrics.Distance(g, 0.01 * k, 0.2, 0.2 * k) for g in (curve, polygon)]
    fields.append(metrics.Distance(polygon, 0.01 * k, 1.2, law="geometric", inside="boundary"))
    out = [near.distances / k, f.old_points(near.points), f.old_vectors(near.directions)]
    return [*out, *(seen(f, field) for field in fields)]


@case("BoundaryCurvature", amplified=50)
def boundary_curvature(f):
    t = np.linspace(0, 2 * np.pi, 90)
    curve = f.transform(np.stack([0.4 + 0.3 * np.cos(t), 0.4 + 0.2 * np.sin(t)], axis=1))
    k = f.scale
    by_chord = metrics.BoundaryCurvature(curve, chord_error=1e-3 * k)
    by_circle = metrics.BoundaryCurvature(curve, elements_per_circle=30, h_max=0.1 * k, growth=0.1)
    return [seen(f, by_chord), seen(f, by_circle)]


@case("BoundaryLayer", amplified=3)
def boundary_layer(f):
    wall = f.transform(np.concatenate([LOOP, LOOP[:1]]))
    args = 0.003 * f.scale, 1.2, 0.1 * f.scale
    return [seen(f, metrics.BoundaryLayer(wall, *args, h_max=0.2 * f.scale))]


@case("first_height")
def height(f):
    kinds = ("schlichting", "white")
    return [[metrics.first_height(1, 1e6, f.scale, correlation=c) / f.scale for c in kinds]]


@case("Shock", amplified=5)
def shock(f):
    k = f.scale

    def level_set(x):
        x = f.old_points(x)
        return k * (np.hypot(x[:, 0] + 0.3, x[:, 1] + 0.2) - 0.8)

    def gradient(x):
        x = f.old_points(x) - [-0.3, -0.2]
        return f.vectors(x / np.hypot(*x.T)[:, None])

    by_curve = metrics.Shock(f.transform(LOOP), 0.003 * k, 0.1 * k, h_max=0.2 * k)
    by_gradient = metrics.Shock(level_set, 0.003 * k, 0.1 * k, gradient=gradient)
    return [seen(f, by_curve), seen(f, by_gradient)]


@case("RegionSizes")
def region_sizes(f):
    mesh = SimpleNamespace(
        points=f.points,
        triangles=f.triangles,
        regions=f.on_triangles(np.where(CENTRES[:, 0] > 0.4, 2, 1)),
        region_names={"left": 1, "right": 2},
    )
    field = metrics.RegionSizes(mesh, {"left": 0.1 * f.scale, "right": 0.02 * f.scale})
    return [seen(f, field), f.old_tensors(f.old_vertices(field(f.points)))]


# --- from solutions ----------------------------------------------------------------------------


def known(f):
    return f.points, f.triangles, f.at_vertices(U)


@case("gradients", amplified=10)
def recovered_gradients(f):
    methods = ("least squares", "projection")
    return [f.old_gradients(f.old_vertices(metrics.gradients(*known(f), m))) for m in methods]


@case("hessians", amplified=10)
def recovered_hessians(f):
    methods = ("least squares", "projection", "green")
    return [f.old_tensors(f.old_vertices(metrics.hessians(*known(f), m))) for m in methods]


@case("absolute")
def absolute_values(f):
    saddle = f.metric(ANISOTROPIC - 2 * OTHER)
    floor = 0.5 * np.abs(ANISOTROPIC).max() / f.scale**2
    return [f.old_tensors(metrics.absolute(saddle)), f.old_tensors(metrics.absolute(saddle, floor))]


@case("Curvature", amplified=10)
def curvature(f):
    norms, out = (1, 2, 3, np.inf), []
    for values in (U, f.vectors(VELOCITY)):  # a scalar, and a vector along the axes of the frame
        c = metrics.Curvature.of(f.points, f.triangles, f.at_vertices(values))
        out.append(f.old_tensors(f.old_vertices(c.absolute)))
        for p in norms:
            area = f.scale ** (2 / p)
            out.append(f.old_triangles(c.interpolation_errors(p)) / area)
    return out


@case("interpolation_errors", amplified=2)
def errors_on_triangles(f):
    g = f.at_vertices(f.transform.gradient(VELOCITY))
    norms = (1, 2, 3.5, np.inf)
    return [
        f.old_triangles(metrics.interpolation_errors(f.points, f.triangles, g, p))
        / f.scale ** (2 / p)
        for p in norms
    ]


def carried(f, background):
    return f.old_tensors(f.old_vertices(background.tensors))


@case("metric_from_solution", amplified=100)
def from_solution(f):
    k = f.scale
    bounds = {"h_max": 0.3 * k, "h_min": 1e-3 * k}
    one = [
        metrics.metric_from_solution(
            *known(f), target_vertices=500, p=p, recovery=recovery, **bounds
        )
        for recovery in ("least squares", "projection", "green")
        for p in (1, 2, np.inf)
    ]
    # An error in L² of functions that do not scale.
    one.append(metrics.metric_from_solution(*known(f), error=0.01 * k))
    fields = f.points, f.triangles, f.at_vertices(np.stack([U, X * Y], axis=1))
    two = [
        metrics.metric_from_solution(*fields, complexity=300, combine=how, max_anisotropy=9)
        for how in ("intersection", "average")
    ]
    return [carried(f, b) for b in (*one, *two)]


@case("metric_from_hessians", amplified=2)
def from_hessians(f):
    hessians = [f.at_vertices(f.metric(m)) for m in (ANISOTROPIC, OTHER)]
    limits = metrics.Limits(0.01 * f.scale, 0.5 * f.scale, 20, 1.5)
    return [
        carried(
            f,
            metrics.metric_from_hessians(
                f.points, f.triangles, hessians, target_vertices=800, limits=limits
            ),
        )
    ]


@case("metric_from_adjoint", amplified=400)
def from_adjoint(f):
    flux = np.stack([np.cos(3 * Y) + X * Y, np.sin(2 * X + Y)], axis=1)
    # One equation for a vector, whose components are along the axes of the frame, too.
    along_x = np.swapaxes(f.vectors(np.stack([VELOCITY, flux], axis=1)), 1, 2)
    of_vector = np.swapaxes(f.vectors(along_x), 1, 2)
    out = []
    for recovery in ("least squares", "projection", "green"):
        for fluxes, adjoint in (
            (f.vectors(VELOCITY), U),
            (np.stack([f.vectors(VELOCITY), f.vectors(flux)], axis=1), np.stack([U, X], axis=1)),
            (of_vector[:, None], f.vectors(VELOCITY)[:, None]),
        ):
            options = {"complexity": 300, "recovery": recovery, "h_max": 0.5 * f.scale}
            got = metrics.metric_from_adjoint(
                f.points, f.triangles, f.at_vertices(fluxes), f.at_vertices(adjoint), **options
            )
            out.append(carried(f, got))
    return out


@case("lp_metric")
def optimal_shape(f):
    out = []
    for p in (1, 2, np.inf):
        unit = f.scale ** (-4 / (2 * p + 2)) if p < np.inf else 1  # of det^(-1 / (2 p + 2))
        out.append(f.old_tensors(metrics.lp_metric(f.metric(ANISOTROPIC), p)) * unit)
    return out


@case("interpolation_error", "combined", "Limits", amplified=5)
def errors_and_limits(f):
    m, h = (f.at_vertices(f.metric(a)) for a in (ANISOTROPIC, OTHER))
    mesh = f.points, f.triangles
    errors = [metrics.interpolation_error(*mesh, m, h, p) / f.scale ** (2 / p) for p in (1, 2, 5)]
    errors.append(metrics.interpolation_error(*mesh, m, h, np.inf))
    limits = metrics.Limits(0.03 * f.scale, 0.2 * f.scale, 5, 1.4, "metric")
    both = [metrics.combined([m, h, 2 * m], how) for how in ("intersection", "average")]
    both += [limits.bounded(m), limits.applied(m, *mesh)]
    return [errors, *(f.old_tensors(f.old_vertices(a)) for a in both)]


@case("normalised", amplified=2)
def normalised(f):
    mesh = f.at_vertices(f.metric(ANISOTROPIC)), f.points, f.triangles
    limits = metrics.Limits(0.01 * f.scale, 0.3 * f.scale, 8, 1.5)
    got = [
        metrics.normalised(*mesh, target_vertices=700),
        metrics.normalised(*mesh, complexity=300, limits=limits),
    ]
    return [f.old_tensors(f.old_vertices(a)) for a in got]


@case("zz_indicators", "residual_indicators", "doerfler_marking", amplified=20)
def indicators(f):
    source, diffusion = f.on_triangles(1 + CENTRES[:, 0]), f.on_triangles(1 + CENTRES[:, 1])
    velocity = f.at_vertices(f.vectors(VELOCITY))
    found = [
        metrics.zz_indicators(*known(f)),
        metrics.zz_indicators(*known(f), method="least squares"),
        metrics.zz_indicators(f.points, f.triangles, velocity),
        metrics.residual_indicators(*known(f), source=source / f.scale**2, diffusion=diffusion),
    ]
    marked = metrics.doerfler_marking(found[0], 0.4)
    return [f.old_triangles(a) for a in (*found, marked)]


@case("metric_from_indicators", amplified=2)
def from_indicators(f):
    eta = f.on_triangles(0.1 + CENTRES[:, 0] ** 2)
    mesh = f.points, f.triangles, eta
    got = [
        metrics.metric_from_indicators(*mesh, target_vertices=500),
        metrics.metric_from_indicators(*mesh, error=1.0, h_max=0.2 * f.scale),
        metrics.metric_from_indicators(*mesh, error=4.0, fraction=0.9),
    ]
    return [carried(f, b) for b in got]


# --- meshes ------------------------------------------------------------------------------------


def on_edges(f, function, *args):
    edges, _ = metrics.mesh_edges(f.triangles)
    return f.old_edges(edges, function(f.points, edges, *args))[1]


@case("graded", amplified=5)
def graded(f):
    m = f.at_vertices(f.metric(ANISOTROPIC))
    laws = ("mixed", "metric", "h-correction")
    got = [metrics.graded(m, f.points, f.triangles, 1.3, law) for law in laws]
    return [f.old_tensors(f.old_vertices(a)) for a in got]


@case("implied_metric", "triangle_metrics", amplified=3)
def implied(f):
    return [
        f.old_tensors(f.old_vertices(metrics.implied_metric(f.points, f.triangles))),
        f.old_tensors(f.old_triangles(metrics.triangle_metrics(f.points, f.triangles))),
    ]


@case("mesh_edges")
def edges(f):
    found, sides = metrics.mesh_edges(f.triangles)
    opposite = np.sort(f.order[found[sides]], axis=2)  # of each triangle, of each vertex
    order = np.argsort(f.order[f.triangles], axis=1)[:, :, None]
    return [f.old_edges(found)[0], f.old_triangles(np.take_along_axis(opposite, order, axis=1))]


@case("edge_lengths", "metric_areas", "qualities", amplified=2)
def exact_measures(f):
    field = function_of(f, wide)
    areas = metrics.metric_areas(f.points, f.triangles, field)
    qualities = metrics.qualities(f.points, f.triangles, field)
    out = [f.old_triangles(a) for a in (areas, qualities)]
    return [on_edges(f, metrics.edge_lengths, field), *out]


@case("complexity", "Complexity", amplified=1)
def complexities(f):
    got = metrics.complexity(f.points, f.triangles, function_of(f, wide))
    return [got.value, got.error + got.value]


@case("nodal_lengths", "h_shocks", "efficiency_index", amplified=5)
def nodal_edges(f):
    m = f.at_vertices(f.metric(ANISOTROPIC))
    rules = ("quadrature", "simpson", "logarithmic")
    lengths = [on_edges(f, metrics.nodal_lengths, m, rule) for rule in rules]
    indices = [metrics.efficiency_index(lengths[0], d) for d in ("mean square", "frey-george")]
    return [*lengths, on_edges(f, metrics.h_shocks, m), indices]


@case("nodal_areas", "nodal_complexity", "nodal_qualities", "predicted_vertices", amplified=2)
def nodal_triangles(f):
    args = f.points, f.triangles, f.at_vertices(f.metric(ANISOTROPIC))
    numbers = metrics.nodal_complexity(*args), metrics.predicted_vertices(*args)
    measures = metrics.nodal_areas(*args), metrics.nodal_qualities(*args)
    return [numbers, *map(f.old_triangles, measures)]


# --- tensors -----------------------------------------------------------------------------------


@case(*(f"tensor.{name}" for name in tensor.__all__), amplified=5)
def tensors(f):
    a, b, k = f.metric(ANISOTROPIC), f.metric(OTHER), f.scale
    vectors = k * f.vectors(POINTS - [-0.1, -0.2])

    def squares(basis):  # v v' of each column v, whose sign is free
        columns = f.old_vectors(np.swapaxes(basis, 1, 2))
        return np.einsum("nki,nkj->nkij", columns, columns)

    values, axes = tensor.eigh(a)
    relative, basis = tensor.simultaneous_reduction(a, b)
    lifted = 2 * np.log(k) * np.array([1, 0, 1])  # of a logarithm by the unit of length
    rotation = f.old_tensors  # of what has no unit: divided by the square of the scale
    weights = np.arange(1.0, N + 1)
    return [
        rotation(tensor.pack(a)),
        rotation(tensor.pack(tensor.unpack(a))),
        tensor.sizes(a) / k,
        tensor.det(a) * k**4,
        values * k**2,
        squares(axes),
        rotation(tensor.log(a) + lifted) / k**2,
        rotation(tensor.exp(tensor.log(a))),
        rotation(tensor.power(a, 0.3)) * k**-1.4,
        rotation(tensor.sqrt(a)) / k,
        rotation(tensor.mean(a, weights))[None],
        rotation(tensor.geometric_mean(a, b)),
        rotation(tensor.hypot(a, b - a)),
        rotation(tensor.intersect(a, b)),
        rotation(tensor.union(a, b)),
        relative,
        squares(basis) / k**2,
        tensor.lengths(a, b, vectors),
        rotation(tensor.limit(a, 0.03 * k, 0.2 * k, 4)),
    ]
