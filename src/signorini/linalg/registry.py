# SPDX-License-Identifier: BSD-3-Clause
"""The back ends by name, and the one door to them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numpy.typing import ArrayLike

from signorini.errors import InputError, one_of
from signorini.linalg import multifrontal, pardiso, superlu
from signorini.linalg.elsewhere import is_elsewhere
from signorini.linalg.plan import Plans
from signorini.linalg.protocol import Factorisation
from signorini.linalg.system import System, checked_system

BACKENDS: dict[str, Callable[[System], Factorisation]] = {
    "multifrontal": multifrontal.factorise,
    "pardiso": pardiso.factorise,
    "superlu": superlu.factorise,
}


AUTOMATIC = "multifrontal"
"""What "auto" stands for. Measured on one thread it is never behind PARDISO, in the plane or in space
(`benchmarks/linalg.py`), and it needs nothing that has to be installed apart."""

BORDERED = frozenset({"multifrontal"})
"""Back ends whose interface may be a border, rows without stiffness of their own: `linalg.system.bordered`. Others
factorise a matrix with the interface in it and have to lift it."""


def takes_borders(backend: str) -> bool:
    """Whether the interface may be a border.

    >>> takes_borders("auto"), takes_borders("superlu")
    (True, False)
    """
    return (AUTOMATIC if backend == "auto" else backend) in BORDERED


def factorise(
    K: Any,
    interface: ArrayLike,
    *,
    nodes: ArrayLike | None = None,
    points: ArrayLike | None = None,
    backend: str = "auto",
    plans: Plans | None = None,
) -> Factorisation:
    """Factorise the interior of a symmetric matrix and condense it onto the interface.

    Parameters
    ----------
    K : (n, n) sparse array, symmetric, both triangles stored; or a `MatrixElsewhere`, which is factorised there
    interface : (m,) unknowns that are not eliminated, in the order of the condensed system; may be empty
    nodes : (n,) node of every unknown; makes the analysis cheaper, changes no result
    points : (k, d) where the nodes 0, 1, ... are; makes the analysis cheaper, changes no result
    backend : a name of `BACKENDS`, or "auto": see `AUTOMATIC`; the result says which one it was
    plans : keeps what depends on the pattern alone for the next matrix, where the back end can

    Raises
    ------
    InputError
        If the arguments do not fit, or the back end is unknown.
    NotPositiveDefinite
        If the interior is singular or indefinite; names one unknown that can move.

    Examples
    --------
    Two springs in a row, the left end fixed; the middle is eliminated:

    >>> import numpy as np
    >>> from scipy import sparse
    >>> K = sparse.csr_array(np.array([[4.0, -2.0], [-2.0, 2.0]]))
    >>> factor = factorise(K, [1])
    >>> factor.schur()
    array([[1.]])
    >>> reduced = factor.reduce(np.array([4.0, 0.0]))
    >>> reduced.load
    array([2.])
    >>> reduced.expand(np.array([2.0]))
    array([2., 2.])
    """
    if is_elsewhere(K):
        return K.factorised(interface)
    name = AUTOMATIC if backend == "auto" else backend
    if name not in BACKENDS:
        raise InputError(one_of(backend, ["auto", *BACKENDS], "back end"))
    system = checked_system(K, interface, nodes, points)
    return BACKENDS[name](system) if plans is None or name != AUTOMATIC else multifrontal.factorise(system, plans)
