"""Small pictures, looked at by their pixels."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from reference.transforms import SIMILARITIES

import metrics
from adaptmesh.domain.domain import Domain
from adaptmesh.errors import DomainError, FormatError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.view import colours, ellipses
from adaptmesh.view.frame import Frame, bounding_box
from adaptmesh.view.legend import escape
from adaptmesh.view.number_labels import _select_disjoint, label_domain
from adaptmesh.view.plot import plot

SMALL = (420, 300)


def grid(n: int) -> Mesh:
    """The unit square; its left half is steel, its lower side a wall."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    b, c, d = a + 1, a + n + 2, a + n + 1
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    points = np.stack([x.ravel(), y.ravel()], 1)
    edges, sides = metrics.mesh_edges(triangles)
    border = edges[np.bincount(sides.ravel(), minlength=len(edges)) == 1]
    regions = np.where(points[triangles].mean(axis=1)[:, 0] < 0.5, 1, 2)
    return Mesh(
        points,
        triangles,
        regions=regions,
        edges=border,
        edge_tags=(points[border].mean(axis=1)[:, 1] == 0).astype(int),
        names={"wall": 1},
        region_names={"steel": 1},
    )


MESH = grid(6)


@pytest.fixture(scope="session")
def can_draw():
    """Skip where VTK cannot draw; it may even crash, so it is tried in another process."""
    script = (
        "import vtkmodules.vtkRenderingOpenGL2;"
        "from vtkmodules.vtkRenderingCore import vtkRenderWindow as Window;"
        "window = Window(); window.SetOffScreenRendering(True); window.Render()"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, timeout=120)
    if done.returncode:
        pytest.skip("VTK cannot draw on this machine")


@pytest.fixture
def draw(can_draw, tmp_path):
    """Draw a picture and read it back, (height, width, 3)."""
    import pyvista as pv

    def drawn(mesh, *args, **kwargs):
        path = tmp_path / "picture.png"
        assert plot(mesh, *args, path=path, **{"window_size": SMALL, **kwargs}) is None
        image = pv.read(path)
        width, height, _ = image.dimensions
        return image.active_scalars.reshape(height, width, -1)[::-1, :, :3]

    return drawn


def has(image, colour, tolerance=12):
    """How many pixels have a colour."""
    far = np.abs(image.astype(int) - colours.rgb(colour).astype(int)).max(axis=2)
    return int(np.count_nonzero(far <= tolerance))


# --- pictures -------------------------------------------------------------------------------


def test_plain_picture(draw):
    image = draw(MESH)
    assert image.shape == (300, 420, 3)
    assert has(image, colours.PAPER) > 20_000
    assert has(image, colours.FACE) > 5_000
    assert has(image, colours.NAMES[0]) > 50  # the wall
    assert has(image, colours.INK) > 50  # the rest of the boundary


def test_domain_fills_the_view(draw):
    image = draw(MESH, window_size=(300, 300), edges=False)
    inside = np.abs(image.astype(int) - colours.rgb(colours.FACE)).max(axis=2) <= 2
    rows, columns = (np.flatnonzero(inside.sum(axis=axis) > 40) for axis in (1, 0))
    assert abs(np.ptp(rows) - np.ptp(columns)) <= 2  # a square stays one
    x0, y0, x1, _ = Frame.of(bounding_box(MESH.points), (300, 300), False, True).view
    assert np.ptp(columns) == pytest.approx(x1 - x0, abs=8)  # the lines are thick
    assert columns[0] == pytest.approx(x0, abs=4)
    assert rows[-1] == pytest.approx(300 - y0, abs=5)


def test_regions(draw):
    image = draw(MESH, show="region", edges=False)
    steel, other = has(image, colours.REGIONS[0], 2), has(image, colours.REGIONS[1], 2)
    assert steel > 3_000
    assert other == pytest.approx(steel, rel=0.2)


