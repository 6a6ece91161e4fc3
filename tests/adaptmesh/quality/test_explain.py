"""Reasons for edges that are not unit and for bad triangles, on meshes that have a known one."""

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh import Cause
from adaptmesh.errors import MetricError

SQUARE = am.Domain.rectangle(0, 0, 1, 1)


def jump(x):
    return np.where(np.hypot(x[:, 0] - 0.45, x[:, 1] - 0.55) < 0.2, 0.01, 0.2)


def test_nothing_to_explain():
    mesh = am.generate(SQUARE, 0.1)
    found = am.explain(mesh, 0.1)
    assert (found.edges, found.triangles, found.n_edges, found.n_triangles) == ((), (), 0, 0)
    assert "0 edges are not unit" in str(found)
    assert {edge.reason.cause for edge in am.measure(mesh, 0.1).worst_edges} == {Cause.MET}


def test_segments_shorter_than_unit():
    x = np.linspace(0, 1, 41)[:-1]
    points = [*np.stack([x, 0 * x], axis=1), (1, 0), (1, 1), (0, 1)]
    n = len(points)
    domain = am.Domain(points, [(k, (k + 1) % n) for k in range(n)])
    found = am.explain(am.generate(domain, 0.1), 0.1)
    on_bottom = [e for e in found.edges if e.start[1] == e.end[1] == 0]
    assert len(on_bottom) == 40
    for edge in on_bottom:
        assert edge.length == pytest.approx(0.25)
        assert edge.reason.cause is Cause.CONSTRAINT
        assert "0.25 units long" in edge.reason.detail


def test_a_sharp_angle():
    wedge = am.Domain.polygon([(0, 0), (1, 0), (1, np.tan(np.radians(2)))])
    found = am.explain(am.generate(wedge, 0.01), 0.01)
    tip = min(found.triangles, key=lambda t: sum(x for x, _ in t.corners))
    assert tip.reason.cause is Cause.SHARP_ANGLE
    assert "2° in the metric" in tip.reason.detail


def test_a_strip_thinner_than_a_unit_has_no_room():
    found = am.explain(am.generate(am.Domain.rectangle(0, 0, 10, 0.3), 1.0), 1.0)
    across = [e for e in found.edges if e.start[0] == e.end[0]]
    assert {e.reason.cause for e in across} <= {Cause.CONSTRAINT, Cause.CROWDED}
    assert set(found.edge_causes) <= {Cause.CONSTRAINT, Cause.CROWDED}


def test_a_jump_is_found_where_it_is():
    found = am.explain(am.generate(SQUARE, jump), jump)
    assert found.n_triangles
    assert max(found.triangle_causes, key=found.triangle_causes.get) is Cause.JUMP
    for item in [*found.edges, *found.triangles]:
        if item.reason.cause is Cause.JUMP:
            assert "by a factor of 20" in item.reason.detail
            x, y = map(float, item.reason.detail.split("(")[1].rstrip(")").split(","))
            assert np.hypot(x - 0.45, y - 0.55) == pytest.approx(0.2, abs=1e-4)


def test_a_metric_that_changes_within_edges():
    def waves(x):
        return 0.3 * (1 + 0.8 * np.sin(60 * x[:, 0]))

    found = am.explain(am.generate(SQUARE, 0.3), waves)
    assert found.n_edges
    assert Cause.UNRESOLVED in found.edge_causes


def test_a_mesh_that_could_be_better():
    """A good mesh for another size: nothing stands against a better one."""
    mesh = am.generate(SQUARE, 0.1)
    found = am.explain(mesh, 0.02)
    inner = [e for e in found.edges if 0 < e.start[0] < 1 and 0 < e.start[1] < 1]
    assert {e.reason.cause for e in inner} == {Cause.UNKNOWN}


def test_only_the_worst_are_looked_into():
    mesh = am.generate(SQUARE, 0.1)
    found = am.explain(mesh, 0.02, max_items=3)
    assert len(found.edges) == 3
    assert found.n_edges > 100
    lengths = [e.length for e in found.edges]
    assert lengths == sorted(lengths, reverse=True)
    with pytest.raises(ValueError, match="max_items=-1"):
        am.explain(mesh, 0.1, max_items=-1)
    with pytest.raises(MetricError):
        am.explain(mesh, -1.0)


def test_the_report_and_the_command_line_say_why(tmp_path):
    from typer.testing import CliRunner

    from adaptmesh.cli.commands import app

    mesh = am.generate(am.Domain.rectangle(0, 0, 10, 0.3), 1.0)
    assert "short constraint: the segment from" in str(am.measure(mesh, 1.0))
    am.write(tmp_path / "a.vtu", mesh)
    shown = CliRunner().invoke(app, ["check", str(tmp_path / "a.vtu"), "--size", "1"])
    assert "short constraint: the segment from" in shown.output
