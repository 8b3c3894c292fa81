# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that yield in frictional contact without this package: own elements, flow rule, and a slow safe solver.

Dense; symmetric tensors as 3 x 3 matrices, so that no factor of a shear strain is shared; shape functions from
monomials, the flow rule by bisection, its tangents by differences. Only the motions of pairs, B, come from outside.
Nothing is imported but NumPy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
_MIDDLES = [(0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5)]
_CUBE = [(x, y, z) for z in (0, 1) for x, y in _SQUARE]
_TRILINEAR = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
_TETRA = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
_EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
FAMILIES = {
    "quad": (_SQUARE, [(0, 0), (1, 0), (0, 1), (1, 1)]),
    "quad8": (_SQUARE + _MIDDLES, [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (2, 1), (1, 2)]),
    "triangle6": (
        [(0, 0), (1, 0), (0, 1), (0.5, 0), (0.5, 0.5), (0, 0.5)],
        [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)],
    ),
    "hexahedron": (_CUBE, _TRILINEAR),
    "hexahedron20": (
        _CUBE + [(x, y, z) for z in (0, 1) for x, y in _MIDDLES] + [(x, y, 0.5) for x, y in _SQUARE],
        _TRILINEAR
        + [tuple(2 if i == axis else e[i] for i in range(3)) for axis in range(3) for e in _TRILINEAR if not e[axis]],
    ),
    "tetra10": (
        _TETRA + [tuple((a + b) / 2 for a, b in zip(_TETRA[i], _TETRA[j], strict=True)) for i, j in _EDGES],
        [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if i + j + k < 3],
    ),
}
"""Corners of the reference cell, and the monomials that shape functions are made of."""

EYE = np.eye(3)
ROOT32 = 1.5**0.5
_NEWTON_ROUNDS = 25
_LEAST_PART = 2e-3  # of a load: where parts would be smaller there is no equilibrium farther on
_ROUNDING = 2e-15  # of the largest value of a function
_TOUCHING = 1e-9  # of the largest force that is tried: pairs that rounding alone keeps apart touch
_BALANCED = 1e-11  # of the largest force


def rule(family: str, axisymmetric: bool) -> tuple[Array, Array]:
    """Points (q, d) and weights (q,) of a quadrature on the reference cell."""
    if family == "triangle6" and axisymmetric:  # Strang and Fix, of degree 4
        root, other = np.sqrt(10), np.sqrt(38 - 44 * np.sqrt(0.4))
        near, far = (8 - root + other) / 18, (8 - root - other) / 18
        share = (620 + np.sqrt(213125 - 53320 * root)) / 3720, (620 - np.sqrt(213125 - 53320 * root)) / 3720
        at = [[a, b] for x in (near, far) for a, b in ((x, x), (1 - 2 * x, x), (x, 1 - 2 * x))]
        return np.array(at), np.repeat(share, 3) / 2
    if family == "triangle6":
        return np.array([[1, 1], [4, 1], [1, 4]]) / 6, np.full(3, 1 / 6)
    if family == "tetra10":
        near = (5 - np.sqrt(5)) / 20
        return near + (1 - 4 * near) * np.array([[0, 0, 0], *np.eye(3)]), np.full(4, 1 / 24)
    count = {"quad": 2, "hexahedron": 2, "hexahedron20": 3, "quad8": 4 if axisymmetric else 3}[family]
    d = 3 if family.startswith("hexahedron") else 2
    line, share = np.polynomial.legendre.leggauss(count)
    grid = np.stack(np.meshgrid(*[(line + 1) / 2] * d, indexing="ij"), axis=-1).reshape(-1, d)
    weights = np.prod(np.stack(np.meshgrid(*[share / 2] * d, indexing="ij"), axis=-1).reshape(-1, d), axis=1)
    return grid, weights


def powers(at: Array, exponents: list[tuple[int, ...]]) -> Array:
    """Monomials at points, (q, m)."""
    return np.stack([np.prod(at ** np.array(e), axis=1) for e in exponents], axis=1)


