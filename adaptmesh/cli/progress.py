"""A progress bar on the terminal, for work that takes more than a second."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from rich.progress import Progress as RichProgress
    from rich.progress import TaskID


class TerminalProgress:
    """A progress bar that `generate(..., progress=...)` can call.

    Nothing is drawn if the stream is not a terminal, and in the first `delay` seconds. Use it as a
    context manager, which removes the bar at the end.

    Parameters
    ----------
    stream : text stream, optional
        Where to draw, by default standard error, so that a redirected output stays clean.
    delay : float
        Seconds before the bar appears.

    Examples
    --------
    >>> import adaptmesh as am
    >>> from adaptmesh.cli.progress import TerminalProgress
    >>> with TerminalProgress() as progress:
    ...     mesh = am.generate(am.Domain.rectangle(0, 0, 2, 1), 0.05, progress=progress)
    """

    def __init__(self, stream: TextIO | None = None, delay: float = 1.0) -> None:
        self._stream = sys.stderr if stream is None else stream
        self._appears_at = time.monotonic() + delay
        self._bar: RichProgress | None = None
        self._task: TaskID | None = None

    def __call__(self, stage: str, fraction: float) -> None:
        """Show that `fraction` (0 to 1) is done, in the stage named `stage`."""
        if not self._stream.isatty() or time.monotonic() < self._appears_at:
            return
        if self._bar is None or self._task is None:
            self._bar = self._start_bar()
            self._task = self._bar.add_task(stage, total=1.0)
        self._bar.update(self._task, description=stage, completed=min(max(fraction, 0.0), 1.0))

    def _start_bar(self) -> RichProgress:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

        bar = Progress(
            TextColumn("{task.description:<12}"),
            BarColumn(),
            TaskProgressColumn(),
            console=Console(file=self._stream),
            transient=True,
        )
        bar.start()
        return bar

    def __enter__(self) -> TerminalProgress:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.stop()
            self._bar = None
