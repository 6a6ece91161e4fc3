"""Read damaged files of every format, as many as you like: python tests/damaged_files.py 1000 .vtu

``7000:9000`` in place of the number is a range of seeds. Without suffixes, files of all. Suffixes
of meshio are read in forks of this process. Prints what came of them, and all that may not be.
"""

import sys
import tempfile
import time
import traceback
from collections import Counter
from pathlib import Path

from reference import by_fork
from reference.damage import Whole, contents, little_memory, read_every_way
from reference.whole_files import WHOLE, of_mesh

from adaptmesh.io.domains.geo import by_gmsh
from adaptmesh.io.formats import FORMATS
from adaptmesh.io.meshes import meshio_process


def main(seeds, suffixes):
    by_gmsh.is_installed = lambda: False  # it takes a process for each
    meshio_process._run = by_fork.run
    others = contents()
    for suffix in suffixes:
        if suffix in FORMATS:
            WHOLE.setdefault(suffix, {"by meshio": of_mesh(f"a{suffix}")})
        for way in WHOLE[suffix]:
            with tempfile.TemporaryDirectory() as folder:
                run(seeds, Whole(suffix, way, Path(folder)), others, f"{suffix} {way}")


def run(seeds, whole, others, label):
    outcomes, start, slowest = Counter(), time.process_time(), (0.0, 0)
    for seed in seeds:
        whole.damage(seed, others)
        began = time.process_time()
        try:
            with little_memory():
                outcomes[read_every_way(whole.path)] += 1
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            last = traceback.extract_tb(error.__traceback__)[-1]
            outcomes["FAILED"] += 1
            print(f"{label}, seed {seed}: {last.filename}:{last.lineno} {error!r}"[:600])
        slowest = max(slowest, (time.process_time() - began, seed))
    print(
        f"{label:16} {dict(outcomes)}; {time.process_time() - start:.0f} s CPU, at most "
        f"{slowest[0]:.2f} s (seed {slowest[1]})",
        flush=True,
    )


if __name__ == "__main__":
    main(range(*map(int, sys.argv[1].split(":"))), sys.argv[2:] or list(WHOLE))
