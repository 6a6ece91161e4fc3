"""Each mesher works in a process of its own, so that none can spoil, crash or stall another.

A worker holds the mesher between requests, so that its runs can be interleaved with those of the
others; only one works at a time.
"""

from __future__ import annotations

import importlib
import multiprocessing
import re
from pathlib import Path

from cases import CASES, Problem

MESHERS = {  # name: (module, class)
    "adaptmesh": ("peer_adaptmesh", "Adaptmesh"),
    "BAMG": ("peer_bamg", "Bamg"),
    "MMG2D": ("peer_mmg", "Mmg"),
    "Gmsh": ("peer_gmsh", "Gmsh"),
    "Triangle": ("peer_triangle", "Triangle"),
}


class MesherFailed(Exception):  # noqa: N818
    """It is not installed, it crashed, it stalled, or it raised."""


class Worker:
    """A mesher and a problem in another process; a context manager."""

    def __init__(self, mesher, problem, time_limit):
        self._limit = time_limit
        context = multiprocessing.get_context("spawn")
        self._pipe, far_end = context.Pipe()
        arguments = far_end, mesher, problem.case.name, problem.target
        self._process = context.Process(target=_serve, args=arguments, daemon=True)
        self._process.start()
        far_end.close()
        self._answer()

    def ask(self, request):
        """Calls the method of that name of the mesher, and returns what it returns."""
        self._pipe.send(request)
        return self._answer()

    def _answer(self):
        if not self._pipe.poll(self._limit):
            raise MesherFailed(f"took more than {self._limit:.0f} s")
        try:
            good, answer = self._pipe.recv()
        except EOFError:
            self._process.join()
            raise MesherFailed(f"crashed (exit code {self._process.exitcode})") from None
        if not good:
            raise MesherFailed(answer)
        return answer

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self._pipe.close()
        self._process.kill()
        self._process.join()


def _serve(pipe, mesher, case, target):
    """Runs in the other process: makes the mesher, then answers requests until the pipe closes."""
    try:
        module, name = MESHERS[mesher]
        made = getattr(importlib.import_module(module), name)(Problem(CASES[case], target))
        pipe.send((True, None))
        while True:
            request = pipe.recv()
            reset_peak_memory()
            before = memory("VmRSS")
            answer = getattr(made, request)()
            pipe.send((True, (answer, memory("VmHWM") - before)))
    except EOFError:
        return
    except Exception as error:
        pipe.send((False, f"{type(error).__name__}: {error}"[:200]))


def memory(what):
    """VmRSS or VmHWM, what the process has or has had at most, in bytes; NaN except on Linux."""
    status = Path("/proc/self/status")
    found = re.search(rf"{what}:\s+(\d+) kB", status.read_text()) if status.exists() else None
    return 1024 * int(found[1]) if found else float("nan")


def reset_peak_memory():
    switch = Path("/proc/self/clear_refs")
    if switch.exists():
        switch.write_text("5")
