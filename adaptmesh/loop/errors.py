"""What stops a loop: an error of the user's functions or of a stage, or Ctrl-C."""

from __future__ import annotations

from typing import Any

from adaptmesh.errors import AdaptmeshError

from .history import History
from .transient_history import TransientHistory


class _Stopped(BaseException):
    """Base of errors that hold more than their message: all of it is kept when they are pickled.

    Without, the error of a loop in another process could not come back from there.
    """

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (type(self), self.args), vars(self)


def _unpickled(kind: type[BaseException], args: tuple[Any, ...]) -> BaseException:
    """An error of this kind, made without its constructor; its attributes are set afterwards."""
    return kind.__new__(kind, *args)


class LoopError(_Stopped, AdaptmeshError):
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

    def __init__(self, history: History, iteration: int, stage: str, error: Exception) -> None:
        self.history, self.iteration, self.stage = history, iteration, stage
        super().__init__(f"iteration {iteration}, {stage}: {type(error).__name__}: {error}")


class LoopInterrupted(_Stopped, KeyboardInterrupt):
    """Ctrl-C in a loop; `history`, `iteration` and `stage` are as those of `LoopError`."""

    def __init__(self, history: History, iteration: int, stage: str) -> None:
        self.history, self.iteration, self.stage = history, iteration, stage
        super().__init__(f"iteration {iteration}, {stage}: interrupted")


class TransientError(_Stopped, AdaptmeshError):
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

    def __init__(
        self, history: TransientHistory, sweep: int, interval: int, stage: str, error: Exception
    ) -> None:
        self.history, self.sweep, self.interval, self.stage = history, sweep, interval, stage
        super().__init__(
            f"sweep {sweep}, interval {interval}, {stage}: {type(error).__name__}: {error}"
        )


class TransientInterrupted(_Stopped, KeyboardInterrupt):
    """Ctrl-C in a loop in time; its attributes are those of `TransientError`."""

    def __init__(self, history: TransientHistory, sweep: int, interval: int, stage: str) -> None:
        self.history, self.sweep, self.interval, self.stage = history, sweep, interval, stage
        super().__init__(f"sweep {sweep}, interval {interval}, {stage}: interrupted")
