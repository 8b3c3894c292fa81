# SPDX-License-Identifier: BSD-3-Clause
"""How an attempt at a linear complementarity problem ended, each ending with its advice as text."""

from __future__ import annotations

from enum import Enum


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
