# SPDX-License-Identifier: BSD-3-Clause
"""Frictional contact without this package: own finite elements, Coulomb's law row by row, and every state tried.

Bodies of four-node quadrilaterals or eight-node hexahedra, dense; pairs of nodes, upper on lower or on a rigid floor,
whose normal is the last axis. Nothing is imported but NumPy and SciPy's root finder: what is compared with the package
here shares no line with it.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

Array = NDArray[np.float64]
Index = NDArray[np.int64]

OPEN, STICK, PLUS, MINUS = range(4)


def elasticity(E: float, nu: float, kind: str) -> Array:
    """Hooke's law, strains in the order xx, yy, (zz,) and the shears."""
    lame, shear = E * nu / ((1 + nu) * (1 - 2 * nu)), E / 2 / (1 + nu)
    if kind == "plane stress":
        lame = 2 * lame * shear / (lame + 2 * shear)
    d, shears = (3, 3) if kind == "3d" else (2, 1)
    D = np.zeros((d + shears, d + shears))
    D[:d, :d] = lame
    D[range(d), range(d)] += 2 * shear
    D[range(d, d + shears), range(d, d + shears)] = shear
    return D


def element(corners: Array, D: Array) -> Array:
    """Stiffness of one multilinear cell, corners (4, 2) or (8, 3) in the usual order, two Gauss points a direction."""
    d = corners.shape[1]
    square = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    signs = square if d == 2 else np.vstack([np.column_stack([square, np.full(4, s)]) for s in (-1, 1)])
    stiffness = np.zeros((d * len(corners),) * 2)
    for point in itertools.product((-(3**-0.5), 3**-0.5), repeat=d):
        factors = 1 + signs * np.array(point)
        slopes = np.column_stack([signs[:, k] * np.delete(factors, k, axis=1).prod(axis=1) for k in range(d)]) / 2**d
        jacobian = corners.T @ slopes
        slopes = slopes @ np.linalg.inv(jacobian)
        B = np.zeros((len(D), d * len(corners)))
        for k in range(d):
            B[k, k::d] = slopes[:, k]
        for row, (k, m) in enumerate(((0, 1), (1, 2), (0, 2)) if d == 3 else ((0, 1),), start=d):
            B[row, k::d], B[row, m::d] = slopes[:, m], slopes[:, k]
        stiffness += B.T @ D @ B * abs(np.linalg.det(jacobian))
    return stiffness


def stiffness(points: Array, cells: list[tuple[Index, Array]]) -> Array:
    """The stiffness of all cells, given as groups of connectivity and elasticity; thickness 1."""
    d = points.shape[1]
    K = np.zeros((points.size, points.size))
    for connectivity, D in cells:
        for nodes in connectivity:
            rows = (d * nodes[:, None] + np.arange(d)).ravel()
            K[np.ix_(rows, rows)] += element(points[nodes], D)
    return K


@dataclass(kw_only=True)
class Pairs:
    """Pairs of one or several contacts.

    Attributes
    ----------
    upper, lower : (n,) nodes; lower is -1 on the rigid floor, which is at rest
    gap : (n,) initial
    friction : (n,) infinite where they stick
    tied : (n,) whether they neither open nor slip
    """

    upper: Index
    lower: Index
    gap: Array
    friction: Array
    tied: NDArray[np.bool_]


@dataclass(kw_only=True)
class Structure:
    """Bodies, what holds them, and where they may touch.

    Attributes
    ----------
    points : (N, d)
    K : (N d, N d)
    held : (N, d) what supports prescribe
    rigid : nodes of rigid bodies with the point about which each turns, loaded by forces and a moment
    """

    points: Array
    K: Array
    held: NDArray[np.bool_]
    pairs: Pairs
    rigid: list[tuple[Index, Array]] = field(default_factory=list)

    @property
    def d(self) -> int:
        return self.points.shape[1]

    def relative(self, u: Array) -> Array:
        """(n, d) motion of the upper nodes less that of the lower ones."""
        lower = np.where(self.pairs.lower[:, None] >= 0, u[self.pairs.lower], 0.0)
        return u[self.pairs.upper] - lower

    def modes(self, nodes: Index, about: Array) -> Array:
        """(k, N d) rigid motions of some nodes: translations, then rotations."""
        arms = self.points[nodes] - about
        found = []
        for k in range(self.d):
            u = np.zeros_like(self.points)
            u[nodes, k] = 1.0
            found.append(u.ravel())
        for k, m in ((0, 1),) if self.d == 2 else ((1, 2), (2, 0), (0, 1)):
            u = np.zeros_like(self.points)
            u[nodes, k], u[nodes, m] = -arms[:, m], arms[:, k]
            found.append(u.ravel())
        return np.array(found)


