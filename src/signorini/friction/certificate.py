# SPDX-License-Identifier: BSD-3-Clause
"""Whether a candidate is a solution: the one test that every method's answer passes, on the problem as posed."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.friction.problem import ContactProblem

_GONE = 1e9  # times the data: motions beyond are a body that has left, not a solution


def certify(problem: ContactProblem, y: Array, *, b: Array | None = None, origin: Array | None = None) -> float:
    """Largest violation of equilibrium by y, relative to the data; y obeys the law of friction as such (see `law`).

    The larger of ``max |b + W (h + r) - h| / scale`` and, for each rigid motion rho, ``|rho.(r + b)| / (scale sum
    |rho_i|)``. The second is not implied by the first in floating-point numbers: rounding in ``h - W h`` times a huge
    rigid motion h can balance any load. For the same reason motions above 1e9 times the data count as infinite.

    Parameters
    ----------
    problem : the problem as posed
    y : (d, n) candidate ``r - h``
    b : (d n,) another load instead of the problem's
    origin : (d, n) motion from which h is counted; b is the load of the whole motion then

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.0]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> certify(problem, np.array([[2.0], [0.0]])), certify(problem, np.zeros((2, 1)))
    (0.0, 1.0)
    """
    if not np.isfinite(y).all():
        return np.inf
    h, r = problem.law.split(y)
    unit = problem.scale if problem.scale > 0 else 1.0
    if np.abs(h).max(initial=0.0) > _GONE * unit:
        return np.inf
    load, whole = problem.b if b is None else b, h if origin is None else h + origin
    misfit = np.abs(problem.misfit(whole, r, load)).max(initial=0.0) / unit
    R = problem.image.R
    resultants = np.abs(R.T @ (r.ravel() + load)) / (unit * np.abs(R).sum(axis=0))
    return float(max(misfit, resultants.max(initial=0.0)))
