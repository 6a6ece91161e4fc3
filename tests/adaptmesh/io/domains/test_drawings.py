"""Drawings: curves where the owners of the formats have them, names, and what is refused."""

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh.errors import AdaptmeshError, DomainError, FormatError
from adaptmesh.io.domains.drawings import read_dxf, read_svg
from adaptmesh.io.domains.drawings.drawing import affine_arc

ezdxf = pytest.importorskip("ezdxf")
svgelements = pytest.importorskip("svgelements")

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100" viewBox="0 0 100 100">'


def svg(tmp_path, body):
    path = tmp_path / "a.svg"
    path.write_text(f"{HEAD}{body}</svg>")
    return path


@pytest.fixture
def dxf(tmp_path):
    """A function that draws into a new model space, and gives the path of the file."""

    def drawn(draw):
        document = ezdxf.new()
        draw(document.modelspace())
        document.saveas(tmp_path / "a.dxf")
        return tmp_path / "a.dxf"

    return drawn


def sampled(drawing, n=200):
    return np.concatenate([c.point(np.linspace(0, 1, n)) for c in drawing.curves])


def farthest(a, b):
    """How far the points a are from the polyline b."""
    p, q = b[:-1], b[1:]
    d = q - p
    t = np.einsum("ijk,jk->ij", a[:, None] - p, d) / np.maximum((d * d).sum(axis=1), 1e-300)
    near = p + np.clip(t, 0, 1)[..., None] * d
    return np.hypot(*np.moveaxis(a[:, None] - near, 2, 0)).min(axis=1).max()


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("turn", [1.0, -2.5])
def test_an_affine_image_of_an_arc(seed, turn):
    matrix = np.random.default_rng(seed).normal(size=(2, 2))
    arc = affine_arc(np.array([3.0, -1.0]), *matrix.T, 0.4, turn)
    t = np.linspace(0, 1, 20)
    s = 0.4 + turn * t
    expected = [3, -1] + np.stack([np.cos(s), np.sin(s)], axis=1) @ matrix.T
    np.testing.assert_allclose(arc.point(t), expected, atol=1e-12)


# -------------------------------------------------------------------------------------------- SVG


def test_svg_shapes_are_curves_with_names(tmp_path):
    path = svg(
        tmp_path,
        '<path id="outer" d="M0,0 L10,0 A5,5 0 0 1 10,10 Q 5 12 0 10 C 1 9 2 5 0 0 Z"/>'
        '<circle id="hole" cx="5" cy="5" r="2"/><text>label</text><rect width="1" height="2"/>',
    )
    drawing = read_svg(path)
    assert drawing.names == {"outer": [0, 1, 2, 3], "hole": [4, 5, 6, 7]}
    assert len(drawing.curves) == 12
    for k in range(4):  # each begins where the one before ends, y turned over
        assert np.allclose(drawing.curves[k].end, drawing.curves[(k + 1) % 4].start, atol=1e-12)
    np.testing.assert_allclose(drawing.curves[1].end, [10, -10], atol=1e-12)
    on_hole = np.concatenate([c.point(np.linspace(0, 1, 9)) for c in drawing.curves[4:8]])
    np.testing.assert_allclose(np.hypot(*(on_hole - [5, -5]).T), 2)


def test_svg_transforms_are_exact(tmp_path):
    """Skewed circles too, where svgelements itself is wrong."""
    body = '<circle cx="5" cy="7" r="2" transform="rotate(10) scale(2,1) skewX(20)"/>'
    curves = read_svg(svg(tmp_path, body)).curves
    a, s = np.radians(10), np.tan(np.radians(20))
    matrix = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]]) @ np.diag([2, 1])
    matrix = matrix @ [[1, s], [0, 1]]
    angles = np.linspace(0, 2 * np.pi, 9)
    circle = np.stack([5 + 2 * np.cos(angles), 7 + 2 * np.sin(angles)], axis=1)
    expected = circle @ matrix.T * [1, -1]
    got = np.concatenate([c.point([0, 0.5]) for c in curves])
    np.testing.assert_allclose(got, expected[:-1], atol=1e-12)


@pytest.mark.parametrize(
    "content", [b"", b"<svg", b"\0\1\2", b"<html></html>", b'<svg><path d="M0 0 L 1"/></svg>']
)
def test_svg_that_is_none(tmp_path, content):
    path = tmp_path / "a.svg"
    path.write_bytes(content)
    try:
        assert not read_svg(path).curves
    except AdaptmeshError as error:
        assert "a.svg" in str(error)
    with pytest.raises(FormatError, match="no such file"):
        read_svg(tmp_path / "b.svg")


def test_svg_without_lines(tmp_path):
    with pytest.raises(DomainError, match="draws no lines"):
        read_svg(svg(tmp_path, "<text>only</text>")).domain()


def test_svg_is_a_domain(tmp_path):
    body = (
        '<path id="outer" d="M0,0 L40,0 A10,10 0 0 1 40,20 L0,20 Z"/>'
        '<ellipse id="hole" cx="20" cy="10" rx="8" ry="4" transform="rotate(30 20 10)"/>'
    )
    domain = am.read_domain(svg(tmp_path, body))
    assert domain.area == pytest.approx(800 + 50 * np.pi - 32 * np.pi, rel=1e-12)
    mesh = am.generate(domain, 2.0)
    x, y = (mesh.points[np.unique(mesh.edges_named("hole"))] - [20, -10]).T
    c, s = np.cos(np.radians(30)), np.sin(np.radians(30))
    np.testing.assert_allclose(((c * x - s * y) / 8) ** 2 + ((s * x + c * y) / 4) ** 2, 1)