@dataclass(kw_only=True)
class Increment:
    """What acts at the end of an increment.

    Attributes
    ----------
    force : (N, d) on the nodes
    moved : (N, d) prescribed displacements, 0 elsewhere
    loads : for every rigid body its forces and moments
    before : (n, d) relative motion of the pairs at the beginning
    """

    force: Array
    moved: Array
    loads: list[Array]
    before: Array


def projected(q: Array, bound: Array) -> Array:
    """Friction (n, d - 1) brought back to the disks of radius ``bound``."""
    size = np.linalg.norm(q, axis=1)
    factor = np.where(size > bound, bound / np.where(size > 0, size, 1.0), 1.0)
    return q * factor[:, None]


def violations(
    structure: Structure, increment: Increment, u: Array, *, incremental: bool = True, length: float = 0.0
) -> dict[str, float]:
    """How far displacements (N, d) are from equilibrium and from the law, in units of the forces and motions at hand.

    Or in those of a length, where motions were larger before.

    The forces of the pairs are what the elements of one side leave unbalanced; no force that a solver tells is used.
    ``incremental`` asks for the direction of slip, which is known where the increment is one.
    """
    s, pairs = structure, structure.pairs
    internal = (s.K @ u.ravel()).reshape(u.shape)
    noise = (np.abs(s.K) @ np.abs(u.ravel())).max(initial=0.0) * 1e-5  # 1e-13 of it, beside a tolerance of 1e-8
    left = internal - increment.force
    in_rigid = np.zeros(len(u), bool)
    for nodes, _ in s.rigid:
        in_rigid[nodes] = True
    upper_tells, lower_tells = ~in_rigid[pairs.upper], (pairs.lower >= 0) & ~in_rigid[pairs.lower]
    P = np.where(upper_tells[:, None], left[pairs.upper], -left[pairs.lower])
    told = upper_tells | lower_tells
    balance = left.copy()
    np.subtract.at(balance, pairs.upper[told], P[told])
    has_lower = told & (pairs.lower >= 0)
    np.add.at(balance, pairs.lower[has_lower], P[has_lower])
    elastic = np.where(s.held | in_rigid[:, None], 0.0, balance)
    force = max(np.abs(left).max(initial=0.0), np.abs(increment.force).max(initial=0.0), noise)
    length = max(
        length, np.abs(u).max(initial=0.0), np.abs(pairs.gap).max(initial=0.0), np.abs(increment.moved).max(initial=0.0)
    )
    force, length = force or 1.0, length or 1.0
    found = {"equilibrium": np.abs(elastic).max(initial=0.0) / force}
    found["supports"] = np.abs(np.where(s.held, u - increment.moved, 0.0)).max(initial=0.0) / length
    for (nodes, about), load in zip(s.rigid, increment.loads, strict=True):
        modes = s.modes(nodes, about)
        own = modes[:, (s.d * nodes[:, None] + np.arange(s.d)).ravel()].T
        own = own / np.abs(own).max(axis=0)
        motion = np.linalg.lstsq(own, u[nodes].ravel(), rcond=None)[0]
        found["rigidity"] = np.abs(own @ motion - u[nodes].ravel()).max() / length
        acting = np.zeros_like(u)
        np.add.at(acting, pairs.upper[told], P[told])
        np.subtract.at(acting, pairs.lower[has_lower], P[has_lower])
        arm = np.ptp(s.points[nodes], axis=0).max()
        unit = np.append(np.ones(s.d), np.full(len(modes) - s.d, arm))
        size = max(force, (np.abs(load) / unit).max())
        found["resultants"] = (np.abs(modes @ acting.ravel() + load) / unit).max() / size
    motion = s.relative(u)
    gap, p, q = motion[:, -1] + pairs.gap, P[:, -1] / force, P[:, :-1] / force
    tied = pairs.tied
    found["ties"] = np.abs(motion[tied]).max(initial=0.0) / length
    free = ~tied & told
    found["penetration"] = np.maximum(-gap[~tied], 0.0).max(initial=0.0) / length
    found["tension"] = np.maximum(-p[free], 0.0).max(initial=0.0)
    found["complementarity"] = np.minimum(gap / length, p)[free].max(initial=0.0)
    with np.errstate(invalid="ignore"):
        bound = np.where(np.isinf(pairs.friction), np.where(p > 1e-9, np.inf, 0.0), pairs.friction * p)
    bound = np.maximum(bound, 0.0)
    found["cone"] = (np.linalg.norm(q, axis=1) - bound)[free].max(initial=0.0)
    if incremental:
        slip = (motion - increment.before)[:, :-1] / length
        found["slip"] = np.linalg.norm(q - projected(q - slip, bound), axis=1)[free].max(initial=0.0)
    return {name: max(float(value), 0.0) for name, value in found.items()}


