# SPDX-License-Identifier: BSD-3-Clause
"""What a method hands to ``solve`` (an attempt), and what ``solve`` hands to its caller (a solution)."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.arrays import Array
from signorini.lcp.residual import Residual
from signorini.lcp.status import Status
from signorini.short import Short


@dataclass(frozen=True, kw_only=True, repr=False)
class Ray(Short):
    """The ray of Lemke's path: for every t >= 0, ``point + t direction`` solves ``LCP(M, q + (theta + t slope) d)``.

    Attributes
    ----------
    covering : (n,) the d of the path
    point, direction : (n,) arrays, in the units of z
    theta, slope : value of the artificial variable at the point, and its change along the direction (>= 0)
    """

    covering: Array
    point: Array
    direction: Array
    theta: float
    slope: float


@dataclass(frozen=True, kw_only=True)
class Attempt:
    """The ending of one method.

    Attributes
    ----------
    z : (n,) array to be judged, or None where the method has nothing to offer
    ending : the method's own word for why it stopped; ``Status.SOLVED`` is a claim that ``solve`` tests
    iterations : pivots, Newton steps or sweeps, as the method counts
    note : what the method wants to add to the advice of the status
    ray : Lemke's ray, where there is one
    """

    z: Array | None
    ending: Status
    iterations: int
    note: str = ""
    ray: Ray | None = None

    @staticmethod
    def refused(note: str, *, iterations: int = 0) -> Attempt:
        """A method that does not apply to a problem, and what it needs."""
        return Attempt(z=None, ending=Status.NOT_APPLICABLE, iterations=iterations, note=note)


@dataclass(frozen=True, kw_only=True, repr=False)
class LCPSolution(Short):
    """The answer to ``0 <= z  _|_  w = M z + q >= 0``.

    Attributes
    ----------
    z, w : (n,) read-only arrays where solved, None where nothing was found
    status : how it ended; only ``Status.SOLVED`` means a solution
    iterations : pivots, Newton steps or sweeps of the method that ended the search
    residual : natural residual of ``z`` where solved, else of the last candidate; None where there is no candidate
    candidate : the last iterate where the problem was not solved, for a look or a restart; else None
    message : what happened, in words, with the advice of the status
    method : the name of the method that ended the search
    chain : one line per method tried, in order
    ray : Lemke's ray, where the status is ``RAY_TERMINATION``
    """

    z: Array | None
    w: Array | None
    status: Status
    iterations: int
    residual: Residual | None
    candidate: Array | None
    message: str
    method: str
    chain: tuple[str, ...]
    ray: Ray | None

    @property
    def solved(self) -> bool:
        """Whether z and w are a solution within the tolerance, tested on the problem as posed."""
        return self.status is Status.SOLVED
