# SPDX-License-Identifier: BSD-3-Clause
"""A problem without pairs that stay open: what makes a long path short where few of many candidates touch."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import BoolArray
from signorini.condense.basis import make_basis
from signorini.condense.operator import InterfaceOperator
from signorini.friction.problem import ContactProblem
from signorini.law.bound import Bound


def restrict_to(problem: ContactProblem, kept: BoolArray) -> ContactProblem | None:
    """The problem of the kept pairs, all others open, which takes from compliance and motions the rows of the others.

    With c the rows kept, ``R_c = Q T`` and P = I - Q Q', what is left is again of the form of `condense.image`::

        h_c = A_cc r_c + c_c + R_c a,    R_c' r_c = -R'b
        A = P A_cc P,    Q'b = T^-T R'b,    c = P (c_c - A_cc Q Q'b)

    Parameters
    ----------
    problem : the problem
    kept : (n,) pairs that may close

    Returns
    -------
    problem : None where the kept pairs do not hold the bodies: the motions that they see are dependent

    Examples
    --------
    >>> W = np.array([[0.5, 0.25, 0, 0], [0.25, 0.5, 0, 0], [0, 0, 0.5, 0], [0, 0, 0, 0.5]])
    >>> problem = ContactProblem.of(W=W, b=np.ones(4), friction=[0.3, 0.3], motions=np.zeros((4, 0)), scale=1.0)
    >>> restrict_to(problem, np.array([True, False])).W.round(12).tolist()
    [[0.625, 0.0], [0.0, 0.5]]
    """
    c, image = np.flatnonzero(np.tile(kept, 2)), problem.image
    try:
        basis = make_basis(image.R[c])
    except np.linalg.LinAlgError:
        return None
    A, resultant = image.A[np.ix_(c, c)], basis.coefficients(image.R.T @ problem.b)
    free = problem.free_motion()[c] - basis.project(A) @ resultant
    few = InterfaceOperator.of_compliance(A, problem.motions[c], basis.R)
    return replace(
        problem,
        image=few,
        b=few.load(free, resultant),
        friction=problem.friction.among(kept) if isinstance(problem.friction, Bound) else problem.friction[..., kept],
        adhesion=None if problem.adhesion is None else problem.adhesion[kept],
        limit=None if problem.limit is None else problem.limit[kept],
    )