def carried(structure: Structure, before: Array, after: Array) -> float:
    """How far a motion of bodies through the air is from one: nothing is strained by it, no pair overlaps behind it."""
    s, moved = structure, (after - before).ravel()
    K = unknowns(s)[1]
    strained = np.abs(K @ moved).max() / max((np.abs(K) @ np.abs(moved)).max(), 1e-300)
    gap = (s.relative(after)[:, -1] + s.pairs.gap)[~s.pairs.tied]
    overlap = np.maximum(-gap, 0.0).max(initial=0.0) / max(np.abs(after).max(), np.abs(s.pairs.gap).max())
    return float(max(strained, overlap))


def unknowns(structure: Structure) -> tuple[Array, Array]:
    """(T, K): displacements by free unknowns, those of rigid bodies last, and the stiffness without rigid bodies."""
    s = structure
    free, elastic = ~s.held.ravel(), s.K.copy()
    for nodes, _ in s.rigid:
        rows = (s.d * nodes[:, None] + np.arange(s.d)).ravel()
        free[rows] = False
        elastic[rows] = 0.0
        elastic[:, rows] = 0.0
    return np.hstack([np.eye(s.points.size)[:, free]] + [s.modes(nodes, about).T for nodes, about in s.rigid]), elastic


def directions(structure: Structure) -> Array:
    """B (n d, N d): motions of the pairs by displacements, one direction after the other."""
    s, n = structure, len(structure.pairs.upper)
    B = np.zeros((s.d * n, s.points.size))
    on_body = np.flatnonzero(s.pairs.lower >= 0)
    for k in range(s.d):
        B[k * n + np.arange(n), s.d * s.pairs.upper + k] = 1.0
        B[k * n + on_body, s.d * s.pairs.lower[on_body] + k] -= 1.0
    return B


def regular(stiff: Array) -> tuple[Array, bool]:
    """A scale that makes the diagonal 1, and whether the matrix is positive definite with it."""
    scale = 1.0 / np.sqrt(np.maximum(np.diag(stiff), 1e-300))
    return scale, bool(np.linalg.eigvalsh(stiff * scale[:, None] * scale)[0] > 1e-13)


def floats(structure: Structure) -> bool:
    """Whether something can move though all pairs touch: friction holds where there is some."""
    s = structure
    T, K = unknowns(s)
    rubs = np.concatenate([np.tile(s.pairs.tied | (s.pairs.friction > 0), s.d - 1), np.ones(len(s.pairs.upper), bool)])
    BT = directions(s)[rubs] @ T
    return not regular(T.T @ K @ T + np.abs(np.diag(s.K)).max() * BT.T @ BT)[1]


@dataclass(kw_only=True)
class Condensed:
    """``h = A (h + r) + c`` between the motions h and the forces ``rho r`` of all pairs, one direction after the other.

    Attributes
    ----------
    A : (n d, n d) dimensionless compliance of the bodies with springs rho in all pairs
    c : (n d,) what the loads make of h, initial gaps included
    """

    A: Array
    c: Array
    rho: float


def condensed(structure: Structure, increment: Increment) -> Condensed | None:
    """The linear relation of motions and forces; None where a body is free even if all pairs stick."""
    s, n, d = structure, len(structure.pairs.upper), structure.d
    (T, elastic), B = unknowns(s), directions(s)
    start = np.zeros(d * n)
    start[(d - 1) * n :] = np.where(s.pairs.tied, 0.0, s.pairs.gap)
    rho = float(np.abs(np.diag(s.K)).max())
    moved = increment.moved.ravel()
    BT = B @ T
    stiff = T.T @ elastic @ T + rho * BT.T @ BT
    scale, held = regular(stiff)
    if not held:
        return None
    stiff = stiff * scale[:, None] * scale
    loads = increment.force.ravel() - elastic @ moved
    right = T.T @ loads
    if s.rigid:
        right[-sum(len(load) for load in increment.loads) :] += np.concatenate(increment.loads)
    solve = np.linalg.solve(stiff, (scale[:, None] * np.column_stack([BT.T, right - rho * BT.T @ (B @ moved)])))
    answer = BT @ (scale[:, None] * solve)
    A, u0 = rho * answer[:, :-1], answer[:, -1] + B @ moved
    return Condensed(A=A, c=u0 + start - A @ start, rho=rho)


