"""Points and segments as they come, before they are checked."""

from __future__ import annotations

from dataclasses import dataclass

from .data import DomainData
from .domain import Domain
from .given import Given, given_of


@dataclass(frozen=True, eq=False)
class Outline(Given):
    """Points and segments that may be dirty: what `repair` makes a `Domain` of.

    The fields are the arguments of `Domain`, and mean the same; None is as if not given. Nothing
    is checked.

    Attributes
    ----------
    points : (n, 2) array_like of float
    segments : (k, 2) array_like of int
    holes : sequence of (x, y), or "nesting", optional
    regions : mapping of str or int to (x, y) or several
    names : mapping of str or int to sequence of int, or a choice
    tags, region_tags : mapping of str to int
    """

    @classmethod
    def of_domain(cls, domain: DomainData) -> Outline:
        """The arguments that a domain of straight segments was made of."""
        return cls(**vars(given_of(domain)))

    def domain(self) -> Domain:
        """The domain, if nothing is wrong; else a `DomainError` that says what, and where."""
        return Domain.of_given(self)
