"""Reports against values computed by hand."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
from reference.transforms import SIMILARITIES
from scipy.spatial import Delaunay

import metrics
from adaptmesh.domain.domain import Domain
from adaptmesh.generate.generate import generate
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.validate.validate import InvalidMeshError
from adaptmesh.quality.report import LENGTH_BINS, Histogram, measure
from adaptmesh.quality.report_text import percent

SQUARE = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
ROOT2 = 2**0.5


def equilateral(h: float) -> Mesh:
    return Mesh([[0, 0], [h, 0], [h / 2, h * 0.75**0.5]], [[0, 1, 2]])


def cloud(n: int) -> Mesh:
    points = np.random.default_rng(3).random((n, 2))
    triangles = Delaunay(points).simplices
    return Mesh(points, triangles)


def test_unit_triangle_is_perfect():
    report = measure(equilateral(0.25), 0.25)
    assert report.unit_fraction == 1
    assert report.efficiency_index == pytest.approx(1)
    assert report.efficiency_index_frey_george == pytest.approx(1)
    assert report.quality_min == pytest.approx(1)
    assert report.count_ratio == pytest.approx(1)
    assert report.ideal_triangles == pytest.approx(1)


def test_unit_square_of_two_triangles():
    # four sides of length 2, one diagonal of 2√2, in the metric of size 1/2
    report = measure(SQUARE, 0.5)
    assert (report.n_points, report.n_triangles, report.n_edges) == (4, 2, 5)
    assert (report.unit_fraction, report.short_fraction, report.long_fraction) == (0, 0, 1)
    assert report.length_min == pytest.approx(2)
    assert report.length_max == pytest.approx(2 * ROOT2)
    assert report.length_mean == pytest.approx((8 + 2 * ROOT2) / 5)
    assert report.length_quantiles[0.5] == pytest.approx(2)
    shortfall = np.array([0.5] * 4 + [1 - 1 / (2 * ROOT2)])
    assert report.efficiency_index == pytest.approx(1 - np.mean(shortfall**2))
    assert report.efficiency_index_frey_george == pytest.approx(np.exp(-shortfall.mean()))
    assert report.complexity == pytest.approx(4)
    assert report.ideal_triangles == pytest.approx(16 / 3**0.5)
    assert report.count_ratio == pytest.approx(2 / (16 / 3**0.5))
    # Q = 4√3 · 2 / (4 + 4 + 8)
    assert report.quality_min == pytest.approx(3**0.5 / 2)
    assert report.quality_mean == pytest.approx(3**0.5 / 2)


def test_linear_size_along_an_edge():
    # h = 1 + x: the edge from 0 to 1 has the length log 2, the one at x = 0 the length 1
    mesh = Mesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]])
    report = measure(mesh, lambda x: 1 + x[:, 0])
    assert report.length_min == pytest.approx(np.log(2), rel=1e-6)
    assert report.length_max == pytest.approx(1.0, rel=1e-2)
    assert report.short_fraction == pytest.approx(1 / 3)
    # ∫ (1 - x) / (1 + x)² dx = 1 - log 2
    assert report.complexity == pytest.approx(1 - np.log(2), rel=1e-4)


def test_anisotropic_metric():
    # x is measured four times as long: a triangle that is equilateral after that has quality 1
    mesh = Mesh([[0, 0], [0.25, 0], [0.125, 0.75**0.5]], [[0, 1, 2]])
    report = measure(mesh, metrics.as_control_space(lambda x: np.tile([16.0, 0, 1], (len(x), 1))))
    assert report.quality_min == pytest.approx(1)
    assert report.unit_fraction == 1


def test_unit_band_includes_its_ends():
    mesh = Mesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]])
    assert measure(mesh, 2**-0.5).unit_fraction < 1
    assert measure(mesh, 1.0).long_fraction == 0  # 1, 1 and √2


@pytest.mark.parametrize("shape", ["sizes", "packed", "matrices"])
def test_values_at_the_points(shape):
    n = len(SQUARE.points)
    values = {
        "sizes": np.full(n, 0.5),
        "packed": np.tile([4.0, 0, 4.0], (n, 1)),
        "matrices": np.tile(4 * np.eye(2), (n, 1, 1)),
    }[shape]
    assert measure(SQUARE, values).length_max == pytest.approx(2 * ROOT2)


def test_histograms_count_everything_once():
    report = measure(cloud(300), 0.05)
    lengths, quality = report.length_histogram, report.quality_histogram
    assert sum(lengths.counts) == report.n_edges
    assert sum(quality.counts) == report.n_triangles
    unit = [c for low, c in zip(lengths.edges, lengths.counts, strict=False) if 0.7 < low < 1.4]
    assert len(unit) == 8
    assert sum(unit) == round(report.unit_fraction * report.n_edges)


def test_histogram_by_hand():
    histogram = Histogram.of(np.array([0.1, 1.0, 1.0, 9.0]), LENGTH_BINS)
    counts = dict(zip(histogram.edges, histogram.counts, strict=False))
    assert (counts[0.0], counts[1.0], histogram.counts[-1]) == (1, 2, 1)


def test_worst_are_named_with_their_places():
    mesh = cloud(300)
    report = measure(mesh, 0.05)
    worst = report.worst_edges[0]
    assert worst.length in (report.length_min, report.length_max)
    a, b = worst.vertices
    assert worst.start == tuple(mesh.points[a])
    assert worst.end == tuple(mesh.points[b])
    ratios = [min(e.length, 1 / e.length) for e in report.worst_edges]
    assert ratios == sorted(ratios)
    triangle = report.worst_triangles[0]
    assert triangle.quality == report.quality_min
    assert triangle.corners[0] == tuple(mesh.points[mesh.triangles[triangle.triangle, 0]])


def test_clockwise_triangle_has_negative_quality():
    mesh = Mesh(SQUARE.points, [[0, 1, 2], [0, 2, 3], [2, 1, 0], [0, 1, 2]])
    assert measure(mesh, 1.0).quality_min == pytest.approx(-(3**0.5) / 2)


@pytest.mark.parametrize("triangles", [[], [[0, 1, 7]], [[0, 2, 1]], [[0, 0, 0]]])
def test_what_cannot_be_measured_is_refused(triangles):
    with pytest.raises(InvalidMeshError):
        measure(Mesh(SQUARE.points, np.reshape(triangles, (-1, 3))), 1.0)


def test_what_is_no_metric_is_refused():
    with pytest.raises(metrics.MetricError):
        measure(SQUARE, -1.0)
    with pytest.raises(metrics.MetricError):
        measure(SQUARE, np.ones(3))


def test_as_dict_is_json():
    report = measure(cloud(50), lambda x: 0.05 + 0.1 * x[:, 0])
    back = json.loads(json.dumps(report.as_dict(), allow_nan=False))
    assert back["unit_fraction"] == report.unit_fraction
    assert back["length_histogram"]["counts"] == list(report.length_histogram.counts)
    assert back["length_histogram"]["edges"][-1] is None
    assert back["worst_edges"][0]["length"] == report.worst_edges[0].length
    assert "Gauss" in back["length_rule"]


def test_text_reads_well():
    report = measure(cloud(300), 0.05)
    text = str(report)
    assert max(map(len, text.splitlines())) <= 100
    for words in ("unit edges", "efficiency index", "count ratio", "╰ unit ╯", "Gauss", "█"):
        assert words in text
    assert f"{100 * report.unit_fraction:.2f} %" in text
    assert "\x1b" not in text
    assert "<pre" in report._repr_html_()


def test_all_unit_is_said_only_if_all_are():
    assert percent(1.0) == "100.00 %"
    assert percent(0.999999) == "99.9999 %"
    assert percent(1e-6) == "0.0001 %"
    assert percent(0.0) == "0.00 %"
    assert "100.00 %" in str(measure(equilateral(1.0), 1.0))


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_places_in_a_report_tell_the_ends_of_edges_apart(transform):
    """Also in UTM, where five digits are hundreds of metres."""
    corners = transform([(0, 0), (1, 0), (1, 0.01), (0.4, 0.02), (0, 1)])
    unit = float(np.hypot(*(corners[1] - corners[0])))
    mesh = generate(Domain.polygon(corners), 0.1 * unit)
    report = measure(mesh, 0.1 * unit)
    lines = str(report).splitlines()
    for edge in report.worst_edges[:3]:
        name = f"{edge.vertices[0]}–{edge.vertices[1]} "
        (line,) = [line for line in lines if name in line]
        ends = np.array(re.findall(r"\(([^,]+), ([^)]+)\)", line), float)
        length = np.hypot(*np.subtract(edge.start, edge.end))
        assert np.abs(ends - [edge.start, edge.end]).max() < 2e-3 * length
    assert any("short constraint" in line for line in lines)
