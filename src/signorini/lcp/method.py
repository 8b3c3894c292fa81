# SPDX-License-Identifier: BSD-3-Clause
"""What every method is: a frozen record of its options, with one function that makes an attempt."""

from __future__ import annotations

from typing import ClassVar, Protocol

from signorini.arrays import Array
from signorini.lcp.problem import LCP
from signorini.lcp.solution import Attempt


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
