# SPDX-License-Identifier: BSD-3-Clause
"""What a method is, what it hands to ``solve`` (an attempt), and what ``solve`` hands to its caller (a solution)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import ClassVar, Protocol

from signorini.arrays import Array
from signorini.lcp.problem import LCP
from signorini.lcp.residual import Residual
from signorini.short import Short


class Status(Enum):
    """The ending of a method; the value is what happened, the likely cause and what to try.

    Examples
    --------
    >>> Status.RAY_TERMINATION.name
    'RAY_TERMINATION'
    >>> print(Status.RAY_TERMINATION.value.split(".")[0])
    Lemke's path ended in a ray
    """

    SOLVED = "Solved: the natural residual of the problem as posed is within the tolerance."
    MAX_ITERATIONS = (
        "The iteration limit was reached before the tolerance. The problem may be ill-conditioned, or the limit low: "
        "raise the limit, start from a better z0, or use method='lemke', which ends by itself."
    )
    RAY_TERMINATION = (
        "Lemke's path ended in a ray. This proves that there is no solution only for special classes (copositive plus "
        "M, for one); otherwise try another covering vector, another method, or enumerate small problems."
    )
    STAGNATION = (
        "The method stopped making progress away from a solution (a local minimum of its merit function, or a repeated "
        "state). Try another start or method='lemke'."
    )
    NONFINITE = (
        "The iterates overflowed. M may be outside the class of the method, or the data spread over too many decades: "
        "rescale the units, or try method='lemke'."
    )
    BREAKDOWN = (
        "Numerical breakdown: the method claimed an answer that the problem as posed does not confirm, or a pivot was "
        "lost in rounding. The basis is nearly singular: check the conditioning and the scaling of M."
    )
    SINGULAR = (
        "A linear system of the method was singular. The method needs M (or its principal blocks) regular: "
        "use method='lemke' or add a small multiple of the identity on purpose."
    )
    NOT_APPLICABLE = (
        "The method does not apply to this problem (class of M, size, or the form in which M is given). "
        "The message says what it needs; method='auto' picks one that applies."
    )
    NO_SOLUTION = (
        "Proved: there is no solution, because no z >= 0 makes w >= 0, or because enumeration found no complementary "
        "basis and no face that holds one."
    )


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


@dataclass(frozen=True, kw_only=True, repr=False)
class Attempt(Short):
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

    z: Array | None = None
    w: Array | None = None
    status: Status
    iterations: int = 0
    residual: Residual | None = None
    candidate: Array | None = None
    message: str
    method: str
    chain: tuple[str, ...]
    ray: Ray | None = None

    @property
    def solved(self) -> bool:
        """Whether z and w are a solution within the tolerance, tested on the problem as posed."""
        return self.status is Status.SOLVED


class Method(Protocol):
    """A solver object: its fields are its options.

    Attributes
    ----------
    name : the word under which ``solve(..., method=name)`` finds it
    matrices : the class of matrices it is meant for, in words
    """

    name: ClassVar[str]
    matrices: ClassVar[str]

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:
        """Try to solve; never raises for a problem that it cannot solve.

        Parameters
        ----------
        problem : checked data
        z0 : (n,) start, or None
        tolerance : the natural residual that ``solve`` will ask for
        """
        ...