def test_quality(draw):
    flat = Mesh([[0, 0], [1, 0], [1, 0.02], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    image = draw(flat, show="quality")
    bad, good = colours.make_quality_scale("quality", None)(np.array([0.05, 0.85]))
    assert has(image, "#" + bytes(bad).hex(), 25) > 20
    assert has(image, "#" + bytes(good).hex(), 40) > 1_000


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize(("size", "wanted"), [(0.2, "unit"), (1 / 14, "long"), (0.7, "short")])
def test_lengths(draw, size, wanted):
    bare = Mesh(MESH.points, MESH.triangles)
    image = draw(bare, size, show="length", window_size=(800, 600)).astype(int)
    view = image[:, :560]  # the scale beside it has all colours
    red, blue = view[..., 0], view[..., 2]
    drawn = np.count_nonzero(view.min(axis=2) < 200)
    share = {
        "long": np.count_nonzero(red - blue > 60) / drawn,
        "short": np.count_nonzero(blue - red > 60) / drawn,
    }
    assert drawn > 2_000
    assert share.pop(wanted, 1) > 0.4
    assert max(share.values()) < 0.02


def test_sizes_and_values(draw):
    stretched = Mesh(MESH.points**2 + 0.1 * MESH.points, MESH.triangles)
    small, large = colours.SIZES[0], colours.SIZES[-1]
    image = draw(stretched, show="size", edges=False)
    assert min(has(image, small), has(image, large)) > 10
    for values in (MESH.points[:, 0], np.arange(len(MESH.triangles))):
        image = draw(MESH, show=values, edges=False)
        table = colours.load_colour_map(colours.FIELD)
        assert has(image, "#" + bytes(table[3]).hex(), 20) > 100
        assert has(image, "#" + bytes(table[-3]).hex(), 20) > 100


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("hole", ["nan", "masked"])
@pytest.mark.parametrize("at", ["points", "triangles"])
def test_no_value_has_a_colour_of_its_own_and_changes_no_other(draw, hole, at):
    x = MESH.points[:, 0] if at == "points" else MESH.points[MESH.triangles].mean(axis=1)[:, 0]
    missing = (x > 0.3) & (x < 0.7)
    values = np.where(missing, np.nan if hole == "nan" else -1e38, x)
    if hole == "masked":
        values = np.ma.array(values, mask=missing)
    without, image = draw(MESH, show=x, edges=False), draw(MESH, show=values, edges=False)
    grey = colours.NO_VALUE
    assert has(without, grey, 3) == 0 and has(image, grey, 3) > 500
    table = colours.load_colour_map(colours.FIELD)
    for end in ("#" + bytes(table[3]).hex(), "#" + bytes(table[-3]).hex()):
        assert has(image, end, 20) == pytest.approx(has(without, end, 20), rel=0.1)


def test_infinite_values_have_the_colours_of_the_ends():
    scale = colours.make_field_scale(np.array([0.0, 1.0]), None)
    ends = scale(np.array([-np.inf, np.inf, 0.0, 1.0, np.nan]))
    assert (ends[:2] == ends[2:4]).all() and (ends[4] == colours.rgb(colours.NO_VALUE)).all()


def test_ellipses(draw):
    def purple(image):
        red, green, blue = np.moveaxis(image.astype(int), 2, 0)
        return np.count_nonzero((red - green > 15) & (blue - green > 15))

    bare, adorned = draw(MESH, 0.1), draw(MESH, 0.1, ellipses=True)
    assert purple(adorned) > 10 * purple(bare) + 500


def test_zoom_is_cut_at_its_bounds(draw):
    image = draw(MESH, show="region", bounds=(0.0, 0.0, 0.25, 0.25), edges=False)
    assert has(image, colours.REGIONS[0], 2) > 3_000
    assert has(image, colours.REGIONS[1], 2) == 0
    x1 = round(Frame.of((0, 0, 0.25, 0.25), SMALL, False, True).view[2])
    assert has(image[:, x1 + 2 : x1 + 6], colours.REGIONS[0], 2) == 0


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize(
    ("scale", "offset"), [(1e-9, 0), (1e9, 0), (1, 1e6), (1e-3, 1e6), (1e200, 0), (1e-200, 0)]
)
def test_picture_is_the_same_at_every_scale(draw, scale, offset):
    def moved(s, o):
        return Mesh(MESH.points * s + o, MESH.triangles, regions=MESH.regions, edges=MESH.edges)

    wanted = draw(moved(1, 0), show="region").astype(int)
    found = draw(moved(scale, offset), show="region").astype(int)
    assert np.mean(np.abs(wanted - found).max(axis=2) > 40) < 0.005


def test_elongated_domain_is_stretched_and_says_so(draw):
    frame = Frame.of((0, 0, 1, 1e-3), None, False, False)
    assert frame.axis_scale[0] == 1
    assert frame.axis_scale[1] > 50
    image = draw(Mesh(MESH.points * [1, 1e-3], MESH.triangles), edges=False)
    assert has(image, colours.FACE, 2) > 2_000


def test_fine_mesh_is_not_black(draw):
    image = draw(grid(250))
    view = image[80:200, 60:200]
    assert 120 < view.mean() < 240


def test_no_display_is_needed_and_nothing_is_said(can_draw, tmp_path, capfd):
    plot(MESH, path=tmp_path / "a.png", window_size=SMALL)
    captured = capfd.readouterr()
    assert (captured.out, captured.err) == ("", "")


def test_warnings_of_vtk_are_as_before(can_draw, tmp_path):
    from vtkmodules.vtkCommonCore import vtkObject

    before = vtkObject.GetGlobalWarningDisplay()
    plot(MESH, path=tmp_path / "a.png", window_size=SMALL)
    assert vtkObject.GetGlobalWarningDisplay() == before


def test_plotter_is_returned_without_a_path(can_draw):
    plotter = plot(MESH, off_screen=True, window_size=SMALL, title="A square")
    image = plotter.screenshot(return_img=True)
    plotter.close()
    assert image.shape == (300, 420, 3)
    assert has(image, colours.FACE) > 5_000


def test_picture_is_whole_or_absent(can_draw, tmp_path, monkeypatch):
    import pyvista as pv

    path = tmp_path / "a.png"
    path.write_bytes(b"before")

    def fails(self, *args, **kwargs):
        raise RuntimeError("no memory")

    monkeypatch.setattr(pv.Plotter, "screenshot", fails)
    with pytest.raises(RuntimeError, match="no memory"):
        plot(MESH, path=path, window_size=SMALL)
    assert path.read_bytes() == b"before"
    assert [p.name for p in tmp_path.iterdir()] == ["a.png"]


@pytest.mark.parametrize(("suffix", "magic"), [(".jpg", b"\xff\xd8"), (".tif", b"II*")])
def test_other_formats(can_draw, tmp_path, suffix, magic):
    path = tmp_path / f"a{suffix}"
    plot(MESH, path=str(path), window_size=SMALL)
    assert path.read_bytes().startswith(magic)


# --- requests that are refused, before anything is drawn ------------------------------------


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"show": "beauty"}, "expected one of"),
        ({"show": "length"}, "a metric"),
        ({"ellipses": True}, "a metric"),
        ({"show": np.zeros(5)}, "shape"),
        ({"show": np.zeros(len(MESH.points), complex)}, "expected real numbers"),
        ({"show": ["a"] * len(MESH.points)}, "expected real numbers"),
        ({"bounds": (5, 5, 6, 6)}, "no triangle in this box"),
        ({"bounds": (1, 1, 0, 0)}, "x0 < x1"),
        ({"bounds": (0, 0, 1, np.nan)}, "x0 < x1"),
        ({"window_size": (10, 10)}, "window_size"),
        ({"metric": 1.0, "ellipses": -1}, "at least 0"),
    ],
)
def test_request_refused(request_, words):
    with pytest.raises(ValueError, match=words):
        plot(MESH, **request_)