def slopes(at: Array, exponents: list[tuple[int, ...]]) -> Array:
    """Gradients of monomials at points, (q, m, d)."""
    found = np.zeros((len(at), len(exponents), at.shape[1]))
    for m, e in enumerate(exponents):
        for k, power in enumerate(e):
            if power:
                lower = tuple(p - (i == k) for i, p in enumerate(e))
                found[:, m, k] = power * np.prod(at ** np.array(lower), axis=1)
    return found


@dataclass(kw_only=True)
class Points:
    """Quadrature points: strains (p, 3, 3) are ``B u``.

    Attributes
    ----------
    B : (p, 3, 3, dofs)
    weights : (p,) volumes
    places : (p, d)
    body : (p,)
    """

    B: Array
    weights: Array
    places: Array
    body: Index


def points(
    nodes: Array, family: str, cells: Index, body: Index, *, kind: str, thickness: float, projected: bool
) -> Points:
    """The points of cells of one family.

    ``projected``: the volume strain is that of the mean over the cell, in quad8 and hexahedron20 of the nearest
    linear function.
    """
    d, (corners, exponents) = nodes.shape[1], FAMILIES[family]
    ring = kind == "axisymmetric"
    at, shares = rule(family, ring)
    inverse = np.linalg.inv(powers(np.array(corners, float), exponents))
    values = powers(at, exponents) @ inverse
    gradients = np.einsum("qmd,mk->qkd", slopes(at, exponents), inverse)
    few = np.column_stack([np.ones(len(at)), at]) if family in ("quad8", "hexahedron20") else np.ones((len(at), 1))
    B = np.zeros((len(cells), len(at), 3, 3, nodes.size))
    weights, places = np.zeros((len(cells), len(at))), np.zeros((len(cells), len(at), d))
    for c, cell in enumerate(cells):
        J = np.einsum("ki,qkj->qij", nodes[cell], gradients)
        g = np.einsum("qkj,qji->qki", gradients, np.linalg.inv(J))
        places[c] = values @ nodes[cell]
        weights[c] = shares * np.abs(np.linalg.det(J)) * (2 * np.pi * places[c][:, 0] if ring else thickness)
        for k, node in enumerate(cell):
            for i in range(d):
                for j in range(d):
                    B[c, :, i, j, d * node + i] += g[:, k, j] / 2
                    B[c, :, j, i, d * node + i] += g[:, k, j] / 2
            if ring:
                B[c, :, 2, 2, d * node] += values[:, k] / places[c][:, 0]
        if projected:
            volume = np.einsum("qiid->qd", B[c])
            mass = few.T @ (weights[c][:, None] * few)
            mean = few @ np.linalg.solve(mass, few.T @ (weights[c][:, None] * volume))
            B[c] += EYE[None, :, :, None] / 3 * (mean - volume)[:, None, None, :]
    flat = len(cells) * len(at)
    return Points(
        B=B.reshape(flat, 3, 3, -1),
        weights=weights.ravel(),
        places=places.reshape(flat, d),
        body=np.repeat(body, len(at)),
    )


@dataclass(kw_only=True)
class Law:
    """One material: moduli, rows (p, Y), the slope beyond them, rows (C, gamma)."""

    E: float
    nu: float
    rows: Array
    beyond: float
    backs: Array

    def limit(self, p: Array) -> Array:
        """Yield stress; infinite of elastic bodies."""
        over = np.maximum(p - self.rows[-1, 0], 0.0)
        return np.interp(p, self.rows[:, 0], self.rows[:, 1]) + (self.beyond * over if self.beyond else 0.0)


@dataclass(kw_only=True)
class State:
    """Plastic strains (p, 3, 3), their sum (p,), back stresses (p, M, 3, 3)."""

    strain: Array
    equivalent: Array
    back: Array


