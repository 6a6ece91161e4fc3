"""BAMG, as the command ffbamg of FreeFem++ (Debian: freefem++).

Every point of the domain is a corner and required. No gradation, and limits that do not bind. It
knows the metric from a file and writes a file. Its own "Cpu time for meshing" leaves out the
smoothing and counts in steps of 10 ms, so files are taken off otherwise: a run that reads the mesh
and only writes it again (-r) tells what a byte of file costs, and the rest of the CPU time of a
process is the mesher's.
"""

from __future__ import annotations

import re
import resource
import shutil
import statistics
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from mesher import Remesher, Run, Stopwatch
from outline import region_loops, segment_numbers

PROGRAM = "ffbamg"
SMOOTHINGS = 3  # its default


class Bamg(Remesher):
    def __init__(self, problem):
        super().__init__(problem)
        if not shutil.which(PROGRAM):
            raise ImportError(f"{PROGRAM} is not on PATH: it is in FreeFem++")
        self._scratch = tempfile.TemporaryDirectory()
        self._folder = Path(self._scratch.name)
        self._passes = 0
        self._cpu_of_files = None

    def converge(self):
        best, total_cpu, total_wall = super().converge()
        self._cpu_of_files = self._measure_files(best)
        best.cpu -= self._cpu_of_files
        return best, total_cpu, total_wall

    def again(self):
        run = super().again()
        run.cpu -= self._cpu_of_files
        return run

    def start(self):
        size = np.sqrt(self.problem.domain.area / 1000)
        (self._folder / "domain.mesh").write_text(geometry(self.problem.domain, size))
        self._call("-g", "domain.mesh", "-o", "0.mesh")
        return self._read("0.mesh", 0.0, 0.0)

    def remesh(self, previous, tensors):
        self._passes += 1
        name = f"{self._passes}.mesh"
        with Stopwatch() as clock:
            self._write_metric(tensors)
            cpu = self._call(*self._options(previous), "-o", name)
            run = self._read(name, cpu, 0.0)
        run.wall = clock.wall
        return run

    def _measure_files(self, best):
        """CPU seconds of a pass that go into its files: metric, mesh read, mesh written."""
        previous = self._last[0].extra["file"]
        copied = "-r", previous, "-M", "metric.txt", "-NbSmooth", 0, "-o", "copy.mesh"
        self._write_metric(self._last[1])
        cpu = statistics.median(self._call(*copied) for _ in range(3))
        size = {name: (self._folder / name).stat().st_size for name in ("metric.txt", previous)}
        written = (self._folder / best.extra["file"]).stat().st_size
        copy = (self._folder / "copy.mesh").stat().st_size
        return cpu * (sum(size.values()) + written) / (sum(size.values()) + copy)

    def _options(self, previous):
        wide = {"-hmin": 1e-9, "-hmax": 1e3}
        given = {"-b": previous.extra["file"], "-M": "metric.txt", "-NbSmooth": SMOOTHINGS}
        limits = {"-ratio": 0, "-maxsubdiv": 10, "-anisomax": 1e12}
        limits |= {name: share * self.problem.diameter for name, share in wide.items()}
        return [part for option in (given | limits).items() for part in option]

    def _call(self, *arguments):
        """Runs it; CPU seconds of the process."""
        most = ("-nbv", 3 * self.problem.target + 50_000, "-v", 1)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(
            [PROGRAM, *map(str, arguments + most)],
            cwd=self._folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            check=False,
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode:
            raise RuntimeError(f"{PROGRAM} ended with {done.returncode}: {done.stdout[-200:]}")
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def _write_metric(self, tensors):
        with (self._folder / "metric.txt").open("w") as file:
            file.write(f"{len(tensors)} 3\n")
            np.savetxt(file, tensors, "%.15g")

    def _read(self, name, cpu, wall):
        text = (self._folder / name).read_text()
        points = _block(text, "Vertices", 3)[:, :2]
        triangles = _block(text, "Triangles", 4)[:, :3].astype(np.int64) - 1
        return Run(points, triangles, cpu, wall, {"file": name})


def geometry(domain, size):
    """A domain in BAMG's format, with a size for the first mesh at its points."""
    every = np.arange(1, len(domain.points) + 1)
    a, b = domain.points[domain.segments].transpose(1, 0, 2)
    sizes = np.full(len(domain.points), size)
    np.minimum.at(sizes, domain.segments, np.hypot(*(b - a).T)[:, None])
    segment = segment_numbers(domain)
    subdomains = []
    for region, loops in region_loops(domain):
        number, way = segment[loops[0][0], loops[0][1]]
        subdomains.append((2, number + 1, way, region + 1))
    blocks = {
        "Vertices": np.column_stack([domain.points, every]),
        "Edges": np.column_stack([domain.segments + 1, 1 + np.arange(len(domain.segments))]),
        "Corners": every[:, None],
        "RequiredVertices": every[:, None],
        "SubDomain": np.array(subdomains),
    }
    lines = ["MeshVersionFormatted 0", "Dimension 2", "MaximalAngleOfCorner 0.001"]
    for name, rows in blocks.items():
        lines.append(f"{name} {len(rows)}")
        lines += [" ".join(f"{value:.17g}" for value in row) for row in rows]
    lines += ["hVertices", " ".join(f"{value:.17g}" for value in sizes), "End"]
    return "\n".join(lines) + "\n"


def _block(text, name, width):
    head = re.search(rf"^{name}\s+(\d+)\s", text, re.MULTILINE)
    count = int(head[1])
    return np.fromstring(text[head.end() :], sep=" ", count=count * width).reshape(count, width)
