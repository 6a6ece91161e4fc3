"""One iteration or interval while it is made: its stages, their times, and what stops it."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Generic, Literal, TypeVar

from .base_history import BaseHistory
from .errors import LoopStopped
from .records import Seconds

H = TypeVar("H", bound=BaseHistory)


class Step(Generic[H]):
    """A context in which exceptions become errors of the loop, with the history until then.

    Parameters
    ----------
    history : BaseHistory
        What was completed before; replace it when the step is complete.
    error, interrupted : type
        What is raised in the place of an `Exception`, and of a `KeyboardInterrupt`.
    stage : str
        The one that it begins with.
    **position : int
        Which iteration or interval it is, as the errors have it.

    Attributes
    ----------
    history : BaseHistory
    stage : str
        The one at work.
    seconds : Seconds
        How long each has taken.
    """

    def __init__(
        self,
        history: H,
        error: type[LoopStopped],
        interrupted: type[LoopStopped],
        stage: str,
        **position: int,
    ) -> None:
        self.history, self.stage, self.seconds = history, stage, Seconds()
        self._error, self._interrupted, self._position = error, interrupted, position

    @contextmanager
    def timed(self, stage: str, name: str = "") -> Iterator[None]:
        """Count the time to a stage, which errors call by another name if that is given."""
        self.stage = name or stage
        start = time.perf_counter()
        yield
        self.seconds += Seconds(**{stage: time.perf_counter() - start})

    def __enter__(self) -> Step[H]:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> Literal[False]:
        if isinstance(error, KeyboardInterrupt):
            raise self._interrupted(self.history, self.stage, None, **self._position) from error
        if isinstance(error, Exception):
            raise self._error(self.history, self.stage, error, **self._position) from error
        return False
