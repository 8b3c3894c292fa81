# SPDX-License-Identifier: BSD-3-Clause
"""All solutions of a small problem: every support is tried, the referee of all other methods."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import scipy
import scipy.linalg as la
from numpy.typing import ArrayLike

from signorini.arrays import Array, BoolArray, IntArray, frozen
from signorini.errors import InputError
from signorini.lcp.problem import LCP, read_problem
from signorini.lcp.solution import Attempt, Status

MAX_SIZE = 20  # unknowns: 2^20 supports take seconds
ZERO_TOL = 1e-11  # of the largest value, balanced: less counts as 0
BATCH = 4096  # supports that are solved for at once

MARGIN = 1e-9
"""Of the largest entry of q, balanced: what every support must lack at least for a proof; less may be rounding."""

_MAX_DOUBTFUL = 2000  # supports whose lack a linear programme tells, some milliseconds each
_PROGRAMME_TOL = 1e-10  # what such a programme may miss by


@dataclass(frozen=True, kw_only=True)
class Face:
    """All solutions whose positive components are exactly the support: a point, or the inside of a polyhedron.

    Attributes
    ----------
    support : indices with z_i > 0
    z : (n,) the solution, or one in the inside of the face
    directions : (n, k) orthonormal basis of the directions in which z may move; k = 0 for an isolated point of the face
    """

    support: tuple[int, ...]
    z: Array
    directions: Array

    @property
    def dimension(self) -> int:
        """0 for a point, 1 for an edge or a ray, and so on."""
        return int(self.directions.shape[1])


@dataclass(frozen=True, kw_only=True)
class Enumeration:
    """Solve by trying every support; exponential, offered to n = 20.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> solve([[-1.0]], [-1.0], method=Enumeration()).status.name
    'NO_SOLUTION'
    """

    name: ClassVar[str] = "enumeration"
    matrices: ClassVar[str] = "any, n <= 20"

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:  # noqa: ARG002
        """Solve a problem from z0 to a tolerance, see ``Method.attempt``."""
        if problem.n > MAX_SIZE or problem.dense() is None:
            note = f"It needs the entries of M and n <= {MAX_SIZE}; n is {problem.n}."
            return Attempt.refused(note)
        faces, lack = _faces(problem, only_first=True)
        if faces:
            return Attempt(z=faces[0].z, ending=Status.SOLVED, iterations=2**problem.n)
        margin = _margin(problem, lack)
        words = (
            f"What comes nearest of the 2^{problem.n} supports lacks {margin:.2g} of the largest entry of q, balanced"
        )
        if margin > MARGIN:
            return Attempt(z=None, ending=Status.NO_SOLUTION, iterations=2**problem.n, note=f"{words}.")
        return Attempt(z=None, ending=Status.BREAKDOWN, iterations=2**problem.n, note=f"{words}: no proof.")


def all_solutions(M: Any, q: ArrayLike) -> tuple[Face, ...]:
    """Every solution of ``0 <= z  _|_  M z + q >= 0``, sorted by support; empty where there is none.

    Parameters
    ----------
    M : (n, n) array or sparse matrix, n <= 20
    q : (n,) array

    Raises
    ------
    InputError
        For malformed data, an operator, or n > 20.

    Notes
    -----
    A compiled loop refuses the supports that clearly hold nothing; the regular blocks of the others are solved in
    batches. A singular block is kept where q is in its range and a linear
    program finds a point with z > 0 on the support; the solutions then form a face, given by a point and directions.

    Examples
    --------
    >>> [face.z.tolist() for face in all_solutions([[-1.0]], [1.0])]
    [[0.0], [1.0]]
    >>> line = all_solutions([[1.0, 1.0], [1.0, 1.0]], [-1.0, -1.0])
    >>> [(face.support, face.dimension) for face in line]
    [((0,), 0), ((0, 1), 1), ((1,), 0)]
    """
    problem = read_problem(M, q)
    if problem.n > MAX_SIZE or problem.dense() is None:
        raise InputError(f"has n = {problem.n}; enumeration is offered to n = {MAX_SIZE} with entries", where=("M",))
    return tuple(sorted(_faces(problem, only_first=False)[0], key=lambda face: face.support))


def _balanced(problem: LCP) -> tuple[Array, Array, Array]:
    """M and q in units in which their entries are near 1, and what z is multiplied by to have its own again."""
    rows, columns = problem.sizes
    M = problem.dense()
    assert M is not None
    q = problem.q / rows
    unit = float(np.abs(q).max()) or 1.0
    return M * columns / rows[:, None], q / unit, columns * unit


def _members(masks: IntArray, n: int) -> IntArray:
    """(k, n) Which bits masks have."""
    return np.asarray((masks[:, None] >> np.arange(n)) & 1)


def _margin(problem: LCP, lack: Array) -> float:
    """What every support lacks at least; of those that were not refused at once a linear programme tells it."""
    A, q, _ = _balanced(problem)
    doubtful = np.flatnonzero(lack == 0.0)
    if len(doubtful) > _MAX_DOUBTFUL:
        return 0.0
    told = [_least_lack(A, q, members > 0) for members in _members(doubtful, problem.n)]
    return float(min([*told, lack.min(where=lack > 0.0, initial=np.inf)]))


def _least_lack(A: Array, q: Array, support: BoolArray) -> float:
    """The least s with ``x >= -s`` on a support, ``|A x + q| <= s`` there and ``A x + q >= -s`` elsewhere."""
    columns, size = A[:, support], int(support.sum())
    upper = np.vstack([-columns, columns[support], -np.eye(size)])
    found = scipy.optimize.linprog(
        np.append(np.zeros(size), 1.0),
        A_ub=np.column_stack([upper, -np.ones(len(upper))]),
        b_ub=np.concatenate([q, -q[support], np.zeros(size)]),
        bounds=[(None, None)] * size + [(0.0, None)],
        options={"primal_feasibility_tolerance": _PROGRAMME_TOL, "dual_feasibility_tolerance": _PROGRAMME_TOL},
    )
    return float(found.x[-1]) if found.status == 0 else 0.0


def _faces(problem: LCP, *, only_first: bool) -> tuple[list[Face], Array]:
    """Faces, and what supports lack that hold none at first sight, (2^n,)."""
    from signorini.lcp.screening import screen  # Numba takes longer to import than most problems to solve

    A, q, own = _balanced(problem)
    lack = np.empty(2**problem.n)
    screen(A, q, ZERO_TOL, lack)
    members = _members(np.flatnonzero(lack == 0.0), problem.n)
    sizes = members.sum(axis=1)
    faces = []
    for size in np.unique(sizes):
        remaining = members[sizes == size]
        for k in range(0, len(remaining), BATCH):
            batch = remaining[k : k + BATCH]
            supports = np.nonzero(batch)[1].reshape(len(batch), size)
            for face in _on_supports(A, q, supports):
                directions = la.orth(own[:, None] * face.directions) if face.dimension else face.directions
                faces.append(Face(support=face.support, z=frozen(own * face.z), directions=frozen(directions)))
                if only_first:
                    return faces, lack
    return faces, lack


def _on_supports(A: Array, q: Array, supports: IntArray) -> list[Face]:
    """Faces on supports of one size."""
    size = supports.shape[1]
    none = np.zeros((len(q), 0))
    if size == 0:
        return [Face(support=(), z=np.zeros(len(q)), directions=none)] if (q >= -ZERO_TOL).all() else []
    blocks, right = A[supports[:, :, None], supports[:, None, :]], -q[supports]
    regular = _regular(blocks)
    faces = []
    chosen = np.flatnonzero(regular)
    x = np.linalg.solve(blocks[chosen], right[chosen][:, :, None])[:, :, 0]
    z = np.zeros((len(chosen), len(q)))
    np.put_along_axis(z, supports[chosen], x, axis=1)
    scale = np.maximum(1.0, np.abs(z).max(axis=1))
    fits = (x > ZERO_TOL * scale[:, None]).all(axis=1) & (z @ A.T + q >= -ZERO_TOL * scale[:, None]).all(axis=1)
    faces += [Face(support=tuple(supports[chosen[k]].tolist()), z=z[k], directions=none) for k in np.flatnonzero(fits)]
    singular = np.flatnonzero(~regular)
    for k in singular[_consistent(blocks[singular], right[singular])]:
        face = _singular_face(A, q, supports[k])
        faces += [] if face is None else [face]
    return faces


def _regular(blocks: Array) -> BoolArray:
    """Whether the blocks are regular: by the determinant where it is large for the rows, else by singular values."""
    with np.errstate(divide="ignore"):
        size = np.log(np.linalg.norm(blocks, axis=2)).sum(axis=1)
    regular = np.asarray(np.linalg.slogdet(blocks)[1] > size + np.log(1e-9))
    doubtful = np.flatnonzero(~regular)
    values = np.linalg.svd(blocks[doubtful], compute_uv=False)
    regular[doubtful] = values[:, -1] > 1e-12 * np.maximum(values[:, 0], 1e-300)
    return regular


def _consistent(blocks: Array, right: Array) -> BoolArray:
    """Whether the right-hand sides are in the ranges of the singular blocks."""
    if not len(blocks):
        return np.zeros(0, dtype=bool)
    x = np.linalg.pinv(blocks, rcond=1e-11) @ right[:, :, None]
    error = np.abs(blocks @ x - right[:, :, None]).max(axis=(1, 2))
    return np.asarray(error <= 1e-9 * np.maximum(1.0, np.abs(x).max(axis=(1, 2))))


def _singular_face(A: Array, q: Array, support: IntArray) -> Face | None:
    """A point of the relative inside and the directions that stay on the face; None where no z > 0 is on it.

    The point is the mean of one with the largest least component on the support (at most 1) and, for every other row
    that is 0 there, of one where that row is largest.
    """
    inside, outside = A[np.ix_(support, support)], np.delete(A, support, axis=0)[:, support]
    q_outside = np.delete(q, support)
    size = len(support)
    cost = np.append(np.zeros(size), -1.0)
    upper = np.vstack([np.hstack([-np.eye(size), np.ones((size, 1))]), np.pad(-outside, ((0, 0), (0, 1)))])
    bound = np.concatenate([np.zeros(size), q_outside])
    equal = np.pad(inside, ((0, 0), (0, 1)))
    found = scipy.optimize.linprog(
        cost, A_ub=upper, b_ub=bound, A_eq=equal, b_eq=-q[support], bounds=[(None, None)] * size + [(None, 1)]
    )
    if found.status != 0 or not found.x[-1] > 1e3 * ZERO_TOL:
        return None
    x = found.x[:-1]
    tight, points = [], [x]
    for row, value in zip(outside, q_outside, strict=True):
        if row @ x + value > 1e-7:
            continue
        room = (0, 10 * (1 + np.abs(x).max()))
        most = scipy.optimize.linprog(-row, A_ub=upper[:, :-1], b_ub=bound, A_eq=inside, b_eq=-q[support], bounds=room)
        if most.status == 0 and row @ most.x + value > 1e-7:
            points.append(most.x)
        else:
            tight.append(row)
    x = np.mean(points, axis=0)
    null = la.null_space(np.vstack([inside, *tight]), rcond=1e-11)
    z, directions = np.zeros(len(q)), np.zeros((len(q), null.shape[1]))
    z[support], directions[support] = x, null
    return Face(support=tuple(support.tolist()), z=z, directions=directions)
