# SPDX-License-Identifier: BSD-3-Clause
"""What was tried, and what a search has spent: in the base, so that results can keep it without knowing the solver."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class MethodRun:
    """One method tried.

    Attributes
    ----------
    method : ``"newton"``, ``"path open"``, ``"path press"``, ``"path among touching"``, ``"springs"``,
        ``"rigid motions"``, ``"tree"``; in space also ``"gauss-seidel"``, ``"proximal newton"``
    iterations : linear systems solved (Newton), pivots (paths), linear programs (proofs), sweeps
    changes : pairs that changed their state, one number for each iteration; a pivot always changes one pair, so that
        paths leave this empty
    end : how it ended, in a few words
    """

    method: str
    iterations: int
    changes: tuple[int, ...] = ()
    end: str


@dataclass(frozen=True, kw_only=True)
class Spent:
    """A search that ended at its budget: what it was for is not known.

    All budgets are in ``docs/budgets.md``.

    Attributes
    ----------
    most : that may be spent
    of : what is spent, in words

    Examples
    --------
    >>> print(Spent(most=200, of="turns of the load behind a jump"))
    all 200 turns of the load behind a jump that may be tried are spent
    """

    most: int
    of: str

    def __str__(self) -> str:
        return f"all {self.most} {self.of} that may be tried are spent"