# -------------------------------------------------------------------------------------------- DXF


def all_kinds(space):
    space.add_line((0, 0), (1, 2))
    space.add_arc((3.5, 1), 0.2, 350, 10)
    space.add_arc((3.5, 1), 0.5, 10, 350)
    space.add_circle((1, 1), 0.4)
    space.add_ellipse((2.5, 1), (0.5, 0.2), 0.4, 0.3, 4)
    space.add_lwpolyline([(0, 0, 0.3), (4, 0, 0.5), (4, 2, 0), (0, 2, -0.3)], "xyb", close=True)
    space.add_polyline2d([(0, 0, 0.3), (1, 0, 1.5), (3, 2, 0)], "xyb")
    space.add_spline([(3, 0.5), (3.2, 0.6), (3.4, 0.4), (3.5, 0.5)])
    space.add_rational_spline([(0, 0), (1, 1), (2, 0), (3, 1)], [1, 2, 1, 3])


@pytest.mark.parametrize("k", range(9))
def test_dxf_curves_are_where_ezdxf_has_them(dxf, k):
    from ezdxf.path import make_path

    def only_one(space):
        all_kinds(space)
        for i, entity in enumerate(list(space)):
            if i != k:
                space.delete_entity(entity)
        shapes.append(make_path(next(iter(space))))

    shapes = []
    ours = sampled(read_dxf(dxf(only_one)))
    theirs = np.array([(p.x, p.y) for p in shapes[0].flattening(1e-5)])
    # ezdxf makes Bézier curves of arcs, right to 3e-4 of a radius
    assert farthest(ours, theirs) < 1e-3
    assert farthest(theirs, ours) < 1e-3


def test_dxf_circles_are_circles(dxf):
    curves = read_dxf(dxf(lambda space: space.add_circle((1, 2), 0.4))).curves
    radii = np.hypot(*(sampled(read_dxf(dxf(lambda s: s.add_circle((1, 2), 0.4)))) - [1, 2]).T)
    assert len(curves) == 1
    np.testing.assert_allclose(radii, 0.4, rtol=1e-14)


def test_dxf_layers_blocks_and_annotation(dxf):
    def draw(space):
        layers, blocks = space.doc.layers, space.doc.blocks
        layers.add("hidden").off()
        space.add_line((0, 0), (1, 0), dxfattribs={"layer": "wall"})
        space.add_line((0, 0), (1, 0), dxfattribs={"layer": "hidden"})
        space.add_text("not an outline")
        blocks.new("B").add_circle((0, 0), 0.1, dxfattribs={"layer": "bolts"})
        space.add_blockref("B", (5, 5), dxfattribs={"xscale": 2, "yscale": 1})
        space.add_circle((1, 0), 1, dxfattribs={"extrusion": (0, 0, -1), "layer": "below"})

    drawing = read_dxf(dxf(draw))
    assert drawing.names == {"wall": [0], "bolts": [1], "below": [2]}
    x, y = drawing.curves[1].point(np.linspace(0, 1, 50)).T
    np.testing.assert_allclose(((x - 5) / 0.2) ** 2 + ((y - 5) / 0.1) ** 2, 1)
    np.testing.assert_allclose(np.hypot(*(drawing.curves[2].point([0.1, 0.7]) - [-1, 0]).T), 1)


def test_dxf_is_a_domain(dxf):
    """Drawn as people do: lines and arcs in any order, ends rounded to seven digits."""

    def draw(space):
        space.add_line((0, 0), (4, 0), dxfattribs={"layer": "wall"})
        space.add_line((0, 2), (0, 0), dxfattribs={"layer": "inlet"})
        space.add_line((4, 2.0000001), (0, 2), dxfattribs={"layer": "wall"})
        space.add_arc((4, 1), 1, -90, 90, dxfattribs={"layer": "wall"})
        space.add_circle((1, 1), 0.3, dxfattribs={"layer": "hole"})

    domain = am.read_domain(dxf(draw))
    assert domain.area == pytest.approx(8 + np.pi / 2 - 0.09 * np.pi, rel=1e-6)
    mesh = am.generate(domain, 0.2)
    assert mesh.validate().ok
    assert set(mesh.names) == {"wall", "inlet", "hole"}
    far = np.hypot(*(mesh.points[np.unique(mesh.edges_named("hole"))] - 1).T)
    np.testing.assert_allclose(far, 0.3, rtol=1e-12)


@pytest.mark.parametrize(
    ("draw", "says"),
    [
        (
            lambda s: s.add_3dface([(0, 0), (1, 0), (1, 1)]),
            r"3DFACE .* on layer '0': cannot be read",
        ),
        (lambda s: s.add_line((0, 0, 0), (1, 0, 1)), "not lie in a plane"),
        (lambda s: s.add_circle((0, 0), 1, dxfattribs={"extrusion": (1, 0, 0)}), "tilted plane"),
        (lambda s: s.add_circle((0, 0), 0), "positive radii, got 0"),
    ],
)
def test_dxf_that_cannot_be_meshed(dxf, draw, says):
    with pytest.raises(AdaptmeshError, match=says):
        read_dxf(dxf(draw))


def test_dxf_that_is_cut_short(dxf, tmp_path):
    path = dxf(all_kinds)
    whole = path.read_bytes()
    for share in (0.0, 0.3, 0.6, 0.9):
        path.write_bytes(whole[: int(share * len(whole))])
        with pytest.raises(FormatError, match=r"a\.dxf"):
            read_dxf(path)
    with pytest.raises(FormatError, match="no such file"):
        read_dxf(tmp_path / "b.dxf")
