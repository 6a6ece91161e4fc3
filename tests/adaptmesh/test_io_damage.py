"""Damaged files of every format: something valid, or an error that names the file.

`damaged_files.py` does the same with as many seeds as wanted.
"""

import pytest
from reference.damage import TookTooLong, Whole, contents, little_memory, read_every_way
from reference.whole_files import WHOLE

from adaptmesh import io
from adaptmesh.domain_io import OUTLINE_SUFFIXES
from adaptmesh.geo import by_gmsh

SEEDS = 60


def test_no_format_is_forgotten():
    assert set(WHOLE) == {*io.FORMATS, *OUTLINE_SUFFIXES, ".sol", ".solb"}


@pytest.fixture(scope="module")
def others():
    return contents()


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


@pytest.mark.parametrize("suffix", [".mesh", ".meshb", ".vtu", ".ele", ".sol", ".solb"])
def test_cut_anywhere_is_refused(suffix, tmp_path):
    (way, *_) = WHOLE[suffix]
    whole = Whole(suffix, way, tmp_path)
    data = whole.files[whole.path]
    # the last bytes may be blanks or the unused place after End
    for size in range(0, len(data) - 8, max(1, len(data) // 150)):
        whole.path.write_bytes(data[:size])
        assert read_every_way(whole.path) == "refused", size
