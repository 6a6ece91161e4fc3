"""adaptmesh beside its peers: time and quality, written to docs/performance.md.

    python tests/benchmarks/compare.py                     # everything, less than 20 minutes
    python tests/benchmarks/compare.py --quick             # four cases, less than 3 minutes
    python tests/benchmarks/compare.py --cases ring --levels 30000
    python tests/benchmarks/compare.py --page              # page and plots from the last results

Only a full run writes the page by itself; with `--results FILE` the numbers of any run are kept,
and `--page --results FILE` makes the page of them.

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
from page import write_page
from worker import MESHERS, MesherFailed, Worker

DOCS = Path(__file__).resolve().parents[2] / "docs"
RESULTS = DOCS / "_static" / "performance.json"

ROUNDS = {1_000: 5, 10_000: 5, 100_000: 3, 1_000_000: 1}
SCALED = ("radial", "ring")  # up to a million, adaptmesh alone
PHASED = ("radial", "aerofoil", "ring", "plate")
QUICK_CASES = ("radial", "wall", "ring", "plate")
LARGEST_COMPARED = 100_000
LARGEST_FOR_TENSORS = {"Gmsh": 10_000, "Triangle": 0}  # one is slow, one knows only sizes
TIME_LIMIT = 300.0  # seconds for one request


def takes_part(mesher, problem):
    if mesher == "adaptmesh":
        return True
    if problem.target > LARGEST_COMPARED:
        return False
    if problem.case.is_isotropic:
        return True
    return problem.target <= LARGEST_FOR_TENSORS.get(mesher, LARGEST_COMPARED)


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
    parser.add_argument("--levels", nargs="+", type=int, help="only these numbers of triangles")
    parser.add_argument("--results", type=Path, help="file for the numbers, or to take them from")
    parser.add_argument("--page", action="store_true", help="run nothing, write the page anew")
    return parser.parse_args()


def run(given):
    """Compares everything that was asked for, and prints it."""
    rows = []
    for problem in problems(given):
        new = compare(problem, ROUNDS.get(problem.target, 3))
        for row in new:
            say(row)
        rows += new
    level = min(LARGEST_COMPARED, max(row["level"] for row in rows))
    stages = [phases_of(Problem(CASES[name], level), rounds=3) for name in PHASED]
    return {"machine": machine(), "rows": rows, "phases": stages}


def main():
    given = arguments()
    os.environ["OMP_NUM_THREADS"] = "1"
    in_part = given.quick or given.cases or given.levels
    file = given.results or (None if in_part else RESULTS)
    results = json.loads((file or RESULTS).read_text()) if given.page else run(given)
    if file and not given.page:
        file.write_text(json.dumps(results, indent=1) + "\n")
    if given.page or not in_part:
        write_page(results, DOCS)


if __name__ == "__main__":
    main()