def equilibria(structure: Structure, increment: Increment, *, tolerance: float = 1e-9) -> list[tuple[Array, Array]]:
    """All regular equilibria of an increment in the plane, (h, r) each (2 n,): every combination of states is solved.

    Raises
    ------
    ValueError
        In space, or with more than 6 pairs that are not tied.
    """
    s, n = structure, len(structure.pairs.upper)
    loose = np.flatnonzero(~s.pairs.tied)
    if s.d != 2 or len(loose) > 6:
        raise ValueError("states are tried in the plane for up to 6 pairs")
    relation = condensed(s, increment)
    if relation is None:
        return []
    states = np.full((4 ** len(loose), n), STICK)
    states[:, loose] = np.array(list(itertools.product(range(4), repeat=len(loose))))
    stuck = np.isinf(s.pairs.friction)
    states = states[~((states == PLUS) | (states == MINUS))[:, stuck].any(axis=1)]
    mu = np.where(stuck, 0.0, s.pairs.friction)
    before = increment.before[:, 0].copy()
    # unknowns h_t, h_n, r_t, r_n; two rows a pair say what the state does, two what the bodies do
    systems = np.zeros((len(states), 4 * n, 4 * n))
    right = np.zeros((len(states), 4 * n))
    systems[:, : 2 * n, : 2 * n] = np.eye(2 * n) - relation.A
    systems[:, : 2 * n, 2 * n :] = -relation.A
    right[:, : 2 * n] = relation.c
    pair = np.arange(n)
    closed, sticks = states != OPEN, states == STICK
    row_n, row_t = 2 * n + pair, 3 * n + pair
    systems[:, row_n, n + pair] = closed
    systems[:, row_n, 3 * n + pair] = ~closed
    systems[:, row_t, pair] = sticks
    systems[:, row_t, 2 * n + pair] = ~sticks
    sign = np.where(states == PLUS, -1.0, np.where(states == MINUS, 1.0, 0.0))
    systems[:, row_t, 3 * n + pair] = -sign * mu
    right[:, 3 * n :] = np.where(sticks, np.where(s.pairs.tied, 0.0, before), 0.0)
    well_posed = np.linalg.svd(systems, compute_uv=False)[:, -1] > 1e-11
    states, x = states[well_posed], np.linalg.solve(systems[well_posed], right[well_posed][..., None])[..., 0]
    h_t, h_n, r_t, r_n = (x[:, k * n : (k + 1) * n] for k in range(4))
    size = np.maximum(np.abs(x).max(axis=1), np.abs(s.pairs.gap).max(initial=0.0))[:, None] * tolerance
    slip = h_t - before
    good = (h_n >= -size) & (r_n >= -size) & (np.abs(r_t) <= mu * r_n + size)
    good |= stuck & (h_n >= -size) & (r_n >= -size)
    moving = ((states == PLUS) & (slip >= -size)) | ((states == MINUS) & (slip <= size)) | (states <= STICK)
    found = (good & moving) | s.pairs.tied
    kept: list[tuple[Array, Array]] = []
    for values, fits in zip(x, found.all(axis=1), strict=True):
        if fits and not any(np.abs(values - np.append(h, r)).max() <= 1e-7 * np.abs(values).max() for h, r in kept):
            kept.append((values[: 2 * n], values[2 * n :]))
    return kept


def searched(structure: Structure, increment: Increment, rng: np.random.Generator, *, starts: int = 30) -> Array | None:
    """Motions and forces (2 n d,) of an equilibrium, in space as in the plane, by Newton's method from many starts."""
    s, n = structure, len(structure.pairs.upper)
    relation = condensed(s, increment)
    if relation is None:
        return None
    d, tied = s.d, s.pairs.tied
    mu = np.where(np.isinf(s.pairs.friction), 1e6, s.pairs.friction)
    before = increment.before.T[:-1]
    size = np.abs(relation.c).max() or 1.0

    def parts(x: Array) -> tuple[Array, Array]:
        """Motions and forces from one unknown, of which both are affine functions: r + h."""
        h = relation.A @ x + relation.c / size
        return h.reshape(d, n), (x - h).reshape(d, n)

    def wrong(x: Array) -> Array:
        h, r = parts(x)
        slip = h[:-1] - before / size
        q = projected((r[:-1] - slip).T, mu * np.maximum(r[-1] - h[-1], 0.0)).T
        rows = np.vstack([r[:-1] - q, np.minimum(h[-1], r[-1])])
        return np.where(tied, h, rows).ravel()

    for _ in range(starts):
        found = root(wrong, rng.normal(size=d * n), method="hybr", options={"xtol": 1e-13})
        if np.abs(wrong(found.x)).max() < 1e-10 and np.abs(found.x).max() < 1e4:  # beyond, rounding balances anything
            h, r = parts(found.x)
            return size * np.append(h.ravel(), r.ravel())
    return None
