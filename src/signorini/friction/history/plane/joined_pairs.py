# SPDX-License-Identifier: BSD-3-Clause
"""A problem whose pairs stand for some neighbours each: where long zones of states end, nearly, for little.

Pairs that follow each other have the same force, scaled, and feel the mean of their motions. They are numbered along a
side, as meshes are; where they are not the states that are found are a bad guess, and nothing worse.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.condense.basis import make_basis
from signorini.condense.operator import InterfaceOperator
from signorini.friction.problem import ContactProblem
from signorini.law.bound import Bound

WIDTH = 4
"""Neighbours that one pair stands for."""


def joined(problem: ContactProblem, first: IntArray) -> ContactProblem | None:
    """The problem of runs of pairs, with P their orthonormal indicators, of the form of `plane.restricted`.

    What P leaves of A and of the motions is ``P' A P`` and ``P' R``.

    Parameters
    ----------
    problem : of the plane, in Coulomb's law
    first : (m,) the first pair of every run, ascending from 0

    Returns
    -------
    problem : None where runs do not hold the bodies: the motions that they see are dependent

    Examples
    --------
    >>> W = np.kron(np.eye(2), [[0.5, 0.25], [0.25, 0.5]])
    >>> problem = ContactProblem.of(W=W, b=np.ones(4), friction=[0.3, 0.3], motions=np.zeros((4, 0)), scale=1.0)
    >>> joined(problem, np.array([0])).W.round(12).tolist()
    [[0.75, 0.0], [0.0, 0.75]]
    """
    n, image = problem.pairs, problem.image
    starts = np.concatenate([first, n + first])
    weight = np.sqrt(np.tile(np.diff(first, append=n), 2))

    def seen(rows: Array) -> Array:
        return (np.add.reduceat(rows, starts, axis=0).T / weight).T

    try:
        basis = make_basis(seen(image.R))
    except np.linalg.LinAlgError:
        return None
    A = np.ascontiguousarray(seen(seen(image.A).T).T)
    resultant = basis.coefficients(image.R.T @ problem.b)
    free = seen(problem.free_motion()) - basis.project(A) @ resultant
    few = InterfaceOperator.of_compliance(A, seen(problem.motions), basis.R)
    assert not isinstance(problem.friction, Bound)
    return replace(problem, image=few, b=few.load(free, resultant), friction=problem.friction[..., first])


def may_be_joined(problem: ContactProblem) -> bool:
    """Whether all pairs have Coulomb's law alone and may move along their tangents."""
    if isinstance(problem.friction, Bound) or problem.axes is not None or problem.guided:
        return False
    plain = problem.adhesion is None and problem.limit is None and problem.tresca is None
    return plain and bool(np.isfinite(problem.friction).all())
