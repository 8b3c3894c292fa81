# SPDX-License-Identifier: BSD-3-Clause
"""B11: Signorini's problem for the Laplacian, which tests the unilateral solver apart from elasticity.

u = -r^(3/2) sin(3 theta / 2),  Laplace u = 0 above y = 0,
u >= 0,  du/dn >= 0,  u du/dn = 0 on y = 0: contact for x > 0, free for x < 0
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy.sparse as sp
from skfem import Basis, ElementTriP1, ElementTriP2, Functional, MeshTri
from skfem.models.poisson import laplace

from signorini.arrays import Array, BoolArray, IntArray
from signorini.lcp import solve
from signorini.lcp.box import eliminate_free
from signorini.verify.check import Check, checks_of

_OFF = 0.137
"""The end of contact lies inside a cell, on every mesh."""

NUMBERS = (8, 16, 32)
"""Cells over the height of the rectangle, mesh by mesh."""


def scalar_signorini() -> Iterator[Check]:
    """Rates in H1 for linear and quadratic triangles on a rectangle, by the two finest meshes."""
    yield from _rates(NUMBERS)


def scalar_signorini_refined() -> Iterator[Check]:
    """Rates on cells of half the size."""
    yield from _rates(tuple(2 * n for n in NUMBERS))


def _rates(numbers: tuple[int, ...]) -> Iterator[Check]:
    for words, element, rate in (("P1", ElementTriP1(), 1.0), ("P2", ElementTriP2(), 1.5)):
        errors, wrong = np.transpose([_solved(n, element) for n in numbers])
        yield from checks_of(
            f"B11 Signorini for the Laplacian, {words}",
            (f"rate in H1, n = {numbers[-2]} to {numbers[-1]}", np.log2(errors[-2] / errors[-1]), rate, 0.07),
            ("error in H1 / |u|, finest mesh", errors[-1], 0.0, 0.02),
            ("farthest wrong contact from its end, in cells", wrong.max(), 0.0, 1.5),
            source="u in H^(5/2 - eps)",
        )


def _solved(n: int, element: ElementTriP1 | ElementTriP2) -> tuple[float, float]:
    """Relative error in H1, and how far from the end of contact, in cells, a node is in the wrong state."""
    grid = np.linspace(-1.0, 1.0, 2 * n + 1)
    mesh = MeshTri.init_tensor(grid - _OFF / n, np.linspace(0.0, 1.0, n + 1)).with_boundaries(
        {"bottom": lambda x: x[1] == 0.0}
    )
    basis = Basis(mesh, element, intorder=6)
    x, y = basis.doflocs
    bottom = basis.get_dofs("bottom").flatten()
    given = np.setdiff1d(basis.get_dofs().flatten(), bottom[np.abs(x[bottom] + _OFF / n) < 1.0 - 1e-9])
    u = np.where(np.isin(np.arange(basis.N), given), _exact(x, y), 0.0)
    touching = np.setdiff1d(bottom, given)
    free = np.setdiff1d(np.arange(basis.N), given)
    u[free] = _unilateral(laplace.assemble(basis).tocsr()[free], u, free, np.isin(free, touching))
    wrong = np.abs(x[touching])[(u[touching] == 0.0) != (x[touching] > 0.0)]
    field = basis.interpolate(u)
    defect = Functional(lambda w: (w["u"].grad[0] - _slope(w.x)[0]) ** 2 + (w["u"].grad[1] - _slope(w.x)[1]) ** 2)
    size = Functional(lambda w: (_slope(w.x) ** 2).sum(axis=0))
    error = np.sqrt(defect.assemble(basis, u=field) / size.assemble(basis))
    return float(error), float(wrong.max(initial=0.0) * n)


def _unilateral(K: sp.csr_array, u: Array, free: IntArray, touching: BoolArray) -> Array:
    """The free values, those that touch >= 0: an LCP once the others are eliminated."""
    reduced = eliminate_free(K[:, free], K @ u, ~touching)
    assert reduced is not None
    solution = solve(reduced.M, reduced.q)
    assert solution.z is not None, solution.message
    return reduced.back(solution.z)


def _exact(x: Array, y: Array) -> Array:
    r, theta = np.hypot(x, y), np.arctan2(y, x)
    value: Array = -(r**1.5) * np.sin(1.5 * theta)
    return value


def _slope(x: Array) -> Array:
    """Gradient of u, in the shape of x."""
    r, theta = np.hypot(*x), np.arctan2(x[1], x[0])
    return np.stack([-1.5 * np.sqrt(r) * np.sin(0.5 * theta), -1.5 * np.sqrt(r) * np.cos(0.5 * theta)])