def test_domain_with_numbers(draw):
    """Each number is where its side or point is; regions and names as of a mesh."""
    points, ring = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
    domain = Domain(points, ring, names={"wall": [0]}, regions={"steel": (0.5, 0.5)})
    bare = draw(Mesh(points, [(0, 1, 2), (0, 2, 3)], edges=ring), edges=False)
    numbered = draw(domain)
    assert numbered.shape == draw(domain, show="region").shape
    frame = Frame.of((0, 0, 1, 1), (420, 300), False, True)
    for x, y in [*points, (0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5)]:
        px, py = (np.array([x, y]) * (frame.view[2] - frame.view[0])) + frame.view[:2]
        near = numbered[int(300 - py) - 16 : int(300 - py) + 8, int(px) - 8 : int(px) + 18]
        assert near.size and (near.min(axis=2) < 200).any()
    assert numbered.std() > 0 and bare.std() > 0
    for wrong in ({"metric": 0.1}, {"ellipses": True}, {"show": "quality"}, {"show": [1.0]}):
        with pytest.raises(ValueError, match="a domain is drawn without"):
            plot(domain, **wrong)


def test_words_are_drawn_as_written():
    """VTK takes pairs of $ for formulas and | for columns, and would leave them out."""
    from vtkmodules.vtkRenderingCore import vtkTextRenderer

    renderer = vtkTextRenderer.GetInstance()
    for words in ("rock|sand", "$x$ and $y$", "5 $", "a^2_b", "|a", "a\\|b|$c$"):
        assert renderer.DetectBackend(escape(words)) != vtkTextRenderer.MathText
    assert escape("rock sand, 5 %") == "rock sand, 5 %"


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_numbers_of_points_stand_clear_of_their_lines(transform):
    star = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)]
    domain = Domain(transform(star), [(0, 1), (1, 2), (2, 3), (3, 0), (4, 2)])
    points = [number for number in label_domain(domain) if not number.is_side]
    assert [number.words for number in points] == ["0", "1", "2", "3", "4"]
    for number in points:
        for a, b in domain.segments:
            v = int(number.words)
            if v in (a, b):
                along = domain.points[a + b - v] - domain.points[v]
                cosine = along @ number.direction / np.hypot(*along)
                assert cosine < np.cos(np.radians(100))


