"""Geometries of BAMG: the curves where BAMG itself has them, and what is refused."""

import shutil
import subprocess

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh.errors import DomainError, FormatError
from adaptmesh.io.domains.bamg import _Geometry

T = np.linspace(0, 1, 2001)


def octagon(tag=3):
    angles = np.arange(8) * np.pi / 4
    vertices = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return vertices, [(i + 1, (i + 1) % 8 + 1, tag) for i in range(8)]


def squares(*sides):
    """Concentric squares, each a ring with its own tag."""
    ring = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    vertices = np.concatenate([ring * s / 2 for s in sides])
    edges = [
        (4 * k + i + 1, 4 * k + (i + 1) % 4 + 1, k + 1) for k in range(len(sides)) for i in range(4)
    ]
    return vertices, edges


def text(vertices, edges, more="", angle="AngleOfCornerBound 46\n"):
    rows = "".join(f"{float(x)!r} {float(y)!r} 1\n" for x, y in vertices)
    rows += f"Edges {len(edges)}\n" + "".join(f"{a} {b} {r}\n" for a, b, r in edges)
    return f"MeshVersionFormatted 0\n{angle}Dimension 2\nVertices {len(vertices)}\n{rows}{more}"


CURVED = {
    "smooth": text(*octagon()),
    "bound not reached": text(*octagon(), angle=""),
    "corner": text(*octagon(), "Corners 2\n1 4\n"),
    "tangents": text(*octagon(), "TangentAtEdges 3\n1 1 0 5\n1 2 3 0\n4 2 -1 -2\n"),
    "tangent at a corner": text(*octagon(), "Corners 1\n1\nTangentAtEdges 1\n1 1 0 5\n"),
    "required": text(*octagon(), "RequiredVertices 1\n6\nRequiredEdges 2\n2 3\n"),
    "two tags": text(octagon()[0], [(a, b, 1 + (a > 4)) for a, b, _ in octagon()[1]]),
}


@pytest.fixture
def g(tmp_path):
    def write(content):
        path = tmp_path / "a.g"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("case", CURVED)
def test_bamg_puts_its_vertices_on_our_curves(g, case):
    bamg = shutil.which("ffbamg")
    if bamg is None:
        pytest.skip("ffbamg, of FreeFEM, is not there")
    path = g(CURVED[case])
    out = path.with_name("out.mesh")
    command = [bamg, "-g", path, "-o", out, "-hmax", "0.1", "-hmin", "0.1"]
    subprocess.run(command, check=True, capture_output=True)
    theirs = am.read(out)
    curves = _Geometry.of(path.read_text()).curves()
    lines = np.stack([c.point(T) for c in curves])
    p, d = lines[:, :-1].reshape(-1, 2), np.diff(lines, axis=1).reshape(-1, 2)
    on_border = theirs.points[np.unique(theirs.edges)]
    assert len(on_border) > 45
    for x in on_border:
        t = np.clip(((x - p) * d).sum(axis=1) / (d * d).sum(axis=1), 0, 1)
        assert np.hypot(*(x - p - t[:, None] * d).T).min() < 1e-7
    domain = am.read_domain(path)
    assert set(theirs.edge_tags.tolist()) == set(domain.segment_tags.tolist())
    assert domain.area == pytest.approx(theirs.areas.sum(), rel=3e-3)


def test_smooth_edges_have_no_vertices_that_stay(g):
    domain = am.read_domain(g(CURVED["smooth"]))
    mesh = am.generate(domain, 5.0)
    assert len(np.unique(mesh.edges)) < 8
    assert len(am.read_domain(g(CURVED["bound not reached"])).points) == 8


def test_required_vertices_and_edges(g):
    vertices, _ = octagon()
    domain = am.read_domain(g(CURVED["required"]))
    assert domain.segment_is_frozen.sum() == 2
    stay = {tuple(vertices[k]) for k in (1, 2, 3, 5)}
    mesh = am.generate(domain, 0.1)
    for new in (mesh, am.generate(domain, 5.0), am.adapt(mesh, 5.0)):
        assert new.validate().ok
        assert stay <= set(map(tuple, new.points.tolist()))
        edges = {frozenset(map(tuple, e)) for e in new.points[new.edges].tolist()}
        assert {frozenset(map(tuple, vertices[[k, k + 1]])) for k in (1, 2)} <= edges


