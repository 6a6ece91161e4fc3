"""What stops a loop: an error of the user's functions or of a stage, or Ctrl-C."""

from __future__ import annotations

from typing import Any

from adaptmesh.errors import AdaptmeshError

from .history import History
from .transient_history import TransientHistory


class LoopStopped(BaseException):
    """Base of what stops a loop: it holds the history until then, and where the loop was.

    All attributes are kept when it is pickled: without, the error of a loop in another process
    could not come back from there.
    """

    history: Any
    stage: str

    def __init__(self, history: Any, stage: str, cause: Exception | None, **position: int) -> None:
        self.history, self.stage = history, stage
        vars(self).update(position)
        where = ", ".join(f"{name} {number}" for name, number in position.items())
        what = "interrupted" if cause is None else f"{type(cause).__name__}: {cause}"
        super().__init__(f"{where}, {stage}: {what}")

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickle, (type(self), self.args), vars(self)


def _unpickle(kind: type[BaseException], args: tuple[Any, ...]) -> BaseException:
    """An error of this kind, made without its constructor; its attributes are set afterwards."""
    return kind.__new__(kind, *args)


class LoopError(LoopStopped, AdaptmeshError):
    """A loop that was stopped by an exception, which is its ``__cause__``.

    Attributes
    ----------
    history : History
        All iterations that were completed before.
    iteration : int
        The one that was not.
    stage : str
        Where in it: ``"adapt"``, ``"transfer"``, ``"solve"``, ``"metric"``, ``"save"``,
        ``"callback"`` or ``"stopping rule"``.
    """

    history: History
    iteration: int


class LoopInterrupted(LoopStopped, KeyboardInterrupt):
    """Ctrl-C in a loop; `history`, `iteration` and `stage` are as those of `LoopError`."""

    history: History
    iteration: int


class TransientError(LoopStopped, AdaptmeshError):
    """A loop in time that was stopped by an exception, which is its ``__cause__``.

    Attributes
    ----------
    history : TransientHistory
        All intervals that were completed before.
    sweep, interval : int
        The one that was not.
    stage : str
        Where in it: ``"metric"``, ``"adapt"``, ``"initial"``, ``"transfer"``, ``"advance"``,
        ``"save"`` or ``"callback"``.
    """

    history: TransientHistory
    sweep: int
    interval: int


class TransientInterrupted(LoopStopped, KeyboardInterrupt):
    """Ctrl-C in a loop in time; its attributes are those of `TransientError`."""

    history: TransientHistory
    sweep: int
    interval: int
