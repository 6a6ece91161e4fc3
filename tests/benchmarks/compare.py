"""adaptmesh beside its peers: time and quality, written to docs/performance.md.

    python tests/benchmarks/compare.py            # everything, less than 20 minutes
    python tests/benchmarks/compare.py --quick    # four cases, less than 3 minutes
    python tests/benchmarks/compare.py --page     # only the page and plots, from the last results

Peers: `pip install ".[peers]"` (Gmsh, MMG2D, Triangle), and BAMG as `ffbamg` on PATH (FreeFem++;
Debian: freefem++). What is missing is left out. Needs a Unix; numbers of memory need Linux.

Every mesher works in a process of its own, on one thread. First each makes its best mesh (see
`mesher.py`), which is judged by the exact metric; then all repeat their last step in turn, and the
table has the medians. Compare ratios within one run, not seconds of different runs.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import time
from contextlib import ExitStack
from pathlib import Path

from cases import CASES, Problem
from judge import judge
from worker import MESHERS, MesherFailed, Worker

DOCS = Path(__file__).resolve().parents[2] / "docs"
RESULTS = DOCS / "_static" / "performance.json"

ROUNDS = {1_000: 5, 10_000: 5, 100_000: 3, 1_000_000: 1}
SCALED = ("radial", "ring")  # up to a million, adaptmesh alone
PHASED = ("radial", "aerofoil", "ring", "plate")
QUICK_CASES = ("radial", "wall", "ring", "plate")
LARGEST_COMPARED = 100_000
ONLY_SIZES = ("Triangle",)
LARGEST_FOR_TENSORS = {"Gmsh": 10_000}  # it takes a second for ten thousand triangles
TIME_LIMIT = 300.0  # seconds for one request


def takes_part(mesher, problem):
    if mesher == "adaptmesh":
        return True
    if problem.target > LARGEST_COMPARED or (
        mesher == "Triangle" and not problem.case.is_isotropic
    ):
        return False
    slow = mesher == "Gmsh" and not problem.case.is_isotropic
    return not slow or problem.target <= LARGEST_FOR_GMSH_TENSORS


def compare(problem, rounds):
    """A row for each mesher that takes part; those that fail say why."""
    rows, workers, runs = {}, {}, {}
    with ExitStack() as stack:
        for name in filter(lambda name: takes_part(name, problem), MESHERS):
            rows[name] = {"case": problem.case.name, "level": problem.target, "mesher": name}
            try:
                worker = stack.enter_context(Worker(name, problem, TIME_LIMIT))
                (run, total_cpu, total_wall), peak = worker.ask("converge")
            except MesherFailed as failure:
                rows[name]["failed"] = str(failure)
                continue
            workers[name], runs[name] = worker, [run]
            rows[name] |= {"total_cpu": total_cpu, "total_wall": total_wall, "memory": peak}
            rows[name] |= judge(problem, run.points, run.triangles)
        for _ in range(rounds - 1):
            for name, worker in workers.items():
                runs[name].append(worker.ask("again")[0])
    for name, done in runs.items():
        rows[name]["cpu"] = statistics.median(run.cpu for run in done)
        rows[name]["wall"] = statistics.median(run.wall for run in done)
    return list(rows.values())


def phases_of(problem, rounds):
    """CPU seconds of each stage of adaptmesh, medians."""
    with Worker("adaptmesh", problem, TIME_LIMIT) as worker:
        done = [worker.ask("phases")[0] for _ in range(rounds)]
    seconds = {name: statistics.median(run[name] for run in done) for name in done[0]}
    return {"case": problem.case.name, "level": problem.target, "seconds": seconds}


def problems(arguments):
    """What to compare, the small ones first."""
    if arguments.cases or arguments.levels:
        names, levels = arguments.cases or list(CASES), arguments.levels or [10_000]
        return [Problem(CASES[name], level) for level in levels for name in names]
    if arguments.quick:
        return [Problem(CASES[name], 10_000) for name in QUICK_CASES]
    compared = [Problem(CASES[name], n) for n in ROUNDS if n <= LARGEST_COMPARED for name in CASES]
    return compared + [Problem(CASES[name], 1_000_000) for name in SCALED]


def machine():
    processor = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        names = [line for line in cpuinfo.read_text().splitlines() if line.startswith("model name")]
        processor = names[0].split(":")[1].strip() if names else processor
    return {
        "processor": f"{processor}, {os.cpu_count()} cores",
        "system": f"{platform.system()} {platform.machine()}, Python {platform.python_version()}",
        "date": time.strftime("%Y-%m-%d"),
    }


def say(row):
    head = f"{row['case']:10}{row['level']:9} {row['mesher']:10}"
    if "failed" in row:
        print(f"{head} {row['failed']}", flush=True)
        return
    print(
        f"{head}{row['triangles']:8} triangles"
        f"  cpu {row['cpu']:7.3f}  total {row['total_cpu']:7.3f}"
        f"  unit {100 * row['unit']:6.2f} %  Q {row['quality_min']:.3f} {row['quality_mean']:.3f}"
        f"  {', '.join(row['broken']) or 'valid'}",
        flush=True,
    )


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="four cases at 10 000 triangles")
    parser.add_argument("--cases", nargs="+", choices=CASES, help="only these")
    parser.add_argument("--levels", nargs="+", type=int, help="numbers of triangles")
    parser.add_argument("--page", action="store_true", help="write the page again, run nothing")
    parser.add_argument(
        "--results", type=Path, default=RESULTS, help="file of the numbers; default: in docs/"
    )
    return parser.parse_args()


def main():
    given = arguments()
    os.environ["OMP_NUM_THREADS"] = "1"
    if not given.page:
        rows = []
        for problem in problems(given):
            new = compare(problem, ROUNDS.get(problem.target, 3))
            for row in new:
                say(row)
            rows += new
        level = 10_000 if given.quick else LARGEST_COMPARED
        stages = [phases_of(Problem(CASES[name], level), rounds=3) for name in PHASED]
        results = {"machine": machine(), "rows": rows, "phases": stages}
        given.results.write_text(json.dumps(results, indent=1) + "\n")
    if given.results == RESULTS:
        from page import write_page

        write_page(json.loads(RESULTS.read_text()), DOCS)


if __name__ == "__main__":
    main()
