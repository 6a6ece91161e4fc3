"""The tables of docs/performance.md, between markers in the page, and its plots."""

from __future__ import annotations

import re

from plots import plot_all
from worker import MESHERS

PEERS = [name for name in MESHERS if name != "adaptmesh"]

# What is nearer than this counts as the same.
UNIT_MARGIN = 0.0005
TIME_MARGIN = 1.05
QUALITY_MARGIN = 0.05
ERROR_MARGIN = 1.01
LEVELS = (1_000, 10_000, 100_000)


def write_page(results, docs):
    """Fills in the tables from results, and draws the plots."""
    table = Table(results["rows"])
    parts = {
        "machine": "{processor}; {system}; {date}.".format(**results["machine"]),
        "time": per_level(table, time_table),
        "unit": per_level(table, unit_table),
        "quality": per_level(table, quality_table),
        "count": per_level(table, count_table),
        "error": error_table(table),
        "behind": behind(table),
        "size": size_table(table),
        "phases": phases_table(results["phases"]),
    }
    page = docs / "performance.md"
    text = page.read_text()
    for name, part in parts.items():
        text = replaced(text, name, part)
    page.write_text(text)
    plot_all(results, docs / "_static")


def replaced(text, name, part):
    """The text between the markers of a name replaced; both must be there."""
    begin, end = f"<!-- {name}: written by compare.py -->", f"<!-- end of {name} -->"
    pattern = re.escape(begin) + ".*?" + re.escape(end)
    if not re.search(pattern, text, re.DOTALL):
        raise ValueError(f"docs/performance.md has no markers for {name!r}")
    return re.sub(pattern, lambda _: f"{begin}\n{part}\n{end}", text, flags=re.DOTALL)


class Table:
    """The rows by case, level and mesher."""

    def __init__(self, rows):
        self.rows = rows
        self._by_key = {(row["case"], row["level"], row["mesher"]): row for row in rows}

    def cases(self, level):
        return list(dict.fromkeys(row["case"] for row in self.rows if row["level"] == level))

    def get(self, case, level, mesher):
        return self._by_key.get((case, level, mesher))

    def entry(self, case, level, mesher, show):
        """What `show` makes of a row: '–' if there is none, 'failed' if it failed."""
        row = self.get(case, level, mesher)
        if row is None:
            return "–"
        return "failed" if "failed" in row else show(row)


def markdown(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def per_level(table, make):
    parts = [
        f"\n{level:,} triangles asked for:\n\n{make(table, level)}\n"
        for level in LEVELS
        if table.cases(level)
    ]
    return "\n".join(parts)


def seconds(value):
    return f"{value:.3f}" if value < 1 else f"{value:.2f}"


def time_table(table, level):
    """Our CPU seconds; those of the peers as multiples, last pass and all passes."""
    head = ["case", "adaptmesh, s", *(f"{peer}, last / all" for peer in PEERS)]
    rows = []
    for case in table.cases(level):
        ours = table.get(case, level, "adaptmesh")

        def multiples(row, ours=ours):
            return " / ".join(f"{row[key] / ours['cpu']:.1f}" for key in ("cpu", "total_cpu"))

        peers = (table.entry(case, level, peer, multiples) for peer in PEERS)
        rows.append([case, seconds(ours["cpu"]), *peers])
    return markdown(head, rows)


def table_of(show):
    def make(table, level):
        head = ["case", *MESHERS]
        rows = [
            [case, *(table.entry(case, level, name, show) for name in MESHERS)]
            for case in table.cases(level)
        ]
        return markdown(head, rows)

    return make


unit_table = table_of(
    lambda row: f"{100 * row['unit']:.2f}" + (" (not valid)" if row["broken"] else "")
)
quality_table = table_of(lambda row: f"{row['quality_min']:.2f} / {row['quality_mean']:.3f}")
count_table = table_of(lambda row: f"{row['count_ratio']:.2f}")


def error_table(table):
    keys = [(case, n) for n in LEVELS for case in table.cases(n)]
    keys = [key for key in keys if "error" in (table.get(*key, "adaptmesh") or {})]
    rows = [
        [
            f"{case}, {level:,}",
            *(
                table.entry(case, level, name, lambda row: f"{row['error'] * row['vertices']:.3f}")
                for name in MESHERS
            ),
        ]
        for case, level in keys
    ]
    return markdown(["case, level", *MESHERS], rows)


def behind(table):
    """Where a peer does better than adaptmesh: for each advantage the cases, and by how much."""
    lines = []
    for level in LEVELS:
        for advantage, of_row in ADVANTAGES.items():
            found = [
                f"{peer} on {', '.join(cases)}"
                for peer in PEERS
                if (cases := list(_cases_with(table, level, peer, of_row)))
            ]
            if found:
                lines.append(f"- {level:,}, {advantage}: {'; '.join(found)}")
    return "\n".join(lines) or "Nowhere in this run."


def _cases_with(table, level, peer, of_row):
    for case in table.cases(level):
        ours, row = table.get(case, level, "adaptmesh"), table.get(case, level, peer)
        if row and "failed" not in row and (how_much := of_row(row, ours)):
            yield f"{case} ({how_much})"


def _faster(row, ours):
    return f"{ours['cpu'] / row['cpu']:.1f}×" if row["cpu"] * TIME_MARGIN < ours["cpu"] else None


def _faster_in_all(row, ours):
    ratio = ours["total_cpu"] / row["total_cpu"]
    return f"{ratio:.1f}×" if ratio > TIME_MARGIN else None


def _more_unit(row, ours):
    gain = row["unit"] - ours["unit"]
    return (
        f"{100 * row['unit']:.2f} against {100 * ours['unit']:.2f} %"
        if gain > UNIT_MARGIN
        else None
    )


def _better_worst(row, ours):
    pair = row["quality_min"], ours["quality_min"]
    return "{:.2f} against {:.2f}".format(*pair) if pair[0] > pair[1] + QUALITY_MARGIN else None


def _less_error(row, ours):
    pair = [r.get("error", 0) * r["vertices"] for r in (row, ours)]
    return "{:.3f} against {:.3f}".format(*pair) if pair[0] * ERROR_MARGIN < pair[1] else None


ADVANTAGES = {
    "faster in the last pass": _faster,
    "faster in all passes": _faster_in_all,
    "more unit edges": _more_unit,
    "a better worst triangle": _better_worst,
    "less error for each vertex": _less_error,
}


def size_table(table):
    head = ["case", "triangles", "CPU, s", "µs a triangle", "peak memory, MB", "bytes a triangle"]
    rows = []
    for row in table.rows:
        if row["mesher"] != "adaptmesh" or row["case"] not in ("radial", "ring"):
            continue
        n = row["triangles"]
        rows.append(
            [
                row["case"],
                f"{n:,}",
                seconds(row["cpu"]),
                f"{1e6 * row['cpu'] / n:.2f}",
                f"{row['memory'] / 1e6:.0f}",
                f"{row['memory'] / n:.0f}",
            ]
        )
    return markdown(head, sorted(rows, key=lambda row: row[0]))


def phases_table(stages):
    names = [name for name in stages[0]["seconds"] if any(s["seconds"][name] > 0 for s in stages)]
    head = ["case", *names]
    rows = []
    for stage in stages:
        total = sum(stage["seconds"].values())
        shares = (f"{100 * stage['seconds'][name] / total:.0f}" for name in names)
        rows.append([f"{stage['case']}, {stage['level']:,}", *shares])
    return markdown(head, rows)