def rooted(f: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Roots of falling functions between low and high, all at once: regula falsi, and halves every third round."""
    low, high = low.copy(), high.copy()
    one, two = f(low), f(high)
    small = _ROUNDING * np.maximum(np.abs(one), np.abs(two))
    for k in range(200):
        with np.errstate(divide="ignore", invalid="ignore"):
            x = (low * two - high * one) / (two - one)
        x = np.where((x > low) & (x < high) & (k % 3 < 2), x, 0.5 * (low + high))
        y = f(x)
        up = y > 0
        same = np.where(up, two * y < 0, one * y < 0)
        two, one = np.where(up & same, two / 2, two), np.where(~up & same, one / 2, one)
        low, one = np.where(up, x, low), np.where(up, y, one)
        high, two = np.where(up, high, x), np.where(up, two, y)
        done = (high - low <= 4e-16 * np.abs(x)) | (np.abs(y) <= small)
        low, high = np.where(np.abs(y) <= small, x, low), np.where(np.abs(y) <= small, x, high)
        if done.all():
            break
    return np.where(np.abs(one) < np.abs(two), low, high)


def deviator(t: Array) -> Array:
    """Of tensors (p, 3, 3)."""
    return t - np.trace(t, axis1=1, axis2=2)[:, None, None] * EYE / 3


def size(t: Array) -> Array:
    """Norms of tensors (..., 3, 3)."""
    return np.sqrt((t**2).sum(axis=(-2, -1)))


def in_body(law: Law, strain: Array, old: State) -> tuple[Array, State]:
    """Stresses of total strains (p, 3, 3) and the state behind them: backward Euler."""
    G, bulk = law.E / 2 / (1 + law.nu), law.E / 3 / (1 - 2 * law.nu)
    trial = 2 * G * deviator(strain - old.strain)
    C, gamma = law.backs[:, 0], law.backs[:, 1]

    def parts(dp: Array, own: slice | NDArray[np.bool_]) -> tuple[Array, Array]:
        theta = 1 / (1 + gamma * dp[:, None])
        xi = trial[own] - np.einsum("pm,pmij->pij", theta, old.back[own])
        return xi, 2 * G + 2 / 3 * theta @ C

    def excess(dp: Array, own: slice | NDArray[np.bool_]) -> Array:
        xi, stiff = parts(dp, own)
        limit = law.limit(old.equivalent[own] + dp)
        return size(xi) - limit / ROOT32 - ROOT32 * stiff * dp

    state = State(strain=old.strain.copy(), equivalent=old.equivalent.copy(), back=old.back.copy())
    flows = excess(np.zeros(len(strain)), slice(None)) > 0
    if flows.any():
        most = (size(trial) + size(old.back).sum(axis=1))[flows] / (ROOT32 * 2 * G)
        dp = rooted(lambda x: excess(x, flows), np.zeros(flows.sum()), most)
        xi, _ = parts(dp, flows)
        step = (ROOT32 * dp / size(xi))[:, None, None] * xi
        theta = 1 / (1 + gamma * dp[:, None])
        state.strain[flows] += step
        state.equivalent[flows] += dp
        state.back[flows] = theta[..., None, None] * (old.back[flows] + 2 / 3 * C[None, :, None, None] * step[:, None])
    stress = 2 * G * deviator(strain - state.strain)
    return stress + bulk * np.trace(strain, axis1=1, axis2=2)[:, None, None] * EYE, state


def in_sheet(law: Law, strain: Array, old: State) -> tuple[Array, State]:
    """The same with the strain across that leaves no stress there."""

    def at(across: Array) -> Array:
        found = strain.copy()
        found[:, 2, 2] = across
        return found

    centre = old.strain[:, 2, 2]
    room = 3 * (size(strain) + size(old.strain) + np.abs(centre)) + 1e-300
    across = rooted(lambda x: -in_body(law, at(x), old)[0][:, 2, 2], centre - room, centre + room)
    return in_body(law, at(across), old)


@dataclass(kw_only=True)
class Structure:
    """Bodies, what holds them, and their pairs.

    Attributes
    ----------
    points, laws : one law a body
    thin : plane stress
    T : (dofs, z) displacements by free unknowns
    pairs : (d, n, dofs) motions of the pairs, normal first
    gap, friction : (n,)
    tied : (n,) pairs that neither open nor slip
    """

    points: Points
    laws: list[Law]
    thin: bool
    T: Array
    pairs: Array
    gap: Array
    friction: Array
    tied: NDArray[np.bool_]

    def untouched(self) -> State:
        """Nothing has flowed."""
        p, most = len(self.points.body), max(len(law.backs) for law in self.laws)
        return State(strain=np.zeros((p, 3, 3)), equivalent=np.zeros(p), back=np.zeros((p, most, 3, 3)))

    def respond(self, u: Array, heat: Array, old: State) -> tuple[Array, State]:
        """Stresses (p, 3, 3) and states at displacements (dofs,) and thermal strains (p,)."""
        return self.at(self.points.B @ u - heat[:, None, None] * EYE, old)

    def at(self, strain: Array, old: State) -> tuple[Array, State]:
        """Stresses (p, 3, 3) and states at strains (p, 3, 3)."""
        stress, new = np.zeros_like(strain), self.untouched()
        for b, law in enumerate(self.laws):
            own, M = self.points.body == b, len(law.backs)
            before = State(strain=old.strain[own], equivalent=old.equivalent[own], back=old.back[own][:, :M])
            stress[own], after = (in_sheet if self.thin else in_body)(law, strain[own], before)
            new.strain[own], new.equivalent[own] = after.strain, after.equivalent
            back = np.zeros_like(new.back[own])
            back[:, :M] = after.back
            new.back[own] = back
        return stress, new

    def forces(self, stress: Array) -> Array:
        """(dofs,) internal forces."""
        found: Array = np.einsum("p,pij,pijd->d", self.points.weights, stress, self.points.B)
        return found

    def tangent(self, u: Array, heat: Array, old: State) -> Array:
        """(dofs, dofs) derivative of the internal forces, by differences of the stresses."""
        strain = self.points.B @ u - heat[:, None, None] * EYE
        K = np.zeros((len(u), len(u)))
        yields = min(law.rows[0, 1] / law.E for law in self.laws)
        h = 1e-6 * min(yields, 1.0)
        for i in range(3):
            for j in range(i + 1):
                if not self.points.B[:, i, j].any():
                    continue
                way = np.zeros((3, 3))
                way[i, j] = way[j, i] = h
                slope = (self.at(strain + way, old)[0] - self.at(strain - way, old)[0]) / (2 * h)
                left = np.einsum("p,pij,pijd->pd", self.points.weights, slope, self.points.B)
                K += left.T @ self.points.B[:, i, j]
        return K

    def dissipation(self, v: Array) -> float:
        """The most that plastic flow can take on a motion (dofs,), infinite where it hardens without end."""
        rate = size(deviator(self.points.B @ v))
        limit = np.empty(len(rate))
        for b, law in enumerate(self.laws):
            endless = law.beyond > 0 or (law.backs[:, 1] == 0).any()
            back = 0.0 if endless or not len(law.backs) else (law.backs[:, 0] / law.backs[:, 1]).sum()
            limit[self.points.body == b] = np.inf if endless else law.rows[-1, 1] + back
        with np.errstate(invalid="ignore"):
            work = np.where(rate > 1e-7 * rate.max(), limit * rate / ROOT32, 0.0)
        return float(self.points.weights @ work)


def projected(q: Array, bound: Array) -> Array:
    """Friction (d - 1, n) brought back to the disks of radius ``bound``."""
    length = np.linalg.norm(q, axis=0)
    return q * np.where(length > bound, bound / np.where(length > 0, length, 1.0), 1.0)


@dataclass(kw_only=True)
class Acts:
    """What acts on a structure.

    Attributes
    ----------
    force : (dofs,)
    held : (dofs,) prescribed displacements
    apart : (d, n) by what the other sides of the pairs move, beyond the displacements: obstacles, overlaps
    heat : (p,) thermal strains
    """

    force: Array
    held: Array
    apart: Array
    heat: Array

    @classmethod
    def none(cls, structure: Structure) -> Acts:
        dofs = len(structure.T)
        heat = np.zeros(len(structure.points.body))
        return cls(force=np.zeros(dofs), held=np.zeros(dofs), apart=np.zeros(structure.pairs.shape[:2]), heat=heat)

    def plus(self, other: Acts, times: float) -> Acts:
        """Both, the other as many times."""
        names = ("force", "held", "apart", "heat")
        return Acts(**{name: getattr(self, name) + times * getattr(other, name) for name in names})

    def towards(self, end: Acts, part: float) -> Acts:
        """What acts on the way to an end."""
        return self.plus(self, -part).plus(end, part)


@dataclass(kw_only=True)
class Follower:
    """A history as it is told, looked at instant by instant: the points follow its displacements by their own law.

    Attributes
    ----------
    structure : bodies and pairs
    stiffness : (dofs, dofs) before anything flows
    u, state, r, acts : of the instant before: displacements (dofs,), points, forces of the pairs (d, n), what acts
    force, length : the largest so far
    """

    structure: Structure
    stiffness: Array
    u: Array
    state: State
    r: Array
    acts: Acts
    force: float = 0.0
    length: float = 0.0

    @classmethod
    def of(cls, structure: Structure) -> Follower:
        """At the beginning, at rest."""
        zero = np.zeros(len(structure.T))
        r = np.zeros(structure.pairs.shape[:2])
        state, acts = structure.untouched(), Acts.none(structure)
        K = structure.tangent(zero, acts.heat, state)
        return cls(structure=structure, stiffness=K, u=zero, state=state, r=r, acts=acts)

    def motion(self, u: Array, acts: Acts) -> Array:
        """(d, n) Of the pairs."""
        return self.structure.pairs @ u + acts.apart

    def violations(self, u: Array, acts: Acts, *, incremental: bool = True) -> dict[str, float]:
        """How far the next instant is from equilibrium and from the laws; then it is the instant before.

        Parameters
        ----------
        u : (dofs,) displacements
        acts : what acts
        incremental : whether the law of slip is asked for
        """
        s, load, held = self.structure, acts.force, acts.held
        stress, state = s.respond(u, acts.heat, self.state)
        inner = s.forces(stress)
        left = s.T.T @ (inner - load)
        d, n = s.pairs.shape[:2]
        BT = s.pairs.reshape(d * n, len(u)) @ s.T
        r = np.linalg.lstsq(BT.T, left, rcond=1e-11)[0]
        noise = 1e-6 * (np.abs(self.stiffness) @ np.abs(u)).max(initial=0.0)  # 1e-13 of it, beside a tolerance of 1e-7
        self.force = max(self.force, np.abs(inner).max(initial=0.0), np.abs(load).max(initial=0.0), noise) or 1.0
        self.length = max(self.length, np.abs(u).max(initial=0.0), np.abs(held).max(initial=0.0)) or 1.0
        lead = u - held
        found = {"equilibrium": np.abs(left - BT.T @ r).max(initial=0.0) / self.force}
        found["supports"] = np.abs(lead - s.T @ np.linalg.lstsq(s.T, lead, rcond=None)[0]).max() / self.length
        motion, before = self.motion(u, acts), self.motion(self.u, self.acts)
        found["ties"] = np.abs(motion[:, s.tied]).max(initial=0.0) / self.length
        loose, self.r, self.acts = ~s.tied, r.reshape(d, n), acts
        r, motion, before, gap, friction = (
            self.r[:, loose],
            motion[:, loose],
            before[:, loose],
            s.gap[loose],
            s.friction[loose],
        )
        r = r / self.force
        gap, slip = (motion[0] + gap) / self.length, (motion - before)[1:] / self.length
        found["penetration"], found["tension"] = (np.maximum(-one, 0).max(initial=0.0) for one in (gap, r[0]))
        found["complementarity"] = np.minimum(gap, r[0]).max(initial=0.0)
        bound = friction * np.maximum(r[0], 0.0)
        found["cone"] = (np.linalg.norm(r[1:], axis=0) - bound).max(initial=0.0)
        if incremental:
            found["slip"] = np.abs(r[1:] - projected(r[1:] - slip, bound)).max(initial=0.0)
        self.u, self.state = u, state
        return {name: max(float(value), 0.0) for name, value in found.items()}

    def follow(self, acts: Acts) -> None:
        """Go on by an increment of its own.

        Raises
        ------
        ArithmeticError
            If none is found.
        """
        u, part = self.reached(acts, parts=1)
        if part < 1.0:
            raise ArithmeticError
        self.violations(u, acts)

    def reached(self, acts: Acts, *, parts: int = 4) -> tuple[Array, float]:
        """Displacements of one increment by backward Euler, and how far along its load they were found, 0 .. 1.

        Newton's method on everything at loads that grow in small parts from those of the instant before; parts that
        fail are halved, and every part starts from the state before the increment.

        Parameters
        ----------
        acts : what acts at its end
        parts : of the load, at least
        """
        u, r, at, part = self.u, self.r, 0.0, 1.0 / parts
        T, K = self.structure.T, self.stiffness
        follows = self.acts.held - acts.held  # elastically, where supports move and pairs do not
        P = self.structure.pairs.reshape(-1, len(u)) if self.structure.gap.size else np.zeros((1, len(u)))
        springs = np.diag(K).mean() * P.T @ P
        moved = -follows + T @ np.linalg.lstsq(T.T @ (K + springs) @ T, T.T @ K @ follows, rcond=None)[0]
        while at < 1.0:
            goal = min(1.0, at + part)
            found = self._solved(self.acts.towards(acts, goal), u + (goal - at) * moved, r)
            if found is None:
                part /= 2
                if part < _LEAST_PART:
                    return u, at
            else:
                (u, r), at, part = found, goal, min(2 * part, 1.0 / parts)
        return u, 1.0

    def _solved(self, acts: Acts, u: Array, r: Array) -> tuple[Array, Array] | None:
        """Displacements and forces of the pairs under what acts, by Newton's method; None where it does not end."""
        s, load = self.structure, acts.force
        d, n = s.pairs.shape[:2]
        P = s.pairs.reshape(d * n, len(u))
        before = self.motion(self.u, self.acts)
        rho = float(np.diag(self.stiffness).mean())
        scale = max(np.abs(load).max(), np.abs(r).max(initial=0.0), np.abs(self.stiffness @ u).max()) or 1.0
        for _ in range(_NEWTON_ROUNDS):
            motion = self.motion(u, acts)
            loose = motion - np.concatenate([-s.gap[None], before[1:]])
            tries = r - rho * np.where(s.tied, motion, loose)
            bound = s.friction * np.maximum(tries[0], 0.0)
            stress, _ = s.respond(u, acts.heat, self.state)
            first = s.T.T @ (s.forces(stress) - load - P.T @ r.ravel())
            law = np.concatenate([np.maximum(tries[:1], 0.0), projected(tries[1:], bound)])
            rows = r - np.where(s.tied, tries, law)
            lack = max(np.abs(first).max(), np.abs(rows).max(initial=0.0))
            if lack <= _BALANCED * scale:
                return u, r
            if not np.isfinite(lack) or np.abs(u).max() > 1e3 * np.abs(s.points.places).max():
                return None
            slopes = self._slopes(tries, bound)
            A = np.block(
                [
                    [s.T.T @ s.tangent(u, acts.heat, self.state) @ s.T, -(P @ s.T).T],
                    [rho * slopes @ P @ s.T, np.eye(d * n) - slopes],
                ]
            )
            try:
                step = np.linalg.solve(A, -np.concatenate([first, rows.ravel()]))
            except np.linalg.LinAlgError:
                return None
            u, r = u + s.T @ step[: s.T.shape[1]], r + step[s.T.shape[1] :].reshape(d, n)
        return None

    def _slopes(self, tries: Array, bound: Array) -> Array:
        """(d n, d n) Derivative of the forces that the law makes of what is tried."""
        d, n = tries.shape
        J = np.zeros((d, n, d, n))
        index, press = np.arange(n), tries[0] >= -_TOUCHING * np.abs(tries).max(initial=0.0)
        J[0, index, 0, index] = press
        length = np.linalg.norm(tries[1:], axis=0)
        slides, safe = length > bound, np.where(length > 0, length, 1.0)
        unit = tries[1:] / safe
        for a in range(d - 1):
            for b in range(d - 1):
                turned = bound / safe * ((a == b) - unit[a] * unit[b])
                J[a + 1, index, b + 1, index] = np.where(slides, turned, float(a == b))
            J[a + 1, index, 0, index] = np.where(slides & press, self.structure.friction * unit[a], 0.0)
        tied = np.flatnonzero(self.structure.tied)
        J[:, tied] = 0.0
        for a in range(d):
            J[a, tied, a, tied] = 1.0
        return J.reshape(d * n, d * n)
