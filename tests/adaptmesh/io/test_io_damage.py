"""Damaged files of every format: something valid, or an error that names the file.

`damaged_files.py` does the same with as many seeds as wanted.
"""

import random

import pytest
from reference.damage import TookTooLong, Whole, contents, little_memory, read_every_way
from reference.whole_files import WHOLE

import adaptmesh as am
from adaptmesh import io
from adaptmesh.io.domains.geo import by_gmsh
from adaptmesh.io.formats import OUTLINES

SEEDS = 60


def test_no_format_is_forgotten():
    assert set(WHOLE) == {
        *(s for s, f in io.FORMATS.items() if f.reader not in ("by_meshio", "xdmf")),
        ".xdmf",  # and .xmf
        *OUTLINES,
        ".sol",
        ".solb",
        ".mtr",
        "history",
        "history in time",
    }


@pytest.fixture(scope="module")
def others():
    return contents()


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize(
    ("suffix", "way"), [(suffix, way) for suffix, ways in WHOLE.items() for way in ways]
)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_damaged(suffix, way, tmp_path, others, capfd, monkeypatch):
    monkeypatch.setattr(by_gmsh, "is_installed", lambda: False)  # it takes a process for each
    whole = Whole(suffix, way, tmp_path)
    capfd.readouterr()
    with little_memory():
        for seed in range(SEEDS):
            whole.damage(seed, others)
            try:
                read_every_way(whole.path)
            except (Exception, TookTooLong) as error:
                raise AssertionError(f"seed {seed}: {error!r}") from error
    assert capfd.readouterr() == ("", "")


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("suffix", [".mesh", ".meshb", ".vtu", ".ele", ".sol", ".solb"])
def test_cut_anywhere_is_refused(suffix, tmp_path):
    (way, *_) = WHOLE[suffix]
    whole = Whole(suffix, way, tmp_path)
    data = whole.files[whole.path]
    # the last bytes may be blanks or the unused place after End
    for size in range(0, len(data) - 8, max(1, len(data) // 150)):
        whole.path.write_bytes(data[:size])
        assert read_every_way(whole.path) == "refused", size


def everything(path):
    """What a mesh file says of the mesh."""
    mesh = io.read(path)
    counts = len(mesh.points), len(mesh.triangles), len(mesh.edges)
    tags = mesh.edge_tags.tolist(), mesh.regions.tolist()
    return counts, tags, dict(mesh.names), dict(mesh.region_names)


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize(
    ("suffix", "way"),
    [
        (".vtu", "ours"),
        (".vtk", "our text"),
        (".msh", "4.1 text"),
        (".msh", "2.2 text"),
        (".mesh", "ours"),
        (".xdmf", "ours"),
        (".ele", "ours"),
    ],
)
def test_nothing_is_lost_with_lines(suffix, way, tmp_path):
    """Cut out any line, any section, or the rest: what is read is the same mesh, or nothing."""
    whole = Whole(suffix, way, tmp_path)
    expected = everything(whole.path)
    chance = random.Random(5)
    for victim, data in whole.files.items():
        if victim.suffix in (".h5", ".sol"):
            continue
        lines = data.splitlines(keepends=True)
        n = len(lines)
        cuts = [(i, i + 1) for i in range(1, n)] + [(i, n) for i in range(1, n)]
        cuts += [sorted(chance.sample(range(5, n + 1), 2)) for _ in range(150)]
        for i, j in cuts:
            victim.write_bytes(b"".join(lines[:i] + lines[j:]))
            try:
                assert everything(whole.path) == expected, (victim.name, i, j, lines[i])
            except am.FormatError as error:
                assert "a." in str(error)
        victim.write_bytes(data)


def test_a_poly_that_is_missing_beside_ours(tmp_path):
    whole = Whole(".ele", "ours", tmp_path)
    whole.path.with_suffix(".poly").unlink()
    with pytest.raises(am.FormatError, match="has 0 edges, not 6"):
        io.read(whole.path)


@pytest.mark.parametrize("end", [".ele", ".node", ".poly"])
def test_more_lines_than_the_counts_say(end, tmp_path):
    whole = Whole(".ele", "ours", tmp_path)
    path = whole.path.with_suffix(end)
    path.write_text(path.read_text().replace("# end", "17 1 1 1 1 1 1 1 1\n# end"))
    read = am.read_domain if end == ".poly" else io.read
    with pytest.raises(am.FormatError, match=f"a{end}, line .*more lines|a{end}"):
        read(path if end == ".poly" else whole.path)
