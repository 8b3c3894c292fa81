# SPDX-License-Identifier: BSD-3-Clause
"""What was tried to solve an increment: in the base, so that results can keep it without knowing the solver."""

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
