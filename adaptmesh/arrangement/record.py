"""Records of repairs: what was done, where, and how far points moved."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import overload

from adaptmesh.value import Value

MAX_PRINTED = 5
"""Number of repairs of each kind in a printed report; `Repairs` holds all of them."""

NOWHERE = (math.nan, math.nan)
"""The place of a repair of something without points."""


@dataclass(frozen=True, eq=False)
class Repair(Value):
    """One repair of an outline.

    Attributes
    ----------
    kind : str
        What was wrong, in a word or two: ``"crossing"``, ``"nearly the same point"``, ...
    place : (float, float)
        Coordinates; NaN for something without points.
    what : str
        What was wrong and what was done, with the items and the size of the change.
    displacement : float
        How far a point was moved or a segment was bent; 0 if nothing moved.
    """

    kind: str
    place: tuple[float, float]
    what: str
    displacement: float = 0.0

    def __str__(self) -> str:
        where = f" {self.where}" if self.where else ""
        return f"{self.kind}{where}: {self.what}"

    @property
    def where(self) -> str:
        """The place as text; empty if there is none."""
        return "" if math.isnan(self.place[0]) else f"at {point_text(*self.place)}"


@dataclass(frozen=True, eq=False)
class Repairs(Value, Sequence[Repair]):
    """The repairs of an outline: printed as a report, false if there are none.

    Attributes
    ----------
    records : tuple of Repair
        The repairs in the order in which they were made.
    tolerance : float
        Points closer than this were merged.
    displacement : float
        The largest distance of a point of the clean outline from the given segment that it
        belongs to. Several steps can add up to more than the tolerance.
    """

    records: tuple[Repair, ...]
    tolerance: float
    displacement: float = 0.0

    @property
    def counts(self) -> dict[str, int]:
        """The number of repairs of each kind."""
        return dict(Counter(record.kind for record in self.records))

    def __len__(self) -> int:
        return len(self.records)

    def __iter__(self) -> Iterator[Repair]:
        return iter(self.records)

    @overload
    def __getitem__(self, index: int) -> Repair: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Repair, ...]: ...
    def __getitem__(self, index: int | slice) -> Repair | tuple[Repair, ...]:
        return self.records[index]

    def _nothing(self) -> str:
        return f"nothing to repair (tolerance {self.tolerance:.3g})"

    def _heading(self) -> str:
        n = len(self)
        return (
            f"{n} repair{'s' if n > 1 else ''} (tolerance {self.tolerance:.3g}, "
            f"largest displacement {self.displacement:.3g})"
        )

    def __str__(self) -> str:
        if not self.records:
            return self._nothing()
        lines = [self._heading()]
        for kind, count in self.counts.items():
            lines.append(f"  {kind}: {count}")
            these = [record for record in self.records if record.kind == kind]
            lines += [
                f"    {record.where}: {record.what}" if record.where else f"    {record.what}"
                for record in these[:MAX_PRINTED]
            ]
            if count > MAX_PRINTED:
                lines.append(f"    ... and {count - MAX_PRINTED} more")
        return "\n".join(lines)


def point_text(x: float, y: float) -> str:
    """Format a point for a message."""
    return f"({x:.10g}, {y:.10g})"
