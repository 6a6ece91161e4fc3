"""What was repaired: each thing done, where, and how far it moved."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import overload

from adaptmesh.value import Value

SHOWN = 5
"""So many repairs of a kind are printed; `Repairs` holds all of them."""


NOWHERE = (math.nan, math.nan)
"""The place of a repair of what has no points."""


@dataclass(frozen=True, eq=False)
class Repair(Value):
    """One thing done to an outline.

    Attributes
    ----------
    kind : str
        What was wrong, in a word or two: ``"crossing"``, ``"nearly the same point"``, ...
    place : (float, float)
        Where; NaN for what has no points.
    what : str
        What was wrong there and what was done, with the items and the size of the change.
    displacement : float
        How far a point was moved for it, or a segment was bent; 0 if nothing moved.
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
        """The place in words; empty if it has none."""
        return "" if math.isnan(self.place[0]) else f"at {at(*self.place)}"


@dataclass(frozen=True, eq=False)
class Repairs(Value, Sequence[Repair]):
    """All that was done to an outline; printed as a report, and false if nothing was done.

    Attributes
    ----------
    records : tuple of Repair
        Each thing done, in the order of the work.
    tolerance : float
        What was nearer than this was made one.
    displacement : float
        The farthest that any point of the clean outline lies from the segment that it was on in
        the given one. Steps can add up, so that it may exceed the tolerance.
    """

    records: tuple[Repair, ...]
    tolerance: float
    displacement: float = 0.0

    @property
    def counts(self) -> dict[str, int]:
        """How many repairs of each kind there are."""
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
            f"nothing moved farther than {self.displacement:.3g})"
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
                for record in these[:SHOWN]
            ]
            if count > SHOWN:
                lines.append(f"    ... and {count - SHOWN} more")
        return "\n".join(lines)


def at(x: float, y: float) -> str:
    """A place as messages give it."""
    return f"({x:.10g}, {y:.10g})"
