# SPDX-License-Identifier: BSD-3-Clause
"""SciPy's Krylov methods for a product and a preconditioner that are functions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse.linalg import LinearOperator, cg
from scipy.sparse.linalg import gmres as left_preconditioned_gmres

from signorini.arrays import Array

Map = Callable[[Array], Array]

MAX_PRODUCTS = 80  # of GMRES, all of whose directions are kept: a system that needs more is factorised instead
MAX_ITERATIONS = 400  # of conjugate gradients
MAX_DIRECTIONS = 40  # of conjugate residuals, all of which are kept


def gmres(product: Map, precondition: Map, rhs: Array, tolerance: float) -> Array:
    """Solve ``M x = rhs`` by GMRES without restarts, for systems that a few dozen products solve.

    The preconditioner P stands on the right, ``M P y = rhs`` and ``x = P y``, so that the residual is the system's
    own. Whether 80 products were enough is for the caller to measure, who may know M better than its products.

    Parameters
    ----------
    product : x (n,) to M x
    precondition : y (n,) to P y
    rhs : (n,)
    tolerance : largest ``|M x - rhs|`` to stop at, in units of rhs

    Examples
    --------
    >>> import numpy as np
    >>> M = np.array([[2.0, 1.0], [0.0, 3.0]])
    >>> gmres(lambda x: M @ x, lambda y: y, np.array([3.0, 3.0]), 1e-12).round(12).tolist()
    [1.0, 1.0]
    """
    operator = LinearOperator((len(rhs),) * 2, matvec=lambda y: product(precondition(y)), dtype=rhs.dtype)
    y, _ = left_preconditioned_gmres(operator, rhs, rtol=0.0, atol=tolerance, restart=MAX_PRODUCTS, maxiter=1)
    return precondition(y)


def conjugate_gradients(product: Map, precondition: Map, rhs: Array, tolerance: float) -> tuple[Array, int]:
    """Solve ``M x = rhs`` by preconditioned conjugate gradients from zero: x and the number of iterations.

    Parameters
    ----------
    product : x (n,) to M x, M symmetric positive definite
    precondition : y (n,) to P y, P likewise
    rhs : (n,)
    tolerance : residual to stop at, relative to rhs

    Examples
    --------
    >>> import numpy as np
    >>> x, iterations = conjugate_gradients(lambda v: 2.0 * v, lambda v: v, np.array([2.0, 4.0]), 1e-12)
    >>> x.tolist(), iterations
    ([1.0, 2.0], 1)
    """
    count = 0

    def counted(_: Array) -> None:
        nonlocal count
        count += 1

    M, P = (LinearOperator((len(rhs),) * 2, matvec=each, dtype=rhs.dtype) for each in (product, precondition))
    x, _ = cg(M, rhs, rtol=tolerance, maxiter=MAX_ITERATIONS, M=P, callback=counted)
    return x, count


def conjugate_residuals(product: Map, precondition: Map, rhs: Array, tolerance: float) -> tuple[Array, int]:
    """Solve ``M x = rhs`` by generalised conjugate residuals from zero, M of any kind: x and the number of iterations.

    The residual is the least that directions ``P r`` allow, with r what is left. So the preconditioner P may be rough
    in its last digits, as one in single precision is: x is the sum of directions whose products are known.

    Parameters
    ----------
    product : x (n,) to M x
    precondition : y (n,) to P y
    rhs : (n,)
    tolerance : residual to stop at, relative to rhs; after 40 iterations what is left is for the caller to judge

    References
    ----------
    Eisenstat, Elman, Schultz (1983), Variational iterative methods for nonsymmetric systems of linear equations, SIAM
    J. Numer. Anal. 20:345-357.

    Examples
    --------
    >>> import numpy as np
    >>> M = np.array([[2.0, 1.0], [0.0, 3.0]])
    >>> x, iterations = conjugate_residuals(lambda x: M @ x, lambda y: y, np.array([4.0, 6.0]), 1e-12)
    >>> x.round(12).tolist(), iterations
    ([1.0, 2.0], 2)
    """
    x, left = np.zeros_like(rhs), rhs.copy()
    aim = tolerance * float(np.linalg.norm(rhs))
    directions: list[Array] = []
    products: list[Array] = []
    while len(products) < MAX_DIRECTIONS and float(np.linalg.norm(left)) > aim:
        z = np.array(precondition(left))  # its own: it is changed
        q = product(z)
        for direction, known in zip(directions, products, strict=True):
            share = float(known @ q)
            q -= share * known
            z -= share * direction
        size = float(np.linalg.norm(q))
        if not size > 0.0 or not np.isfinite(size):
            break
        q /= size
        z /= size
        share = float(q @ left)
        x += share * z
        left -= share * q
        directions.append(z)
        products.append(q)
    return x, len(products)
