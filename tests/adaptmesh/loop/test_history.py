"""Histories: printed, plotted, saved, and gone on with after an interruption."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh.loop import archive


def solve(mesh, previous):
    """Depends on what was transferred, too, so that resuming must give that again."""
    x = mesh.points
    u = np.tanh(20 * (x[:, 1] - 0.5 - 0.2 * np.sin(2 * np.pi * x[:, 0])))
    return {"u": u if previous is None else 0.9 * u + 0.1 * previous["u"], "area": mesh.areas}


class Interrupted:
    """The same, but Ctrl-C comes in the iteration `at`."""

    def __init__(self, at):
        self.left = at

    def __call__(self, mesh, previous):
        if not self.left:
            raise KeyboardInterrupt
        self.left -= 1
        return solve(mesh, previous)


OPTIONS = {"target_vertices": 400, "tolerance": 0, "max_iterations": 4}


@pytest.fixture(scope="module")
def start(request):
    domain = am.Domain(
        [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (0.5, 1)],
        [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)],
        regions={"left": (0.1, 0.1), "right": (0.9, 0.1)},
        names={"wall": [0, 1], "middle": [6]},
    )
    return am.generate(domain, 0.15)


@pytest.fixture(scope="module")
def whole(start):
    return am.adapt_loop(solve, start, **OPTIONS)


def assert_same(one, two):
    assert len(one) == len(two)
    for a, b in zip(one, two, strict=True):
        assert (a.number, a.n_points, a.n_triangles) == (b.number, b.n_points, b.n_triangles)
        assert dict(a.errors) == dict(b.errors)
        np.testing.assert_equal(a.unit_fraction, b.unit_fraction)
        for name in ("points", "triangles", "regions", "edges", "edge_tags"):
            mine, theirs = getattr(a.mesh, name), getattr(b.mesh, name)
            assert mine.dtype == theirs.dtype
            assert np.array_equal(mine, theirs)
        assert a.mesh.names == b.mesh.names
        assert a.mesh.region_names == b.mesh.region_names
        assert np.array_equal(a.metric, b.metric)
        assert list(a.fields) == list(b.fields)
        for name in a.fields:
            assert np.array_equal(a.fields[name], b.fields[name])


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("at", [0, 1, 3])
def test_interrupted_and_resumed_is_as_never_interrupted(start, whole, at, tmp_path):
    with pytest.raises(am.LoopInterrupted) as caught:
        am.adapt_loop(Interrupted(at), start, save=tmp_path / "run", **OPTIONS)
    assert len(caught.value.history) == at
    from_memory = am.adapt_loop(solve, start, resume=caught.value.history, **OPTIONS)
    assert_same(from_memory, whole)
    run = tmp_path / "run"
    from_disk = am.adapt_loop(solve, start, resume=run, save=run, **OPTIONS)
    assert_same(from_disk, whole)
    assert_same(am.History.load(run), whole)
    assert am.History.load(run).reason == whole.reason


def test_a_resumed_loop_may_be_asked_for_more(start, whole):
    more = am.adapt_loop(solve, start, resume=whole, **{**OPTIONS, "max_iterations": 6})
    assert len(more) == 7
    assert more[:5] == whole[:5]
    assert am.adapt_loop(lambda mesh: pytest.fail("solved"), start, resume=whole, **OPTIONS)


def test_another_mesh_is_refused(start, whole):
    other = am.generate(start.domain, 0.1)
    with pytest.raises(ValueError, match="began with another mesh"):
        am.adapt_loop(solve, other, resume=whole, **OPTIONS)


def test_another_domain_is_refused(start, whole):
    corners = start.domain.points.copy()
    other = am.Domain(
        corners,
        start.domain.segments,
        regions={"left": (0.2, 0.1), "right": (0.9, 0.1)},
        names={"wall": [0, 1], "middle": [6]},
    )
    with pytest.raises(ValueError, match="is of another domain"):
        am.adapt_loop(solve, replace(start, domain=other), resume=whole, **OPTIONS)


def test_saved_and_loaded_is_the_same(whole, start, tmp_path):
    folder = tmp_path / "deep" / "run"
    whole.save(folder)
    again = am.History.load(folder, start.domain)
    assert_same(again, whole)
    assert again.seconds == whole.seconds
    assert again.mesh.domain is start.domain
    assert (again.reason, again.converged) == (whole.reason, whole.converged)
    assert dict(again.options) == dict(whole.options)
    again.save(tmp_path / "copy")
    assert_same(am.History.load(tmp_path / "copy"), whole)
    again.save(folder)
    assert_same(am.History.load(folder), whole)


def test_a_relative_folder_stays_where_it_was(whole, start, tmp_path, monkeypatch):
    """Meshes are read when they are asked for, from another working directory too."""
    monkeypatch.chdir(tmp_path)
    whole.save("run")
    loaded = am.History.load("run")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    assert_same(loaded, whole)

    def wanders(mesh, previous):
        monkeypatch.chdir(tmp_path if len(mesh.points) % 2 else elsewhere)
        return solve(mesh, previous)

    saved = am.adapt_loop(wanders, start, save="own", keep_last=1, **OPTIONS)
    assert_same(saved, whole)
    assert_same(am.History.load(elsewhere / "own"), whole)


def test_a_history_is_not_written_over(start, whole, tmp_path):
    whole.save(tmp_path)
    with pytest.raises(am.FormatError, match="there is a history in this folder"):
        am.adapt_loop(solve, start, save=tmp_path, **OPTIONS)


def test_an_interruption_of_saving_leaves_what_was_whole(start, whole, tmp_path, monkeypatch):
    am.History(whole[:3], options=whole.options).save(tmp_path)
    write = archive.replace_files

    def full(contents):
        if any(path.name == "history.json" for path in contents):
            raise am.FormatError("disk full")
        write(contents)

    monkeypatch.setattr(archive, "replace_files", full)
    with pytest.raises(am.LoopError, match="iteration 3, save: FormatError: disk full") as caught:
        am.adapt_loop(solve, start, resume=tmp_path, save=tmp_path, **OPTIONS)
    assert len(caught.value.history) == 4
    monkeypatch.undo()
    assert_same(am.History.load(tmp_path), whole[:3])
    assert_same(am.adapt_loop(solve, start, resume=tmp_path, **OPTIONS), whole)


def test_folders_of_earlier_versions_are_read(tmp_path):
    """The files of version 1, written here without the package, as they have been since 0.1."""
    mesh = {
        "points": np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
        "triangles": np.array([[0, 1, 2]], np.int32),
        "regions": np.array([1], np.int32),
        "edges": np.array([[0, 1], [1, 2], [2, 0]], np.int32),
        "edge_tags": np.array([3, 0, 0], np.int32),
    }
    names = {"names": {"wall": 3}, "region_names": {"all": 1}}
    fields = np.array([1.0, 2.0, 4.0]), np.array([[1.0, 2.0]])
    seconds = {"adapt": 0.5, "transfer": 0.25, "solve": 2.0, "metric": 0.125}

    notes = {"fields": ["u", "v"], "is_bare": False, "metric_was_given": True, "errors": {"u": 0.5}}
    np.savez(
        tmp_path / "iteration_0000.npz",
        notes=np.array(json.dumps({**names, **notes})),
        field_0=fields[0],
        field_1=fields[1],
        metric=np.tile([4.0, 0.0, 4.0], (3, 1)),
        given=np.tile([1.0, 0.0, 1.0], (3, 1)),
        **mesh,
    )
    numbers = {"number": 0, "n_points": 3, "n_triangles": 1, "errors": {"u": 0.5}}
    numbers |= {"unit_fraction": None, "seconds": seconds}
    content = {"version": 1, "options": {"p": "2"}, "reason": "it was interrupted"}
    content |= {"converged": False, "iterations": [numbers]}
    (tmp_path / "history.json").write_text(json.dumps(content))

    history = am.History.load(tmp_path)
    assert (history.reason, history.converged, history.options_since) == (content["reason"], 0, 0)
    assert dict(history.options) == {"p": "2"}
    assert history.seconds.total == 2.875
    assert np.isnan(history[0].unit_fraction)
    assert history.mesh.names == {"wall": 3}
    assert history.mesh.region_names == {"all": 1}
    for name, values in mesh.items():
        assert np.array_equal(getattr(history.mesh, name), values)
    assert list(history.fields) == ["u", "v"]
    assert np.array_equal(history.fields["u"], fields[0])
    assert np.array_equal(history.fields["v"], fields[1])
    assert np.array_equal(history[0].metric, [[4, 0, 4]] * 3)
    assert np.array_equal(history[0].snapshot.solution.metric, [[1, 0, 1]] * 3)

    notes = {"start": 0.0, "end": 0.5, "is_bare": True, "seconds": seconds}
    notes |= {"first": ["solution"], "last": ["solution"], "hessians": ["solution"]}
    np.savez(
        tmp_path / "sweep_00_interval_0000.npz",
        notes=np.array(json.dumps({**names, **notes})),
        first_0=fields[0],
        last_0=2 * fields[0],
        hessians_0=np.tile([4.0, 0.0, 1.0], (3, 1)),
        times=np.array([0.0, 0.25, 0.5]),
        **mesh,
    )
    content = {"version": 1, "options": {"p": "2"}, "intervals": [1]}
    (tmp_path / "transient.json").write_text(json.dumps(content))
    ((interval,),) = am.TransientHistory.load(tmp_path).sweeps
    assert (interval.start, interval.end, interval.is_bare) == (0, 0.5, True)
    assert interval.times.tolist() == [0, 0.25, 0.5]
    assert np.array_equal(interval.last["solution"], [2, 4, 8])
    assert np.array_equal(interval.hessians["solution"], [[4, 0, 1]] * 3)
    assert interval.mesh == history.mesh


def test_the_history_of_the_other_loop_is_refused(start, whole):
    with pytest.raises(TypeError, match="expected a TransientHistory, got a History"):
        am.transient_loop(print, print, start, [0, 1], target_vertices=400, resume=whole)


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda f: (f / "history.json").unlink(), "no history here"),
        (lambda f: (f / "history.json").write_text("{"), "is damaged"),
        (lambda f: (f / "history.json").write_text("[]"), "is damaged"),
        (lambda f: (f / "history.json").write_text('{"version": 99}'), "version 99"),
        (lambda f: (f / "iteration_0001.npz").unlink(), "iteration 1 is missing"),
    ],
)
def test_damaged_histories_are_named(whole, tmp_path, damage, message):
    whole.save(tmp_path)
    damage(tmp_path)
    with pytest.raises(am.FormatError, match=message):
        am.History.load(tmp_path)


@pytest.mark.parametrize("keep", [0, 10, 4000])
def test_damaged_arrays_are_named(whole, tmp_path, keep):
    whole.save(tmp_path)
    file = tmp_path / "iteration_0002.npz"
    file.write_bytes(file.read_bytes()[:keep])
    history = am.History.load(tmp_path)
    with pytest.raises(am.FormatError, match=r"iteration_0002.npz: is damaged"):
        _ = history[2].mesh


def test_numbers_in_the_list_are_json_for_others_too(whole, tmp_path):
    whole.save(tmp_path)
    content = json.loads(Path(tmp_path / "history.json").read_text())
    assert [it["n_points"] for it in content["iterations"]] == whole.counts.tolist()
    assert content["iterations"][0]["unit_fraction"] is None


def test_the_table_has_a_row_for_each_iteration(whole):
    lines = str(whole).splitlines()
    assert len(lines) == 1 + len(whole) + 2
    for word in ("vertices", "triangles", "u", "unit edges", "solve s"):
        assert word in lines[0]
    for line, iteration in zip(lines[1:], whole, strict=False):
        assert f"{iteration.errors['u']:.4e}" in line
        assert f"{iteration.n_points:,}" in line
    assert lines[-2] == "not converged: the mesh was adapted 4 times"
    assert "% of it outside of solve" in lines[-1]
    assert "4 times" in repr(whole)
    assert "<pre" in whole._repr_html_()


def test_times_add_up(whole):
    total = whole.seconds
    assert total.total == pytest.approx(sum(it.seconds.total for it in whole))
    assert 0 < total.share_of_library < 1
    assert whole[0].seconds.adapt == 0 < whole[1].seconds.adapt


def test_an_empty_history_says_so():
    empty = am.History()
    assert "not ended" in str(empty)
    assert empty.seconds.share_of_library == 0
    with pytest.raises(IndexError, match="no iteration was completed"):
        _ = empty.mesh


def test_the_picture_shows_every_mesh(whole, tmp_path):
    pytest.importorskip("matplotlib")
    figure = whole.plot(tmp_path / "history.png")
    assert (tmp_path / "history.png").stat().st_size > 5000
    measured = figure.axes[0].lines[0]
    np.testing.assert_array_equal(measured.get_xdata(), whole.counts)
    np.testing.assert_array_equal(measured.get_ydata(), whole.errors["u"])
