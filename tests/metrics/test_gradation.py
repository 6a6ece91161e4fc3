"""Graded metrics: within the bound, never coarser, done when done, in any frame.

The law "metric" knows lengths in the metric only, and so holds under any affine map; the others
know lengths in the plane too, and hold under similarities.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference.meshes import delaunay, from_axes, irregular_square
from reference.transforms import SIMILARITIES, TRANSFORMS
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from metrics import Background, MetricError, graded, h_shocks, mesh_edges, tensor
from metrics.gradation import LAWS

POINTS, TRIANGLES = irregular_square(40)
EDGES, _ = mesh_edges(TRIANGLES)
RADIUS = np.hypot(*(POINTS - 0.5).T)
ANGLE = np.arctan2(*(POINTS - 0.5).T[::-1])

FIELDS = {
    "jump": from_axes(np.where(RADIUS < 0.2, 0.004, 0.2), np.where(RADIUS < 0.2, 0.004, 0.2), 0),
    "ring": from_axes(0.002 + np.abs(RADIUS - 0.3), 0.2, ANGLE),
    "turning": from_axes(0.01, 0.3, 7 * POINTS[:, 0] * POINTS[:, 1]),
}

FRAMES = [(law, t) for law in LAWS for t in (TRANSFORMS if law == "metric" else SIMILARITIES)]
in_every_frame = pytest.mark.parametrize(("law", "transform"), FRAMES, ids=str)


def carried(transform, metric):
    """Points, triangles and metric in another frame."""
    return transform(POINTS), transform.triangles(TRIANGLES), transform.metric(tensor.pack(metric))


def excess(graded_metric, points, edges, beta, law):
    """By how much the bound is exceeded, as a relative size, along the worst edge.

    The laws once more, from their formulas, by numpy's eigenvalues.
    """
    p, q = np.concatenate([edges, edges[:, ::-1]]).T
    e, m = points[q] - points[p], tensor.unpack(graded_metric)
    length = np.sqrt(np.einsum("ki,kij,kj->k", e, m[p], e))
    values, vectors = np.linalg.eigh(m[p])
    growth = np.broadcast_to(1 + length[:, None] * np.log(beta), values.shape)
    if law == "mixed":
        in_space = 1 + np.sqrt(values) * np.hypot(*e.T)[:, None] * np.log(beta)
        growth = in_space ** (1 / 8) * growth ** (7 / 8)
    bound = vectors * (values / growth**2)[:, None, :] @ vectors.transpose(0, 2, 1)
    return np.sqrt(np.linalg.eigvals(np.linalg.solve(m[q], bound)).real.max()) - 1


@in_every_frame
@pytest.mark.parametrize("field", FIELDS)
def test_no_edge_exceeds_the_bound(field, law, transform):
    points, triangles, metric = carried(transform, FIELDS[field])
    got = graded(metric, points, triangles, 1.5, law)
    if law == "h-correction":
        assert h_shocks(points, EDGES, metric).max() > 1.5
        assert h_shocks(points, EDGES, got).max() < 1.5 * (1 + 1e-5)
    else:
        assert excess(metric, points, EDGES, 1.5, law) > 0.1
        assert excess(got, points, EDGES, 1.5, law) < 2e-6


@pytest.mark.parametrize("beta", [1.05, 4.0])
@pytest.mark.parametrize("field", FIELDS)
def test_h_correction_bounds_the_h_shock(field, beta):
    assert h_shocks(POINTS, EDGES, FIELDS[field]).max() > beta
    got = graded(FIELDS[field], POINTS, TRIANGLES, beta, "h-correction")
    assert h_shocks(POINTS, EDGES, got).max() < beta * (1 + 1e-5)


@pytest.mark.parametrize("transform", SIMILARITIES[1:], ids=str)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("field", FIELDS)
def test_it_is_the_same_metric_in_every_frame(field, law, transform):
    """Seen from the frame that it came from.

    Of ellipses of one area that with the shortest edges acts first, which shearing may change.
    """
    wanted = graded(FIELDS[field], POINTS, TRIANGLES, 1.3, law)
    points, triangles, metric = carried(transform, FIELDS[field])
    ratios = tensor.simultaneous_reduction(
        transform.metric(wanted), graded(metric, points, triangles, 1.3, law)
    )[0]
    np.testing.assert_allclose(ratios, 1, rtol=1e-5)


@in_every_frame
@pytest.mark.parametrize("field", FIELDS)
def test_never_coarser_as_quadratic_forms(field, law, transform):
    points, triangles, given_ = carried(transform, FIELDS[field])
    got = graded(given_, points, triangles, 1.3, law)
    lowest = tensor.simultaneous_reduction(given_, got)[0][:, 0]
    assert lowest.min() > 1 - 1e-10
    assert (lowest[(got == given_).all(axis=1)] == 1).all()
    assert (got != given_).any(axis=1).sum() > 100


@in_every_frame
@pytest.mark.parametrize("field", FIELDS)
def test_done_again_it_changes_nothing(field, law, transform):
    points, triangles, metric = carried(transform, FIELDS[field])
    once = graded(metric, points, triangles, 1.3, law)
    np.testing.assert_array_equal(graded(once, points, triangles, 1.3, law), once)


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
@pytest.mark.parametrize("law", ["metric", "mixed"])
def test_sizes_without_direction_are_those_of_the_shortest_path(law, transform):
    """h_q = h_p + |pq| ln(beta) along an edge, so from p to q the shortest path of edges."""
    h = np.where(RADIUS < 0.1, 0.004, 1e3)
    h[:5] = 0.05
    lengths = np.hypot(*(POINTS[EDGES[:, 1]] - POINTS[EDGES[:, 0]]).T)
    graph = coo_array((lengths, EDGES.T), shape=(len(h), len(h))).tocsr()
    paths = dijkstra(graph, directed=False, indices=np.flatnonzero(h < 1))
    wanted = np.minimum(h, (h[h < 1][:, None] + np.log(1.4) * paths).min(axis=0))
    points, triangles, _ = carried(transform, h)
    got = graded(h * transform.scale, points, triangles, 1.4, law, tolerance=1e-9)
    got = tensor.sizes(got) / transform.scale
    np.testing.assert_allclose(got, np.stack([wanted, wanted], axis=1), rtol=1e-7)


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_h_correction_along_a_chain_gives_a_geometric_progression(transform):
    """Unit edges, laid as the sizes are: each is longer than the one before by the factor beta."""
    steps = 0.01 * 1.3 ** np.arange(20)
    x = np.r_[0, np.cumsum(steps)]
    points = np.r_[np.c_[x, 0 * x], [[x.mean(), 1e6]]]
    k = np.arange(20)
    triangles = np.stack([k, k + 1, 0 * k + 21], axis=1)
    points, triangles = transform(points), transform.triangles(triangles)
    h = transform.scale * np.r_[0.01, np.full(21, 1e9)]
    got = graded(h, points, triangles, 1.3, "h-correction")
    shocks = h_shocks(points, np.stack([k, k + 1], 1), got)
    np.testing.assert_allclose(shocks, 1.3, rtol=1e-5)
    assert (np.diff(tensor.sizes(got)[:21, 0]) > 0).all()


def test_a_metric_that_is_within_is_returned_as_it_is():
    h = 0.1 + 0.3 * POINTS[:, 0]
    for law in LAWS:
        got = graded(h, POINTS, TRIANGLES, 1.5, law)
        np.testing.assert_array_equal(got, tensor.pack(h))


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_thin_ellipses_stay_thin_in_the_metric_and_get_rounder_mixed(transform):
    """One thin ellipse and one edge along it; the other two vertices have nothing to say."""
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1e9]])
    metric = from_axes([1.0, 1e12, 1e12], [1e-3, 1e12, 1e12], 0.0)
    args = transform.metric(metric), transform(points), transform.triangles([[0, 1, 2]])
    growth = np.log(1.5)
    along, across = tensor.sizes(graded(*args, 1.5, "metric"))[1, ::-1] / transform.scale
    assert along == pytest.approx(1 + growth)
    assert across == pytest.approx(1e-3 * (1 + growth))
    along, across = tensor.sizes(graded(*args, 1.5, "mixed"))[1, ::-1] / transform.scale
    assert along == pytest.approx(1 + growth)
    assert across == pytest.approx(1e-3 * (1 + growth) ** (7 / 8) * (1 + 1e3 * growth) ** (1 / 8))


@pytest.mark.parametrize("law", LAWS)
def test_smaller_beta_and_smaller_sizes_give_finer_metrics(law):
    h = np.where(RADIUS < 0.2, 0.004, 0.2)
    det = [tensor.det(graded(h, POINTS, TRIANGLES, beta, law)).mean() for beta in (1.1, 1.5, 3)]
    assert det[0] > det[1] > det[2]
    if law != "h-correction":  # which lets sizes grow as beta^l, l the larger the smaller they are
        finer = graded(h * 0.9, POINTS, TRIANGLES, 1.5, law)
        assert (tensor.det(finer) >= tensor.det(graded(h, POINTS, TRIANGLES, 1.5, law))).all()


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(FRAMES), st.floats(1.01, 10))
def test_any_metric_on_any_mesh(seed, frame, beta):
    law, transform = frame
    rng = np.random.default_rng(seed)
    points = rng.random((30, 2))
    triangles = delaunay(points)
    metric = from_axes(
        10 ** rng.uniform(-4, 0, 30), 10 ** rng.uniform(-4, 0, 30), rng.uniform(0, 3)
    )
    points, triangles = transform(points), transform.triangles(triangles)
    metric = transform.metric(metric)
    got = graded(metric, points, triangles, beta, law)
    assert tensor.simultaneous_reduction(metric, got)[0].min() > 1 - 1e-10
    again = graded(got, points, triangles, beta, law)
    thin = np.divide(*tensor.sizes(got).T[::-1]) > 1e5  # their length is known to a few digits
    np.testing.assert_array_equal(again[~thin], got[~thin])
    np.testing.assert_allclose(again[thin], got[thin], rtol=1e-11)
    edges, _ = mesh_edges(triangles)
    if law == "h-correction":
        assert np.log(h_shocks(points, edges, got)).max() < np.log(beta) * (1 + 1e-4) + 1e-5
    else:
        assert excess(got, points, edges, beta, law) < 1e-5
    clockwise = graded(metric, points, triangles[:, ::-1], beta, law)
    np.testing.assert_array_equal(clockwise, got)


@pytest.mark.parametrize("law", LAWS)
def test_lengths_have_no_unit(law):
    """Four times the plane and the sizes: the same bits, scaled."""
    metric = FIELDS["turning"]
    wanted = graded(metric, POINTS, TRIANGLES, 1.5, law)
    got = graded(metric / 16, 4 * POINTS, TRIANGLES, 1.5, law)
    np.testing.assert_array_equal(got * 16, wanted)


def test_points_without_triangles_are_let_be():
    got = graded([0.1, 9.0, 9.0, 5.0], [[0, 0], [1, 0], [0, 1], [0, 0.1]], [[0, 1, 2]], 1.5)
    assert tensor.sizes(got)[3, 0] == pytest.approx(5)
    assert tensor.sizes(got)[1, 0] < 1


def test_a_graded_background_is_another_background():
    field = Background(POINTS, TRIANGLES, FIELDS["jump"], outside="error")
    got = field.graded(1.3, "metric")
    wanted = graded(field.tensors, POINTS, TRIANGLES, 1.3, "metric")
    np.testing.assert_allclose(got.tensors, wanted, rtol=1e-10)
    np.testing.assert_allclose(field.tensors, FIELDS["jump"], rtol=1e-10)
    assert got.outside == "error"


def test_what_makes_no_sense_is_refused():
    args = ([0.1] * 3, [[0, 0], [1, 0], [0, 1]], [[0, 1, 2]])
    for beta in (1.0, 0.5, np.nan, np.inf):
        with pytest.raises(MetricError, match="beta must be above 1"):
            graded(*args, beta=beta)
    with pytest.raises(MetricError, match="law must be one of 'h-correction', 'metric', 'mixed'"):
        graded(*args, law="shock")
    with pytest.raises(MetricError, match="tolerance"):
        graded(*args, tolerance=0)
    with pytest.raises(MetricError, match=r"point 1 \(1.0, 0.0\) is not positive"):
        graded([0.1, -1, 1], *args[1:])
    with pytest.raises(MetricError, match="out of range"):
        graded(*args[:2], [[0, 1, 3]])