def test_without_subdomains_all_that_is_enclosed(g):
    domain = am.read_domain(g(text(*squares(4, 2, 1))))
    assert domain.area == pytest.approx(16)
    mesh = am.generate(domain, 0.5)
    assert set(mesh.edge_tags) == {1, 2, 3}


@pytest.mark.parametrize("side", [1, -1])
def test_subdomains_are_regions_and_the_rest_holes(g, side):
    vertices, edges = squares(4, 2, 1)
    if side == -1:
        edges = [(b, a, r) for a, b, r in edges]
    mesh = am.generate(
        am.read_domain(g(text(vertices, edges, f"SubDomain 2\n2 1 {side} 7\n2 9 {side} 9\n"))), 0.5
    )
    areas = {r: mesh.areas[mesh.regions == r].sum() for r in set(mesh.regions.tolist())}
    assert areas == {7: pytest.approx(12), 9: pytest.approx(1)}


def test_subdomains_beside_curved_edges(g):
    vertices, edges = octagon()
    inner = [(a + 8, b + 8, 4) for a, b, _ in edges]
    both = np.concatenate([vertices, 0.97 * vertices])
    more = "SubDomain 2\n2 1 1 5\n2 9 1 6\n"
    domain = am.read_domain(g(text(both, edges + inner, more)))
    outer = am.read_domain(g(text(vertices, edges))).area
    mesh = am.generate(domain, 0.05)
    ring = mesh.areas[mesh.regions == 5].sum()
    assert ring == pytest.approx(outer * (1 - 0.97**2), rel=0.02)
    assert set(mesh.regions) == {5, 6}


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "no BAMG geometry"),
        (b"\xff\xfe\0", "is not a text file"),
        ("MeshVersionFormatted 0\nDimension 2\n", "no Edges"),
        (CURVED["smooth"].replace("Dimension 2", "Dimension 3"), "Dimension: .*dimension 2"),
        (CURVED["smooth"].replace("Vertices 8", "Vertices 9"), "Vertices: .*got b'Edges'"),
        (CURVED["smooth"].replace("Vertices 8", "Vertices 999999999999"), "Vertices: cut short"),
        (CURVED["smooth"].replace("Edges 8", "Edges 7"), "expected a keyword"),
        (CURVED["smooth"].replace("1 2 3\n", "1 9 3\n"), "Edges: row 1 names 9.*vertices 1 to 8"),
        (CURVED["smooth"].replace("1 2 3\n", "1 1 3\n"), r"Edges: row 1: both ends are \(1\.0"),
        (CURVED["smooth"].replace("1.0 0.0 1", "nan 0.0 1"), r"Vertices: row 1 is \(nan, 0\)"),
        (CURVED["smooth"].replace("1.0 0.0 1", "1e300 0.0 1"), r"Vertices: row 1 is \(1e\+300"),
        (CURVED["smooth"] + "Corners 1\n9\n", "Corners: row 1 names 9"),
        (CURVED["smooth"] + "TangentAtEdges 1\n1 3 0 1\n", "TangentAtEdges: row 1 names 3"),
        (CURVED["smooth"] + "TangentAtEdges 1\n1 1 0 inf\n", "TangentAtEdges: row 1 .*not finite"),
        (CURVED["smooth"] + "SubDomain 1\n2 1 -1 1\n", "SubDomain: row 1.*on the outside"),
        (CURVED["smooth"] + "SubDomain 1\n2 1 0 1\n", "SubDomain: row 1 is not"),
        (CURVED["smooth"] + "SubDomain 2\n2 1 1 1\n2 2 1 2\n", "row 2.* the same as another"),
        (CURVED["smooth"] + "CrackedEdges 1\n1 2\n", "CrackedEdges: .*remove"),
    ],
)
def test_what_is_no_geometry(g, content, message):
    with pytest.raises(FormatError, match=rf"a\.g: .*{message}"):
        am.read_domain(g(content))


def test_an_open_border(g):
    vertices, edges = octagon()
    with pytest.raises(DomainError, match=r"a\.g: the boundary is not closed"):
        am.read_domain(g(text(vertices, edges[:-1])))
