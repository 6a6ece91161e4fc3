"""What a loop is resumed from: an earlier history, asked for the same, and its folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from adaptmesh.mesh.mesh import Mesh

from .base_history import BaseHistory, PathLike

H = TypeVar("H", bound=BaseHistory)


def load_earlier(resume: H | PathLike | None, kind: type[H], mesh: Mesh) -> H:
    """The history to go on with, which began with this mesh; an empty one if none is given."""
    if resume is None:
        return kind()
    if isinstance(resume, kind):
        earlier = resume
    elif isinstance(resume, BaseHistory):
        raise TypeError(f"resume: expected a {kind.__name__}, got a {type(resume).__name__}")
    else:
        earlier = kind.load(resume, mesh.domain)
    if earlier.first_mesh is not None:
        _check_same_mesh(earlier.first_mesh, mesh)
    return earlier


def prepare_folder(save: PathLike | None, history: H, resume: H | PathLike | None) -> Path | None:
    """The folder to save to, with all that the history has; another history there is refused."""
    if save is None:
        return None
    folder = Path(save).absolute()
    if not is_saved_in(folder, resume):
        history.refuse_to_replace(folder)
        history.save(folder)
    return folder


def is_saved_in(folder: Path, resume: BaseHistory | PathLike | None) -> bool:
    """Whether the history to go on with is the one in that folder."""
    if resume is None or isinstance(resume, BaseHistory):
        return False
    return Path(resume).resolve() == folder.resolve()


def _check_same_mesh(first: Mesh, mesh: Mesh) -> None:
    """Raise if a history began with another mesh, or with one of another domain."""
    same = np.array_equal(first.points, mesh.points)
    if not (same and np.array_equal(first.triangles, mesh.triangles)):
        raise ValueError(
            f"the history to resume began with another mesh ({len(first.points)} vertices) "
            f"than is given ({len(mesh.points)} vertices)"
        )
    one, two = first.domain, mesh.domain
    if one is None or two is None or one is two:
        return
    arrays = ("points", "segments", "segment_tags", "holes", "seeds", "seed_regions")
    if not all(np.array_equal(getattr(one, name), getattr(two, name)) for name in arrays) or (
        [(p.first, p.second) for p in one.periodic] != [(p.first, p.second) for p in two.periodic]
    ):
        raise ValueError(
            "the history to resume is of another domain than the mesh that is given: give its "
            "first mesh, or begin without `resume`, on its last mesh"
        )


def options_as_text(*options: object) -> dict[str, str]:
    """The attributes of dataclasses that are not None, each as text: what a history was asked for.

    The same text for the same request, however it was written.
    """
    return {
        name: _option_as_text(value)
        for part in options
        for name, value in vars(part).items()
        if value is not None
    }


def _option_as_text(option: Any) -> str:
    """An option in one form: 300 is 300.0, a list is a tuple, and mappings have no order."""
    if isinstance(option, (int, float, np.number)):
        return f"{float(option):.17g}"
    if isinstance(option, Mapping):
        return _join({name: option[name] for name in sorted(option)})
    if is_dataclass(option):
        return _join({field.name: getattr(option, field.name) for field in fields(option)})
    if isinstance(option, Sequence) and not isinstance(option, str):
        return ", ".join(map(_option_as_text, option))
    return str(option)


def _join(options: Mapping[str, Any]) -> str:
    return ", ".join(f"{name}={_option_as_text(value)}" for name, value in options.items())
