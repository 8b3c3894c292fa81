# SPDX-License-Identifier: BSD-3-Clause
"""Semismooth Newton methods on the min and on the Fischer-Burmeister function, globalised."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator

from signorini.arrays import Array
from signorini.lcp.active import polish
from signorini.lcp.linear import factorised, scaled, with_diagonal
from signorini.lcp.problem import LCP
from signorini.lcp.solution import Attempt, Status


@dataclass(frozen=True, kw_only=True)
class SemismoothNewton:
    """Newton's method for ``Phi(z) = 0`` with Phi_i = min(z_i, w_i) or ``z_i + w_i - sqrt(z_i^2 + w_i^2)``.

    The unknowns are balanced first. A step is accepted by a nonmonotone line search on the Fischer-Burmeister merit
    ``|Phi|^2 / 2``. A min step that is singular or not accepted is replaced by the Fischer-Burmeister step, that by a
    Levenberg-Marquardt step, and every replacement is counted in the note of the attempt.

    Parameters
    ----------
    function : "min" or "fischer-burmeister", the direction tried first
    max_steps : limit on the Newton steps
    memory : merit values that the line search may fall back to
    damping : Levenberg-Marquardt parameter over the norm of Phi

    References
    ----------
    De Luca, Facchinei, Kanzow (2000), A theoretical and numerical comparison of some semismooth algorithms for
    complementarity problems, Computational Optimization and Applications 16:173-205.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> solve([[2.0, 1.0], [1.0, 2.0]], [-5.0, -6.0], method=SemismoothNewton()).status.name
    'SOLVED'
    """

    name: ClassVar[str] = "newton"
    matrices: ClassVar[str] = "P, P0 with regular generalised Jacobians; often more"

    function: Literal["min", "fischer-burmeister"] = "min"
    max_steps: int = 200
    memory: int = 5
    damping: float = 1e-3

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:
        """Solve a problem from z0 to a tolerance, see ``Method.attempt``."""
        if isinstance(problem.M, LinearOperator):
            return Attempt.refused("It needs the entries of M.")
        rows, columns = problem.sizes
        unit = float(np.abs(problem.q / rows).max()) or 1.0
        M, q = scaled(problem.M, 1 / rows, columns), problem.q / rows / unit
        x = np.zeros(problem.n) if z0 is None else z0 / columns / unit
        merits: list[float] = []
        replaced = {"Fischer-Burmeister": 0, "Levenberg-Marquardt": 0}
        ending, step = Status.MAX_ITERATIONS, 0
        for step in range(self.max_steps + 1):
            w = M @ x + q
            merits = [*merits[1 - self.memory :], _merit(x, w)]
            if not np.isfinite(merits[-1]):
                return Attempt(z=None, ending=Status.NONFINITE, iterations=step)
            if merits[-1] <= 1e-30 or problem.residual(np.maximum(x, 0.0) * columns * unit).worst <= 1e-3 * tolerance:
                ending = Status.SOLVED
                break
            following = self._following(M, q, x, w, max(merits), replaced)
            if following is None:
                ending = Status.STAGNATION
                break
            x = following
        z = polish(problem, problem.M, np.maximum(x, 0.0) * columns * unit)[0]
        note = ", ".join(f"{count} {word} steps" for word, count in replaced.items() if count)
        return Attempt(z=z, ending=ending, iterations=step, note=f"Replaced by {note}." if note else "")

    def _following(
        self, M: Any, q: Array, x: Array, w: Array, highest: float, replaced: dict[str, int]
    ) -> Array | None:
        """The next iterate, from the first direction that the line search accepts; None where none is."""
        root = np.hypot(x, w)
        phi = x + w - root
        safe = np.where(root > 0, root, 1.0)
        a = np.where(root > 0, 1 - x / safe, 1 - np.sqrt(0.5))
        b = np.where(root > 0, 1 - w / safe, 1 - np.sqrt(0.5))
        jacobian = _jacobian(M, a, b)
        gradient = jacobian.T @ phi
        if self.function == "min":
            smaller = x <= w
            direction = _newton(_jacobian(M, smaller.astype(float), (~smaller).astype(float)), np.minimum(x, w))
            if direction is not None:
                for length in (1.0, 0.5, 0.1):
                    trial = x + length * direction
                    if _merit(trial, M @ trial + q) <= (1 - 1e-4 * length) * highest:
                        return trial
        direction = _newton(jacobian, phi)
        if direction is not None and gradient @ direction < 0:
            replaced["Fischer-Burmeister"] += self.function == "min"
            accepted = _searched(M, q, x, direction, float(gradient @ direction), highest)
            if accepted is not None:
                return accepted
        replaced["Levenberg-Marquardt"] += 1
        normal = jacobian.T @ jacobian
        weight = self.damping * min(1.0, float(np.linalg.norm(phi)))
        direction = _newton(with_diagonal(normal, np.full(len(q), weight)), gradient)
        if direction is None:
            return None
        return _searched(M, q, x, direction, float(gradient @ direction), highest)


def _searched(M: Any, q: Array, x: Array, direction: Array, slope: float, highest: float) -> Array | None:
    """Armijo's rule against the highest merit remembered."""
    length = 1.0
    while length > 1e-12:
        trial = x + length * direction
        if _merit(trial, M @ trial + q) <= highest + 1e-4 * length * slope:
            return trial
        length *= 0.5
    return None


def _merit(x: Array, w: Array) -> float:
    with np.errstate(over="ignore", invalid="ignore"):
        phi = x + w - np.hypot(x, w)
        return 0.5 * float(phi @ phi)


def _newton(jacobian: Any, phi: Array) -> Array | None:
    inverse = factorised(jacobian)
    direction = None if inverse is None else -inverse(phi)
    return direction if direction is not None and np.isfinite(direction).all() else None


def _jacobian(M: Any, a: Array, b: Array) -> Any:
    """``diag(a) + diag(b) M``."""
    if sp.issparse(M):
        return (sp.diags_array(a) + sp.diags_array(b) @ M).tocsr()
    return np.diag(a) + b[:, None] * M