def test_numbers_do_not_overlap():
    rng = np.random.default_rng(5)
    low = rng.uniform(0, 300, (2000, 2))
    boxes = np.concatenate([low, low + rng.uniform(5, 40, low.shape)], axis=1)
    chosen = _select_disjoint(boxes, np.arange(len(boxes)))

    def overlap(a, b):
        return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]

    for i in range(len(boxes)):
        others = [j for j in chosen if j < i and overlap(boxes[i], boxes[j])]
        assert (i in chosen) == (not others)


def test_what_is_no_mesh_is_refused():
    for wrong in ([1], None, "a.vtu"):
        with pytest.raises(DomainError, match="expected a Mesh"):
            plot(wrong)


def test_path_refused(tmp_path):
    with pytest.raises(FormatError, match=r"\.png"):
        plot(MESH, path=tmp_path / "a.doc")
    with pytest.raises(FormatError, match="no directory"):
        plot(MESH, path=tmp_path / "none" / "a.png")


def test_nothing_heavy_is_loaded_with_the_package():
    script = (
        "import adaptmesh.view.plot, adaptmesh.quality.report, adaptmesh.convert, sys;"
        "heavy = ('pyvista', 'vtkmodules', 'matplotlib', 'shapely', 'rich');"
        "print([m for m in heavy if m in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines()[-1] == "[]"


# --- parts ----------------------------------------------------------------------------------


def test_outlines_of_ellipses_are_at_distance_one():
    tensors = np.array([[4.0, 1.0, 2.0], [100.0, -9.9, 1.0]])
    shapes = ellipses.Ellipses(np.array([[1.0, 2.0], [3.0, 4.0]]), tensors, 2.0)
    v = (shapes.outlines - shapes.centres[:, None]) / shapes.enlargement
    m11, m12, m22 = tensors.T[:, :, None]
    squares = m11 * v[..., 0] ** 2 + 2 * m12 * v[..., 0] * v[..., 1] + m22 * v[..., 1] ** 2
    np.testing.assert_allclose(squares, 1, rtol=1e-9)


def test_chosen_ellipses_do_not_touch():
    from shapely import Polygon

    random = np.random.default_rng(1)
    places = random.random((400, 2))
    angle, long = random.random(400), 0.02 + 0.1 * random.random(400)
    c, s, a, b = np.cos(angle), np.sin(angle), long**-2, 0.02**-2
    tensors = np.stack([a * c * c + b * s * s, (a - b) * c * s, a * s * s + b * c * c], axis=1)
    frame = Frame.of((0, 0, 1, 1), (800, 800), False, False)
    chosen = ellipses.choose_ellipses(places, tensors, 100, frame)
    shapes = [Polygon(outline) for outline in chosen.outlines]
    assert len(shapes) > 20
    assert not any(p.intersects(q) for i, p in enumerate(shapes) for q in shapes[:i])


def test_unit_lengths_stand_apart_on_the_scale():
    scale = colours.make_length_scale(None)
    below, unit, above = scale(np.array([0.69, 1.0, 1.43])).astype(int)
    assert np.abs(below - unit).max() > 60
    assert np.abs(above - unit).max() > 60
    edge = scale(np.array([0.72, 1.40])).astype(int)
    assert np.abs(edge - unit).max() < 30
