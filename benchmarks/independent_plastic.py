# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that yield without this package: own elements and flow rule; with contact in `independent_history`.

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
_CUBE20 = _CUBE + [(x, y, z) for z in (0, 1) for x, y in _MIDDLES] + [(x, y, 0.5) for x, y in _SQUARE]
_FACES = [(0, 0.5, 0.5), (1, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 1, 0.5), (0.5, 0.5, 0), (0.5, 0.5, 1)]
_TRIANGLE = [(0, 0), (1, 0), (0, 1)]
_SIDES = [(0.5, 0), (0.5, 0.5), (0, 0.5)]
_TETRA = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
_EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
FAMILIES = {
    "quad": (_SQUARE, [(0, 0), (1, 0), (0, 1), (1, 1)]),
    "quad8": (_SQUARE + _MIDDLES, [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (2, 1), (1, 2)]),
    "quad9": (_SQUARE + _MIDDLES + [(0.5, 0.5)], [(i, j) for i in range(3) for j in range(3)]),
    "triangle6": (_TRIANGLE + _SIDES, [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]),
    "hexahedron": (_CUBE, _TRILINEAR),
    "hexahedron20": (
        _CUBE20,
        _TRILINEAR
        + [tuple(2 if i == axis else e[i] for i in range(3)) for axis in range(3) for e in _TRILINEAR if not e[axis]],
    ),
    "hexahedron27": (
        _CUBE20 + _FACES + [(0.5, 0.5, 0.5)],
        [(i, j, k) for i in range(3) for j in range(3) for k in range(3)],
    ),
    "wedge15": (
        [(x, y, z) for part in (_TRIANGLE, _SIDES) for z in (0, 1) for x, y in part]
        + [(x, y, 0.5) for x, y in _TRIANGLE],
        [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if i + j < 3 and (k < 2 or i + j < 2)],
    ),
    "tetra10": (
        _TETRA + [tuple((a + b) / 2 for a, b in zip(_TETRA[i], _TETRA[j], strict=True)) for i, j in _EDGES],
        [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if i + j + k < 3],
    ),
}
"""Corners of the reference cell, and the monomials that shape functions are made of."""

EYE = np.eye(3)
ROOT32 = 1.5**0.5
_REWEIGHTED = 60  # rounds of least squares for the least sum of sizes
_QUADRATIC = ("quad8", "quad9", "hexahedron20", "hexahedron27")  # whose mean dilatation is the nearest linear function
_ROUNDING = 2e-15  # of the largest value of a function


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
    if family == "wedge15":  # Radon's points of degree 5, and Gauss's three along the height
        root, third = np.sqrt(15), [[1 / 3, 1 / 3]]
        near, far = (6 - root) / 21, (6 + root) / 21
        flat = np.array(third + [[a, b] for x in (near, far) for a, b in ((x, x), (1 - 2 * x, x), (x, 1 - 2 * x))])
        share = np.array([9 / 80, *[(155 - root) / 2400] * 3, *[(155 + root) / 2400] * 3])
        line, part = np.polynomial.legendre.leggauss(3)
        at = np.column_stack([np.repeat(flat, 3, axis=0), np.tile((line + 1) / 2, len(flat))])
        return at, np.outer(share, part / 2).ravel()
    count = 2 if family in ("quad", "hexahedron") else 4 if axisymmetric else 3
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
    B : (p, 3, 3, dofs) displacements of the nodes, then amplitudes of the modes that cells have of their own
    weights : (p,) volumes
    places : (p, d)
    body : (p,)
    """

    B: Array
    weights: Array
    places: Array
    body: Index


def points(
    nodes: Array, family: str, cells: Index, body: Index, *, kind: str, thickness: float, formulation: str
) -> Points:
    """The points of cells of one family.

    With a mean dilatation the volume strain is that of the mean over the cell, in quadratic quadrilaterals and
    hexahedra of the nearest linear function. Incompatible modes are those of Taylor, Beresford and Wilson (1976) less
    their mean strain.
    """
    d, (corners, exponents) = nodes.shape[1], FAMILIES[family]
    ring = kind == "axisymmetric"
    at, shares = rule(family, ring)
    inverse = np.linalg.inv(powers(np.array(corners, float), exponents))
    values = powers(at, exponents) @ inverse
    gradients = np.einsum("qmd,mk->qkd", slopes(at, exponents), inverse)
    few = np.column_stack([np.ones(len(at)), at]) if family in _QUADRATIC else np.ones((len(at), 1))
    own = d * d if formulation == "incompatible" else 0
    B = np.zeros((len(cells), len(at), 3, 3, nodes.size + own * len(cells)))
    weights, places = np.zeros((len(cells), len(at))), np.zeros((len(cells), len(at), d))
    for c, cell in enumerate(cells):
        J = np.einsum("ki,qkj->qij", nodes[cell], gradients)
        g = np.einsum("qkj,qji->qki", gradients, np.linalg.inv(J))
        places[c] = values @ nodes[cell]
        weights[c] = shares * np.abs(np.linalg.det(J)) * (2 * np.pi * places[c][:, 0] if ring else thickness)
        first = d * cell
        if own:
            centre = J.mean(axis=0)
            bent = np.einsum("qk,kj->qkj", -4.0 * (2.0 * at - 1.0), np.linalg.inv(centre))
            bent *= (np.linalg.det(centre) / np.linalg.det(J))[:, None, None]
            g = np.concatenate([g, bent - np.average(bent, axis=0, weights=weights[c])], axis=1)
            first = np.concatenate([first, nodes.size + own * c + d * np.arange(d)])
        for k, row in enumerate(first):
            for i in range(d):
                for j in range(d):
                    B[c, :, i, j, row + i] += g[:, k, j] / 2
                    B[c, :, j, i, row + i] += g[:, k, j] / 2
        if ring:
            for k, node in enumerate(cell):
                B[c, :, 2, 2, d * node] += values[:, k] / places[c][:, 0]
        if formulation == "mean dilatation":
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
    """One material.

    Attributes
    ----------
    E, nu, expansion : elastic
    tables : rows (p, Y), one table a temperature
    temperatures : of the tables, increasing
    beyond : slope behind their last rows
    backs : rows (C, gamma)
    """

    E: float
    nu: float
    expansion: float
    tables: list[Array]
    temperatures: Array
    beyond: float
    backs: Array

    def limit(self, p: Array, warm: Array) -> Array:
        """Yield stress at plastic strains and temperatures (p,); infinite of elastic bodies."""
        curves = [np.interp(p, *rows.T) for rows in self.tables]
        if self.beyond:
            curves = [
                Y + self.beyond * np.maximum(p - rows[-1, 0], 0.0) for Y, rows in zip(curves, self.tables, strict=True)
            ]
        if len(curves) == 1:
            return curves[0]
        place = np.interp(warm, self.temperatures, np.arange(len(curves)))
        low = np.minimum(place.astype(int), len(curves) - 2)
        every, point = np.stack(curves), np.arange(len(p))
        found: Array = every[low, point] * (low + 1 - place) + every[low + 1, point] * (place - low)
        return found

    def warm(self, heat: Array) -> Array:
        """Temperatures (p,) of thermal strains."""
        return heat / self.expansion if self.expansion else np.zeros_like(heat)


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


def in_body(law: Law, strain: Array, warm: Array, old: State) -> tuple[Array, State]:
    """Stresses of strains (p, 3, 3) at temperatures (p,) and the state behind them: backward Euler."""
    G, bulk = law.E / 2 / (1 + law.nu), law.E / 3 / (1 - 2 * law.nu)
    trial = 2 * G * deviator(strain - old.strain)
    C, gamma = law.backs[:, 0], law.backs[:, 1]

    def parts(dp: Array, own: slice | NDArray[np.bool_]) -> tuple[Array, Array]:
        theta = 1 / (1 + gamma * dp[:, None])
        xi = trial[own] - np.einsum("pm,pmij->pij", theta, old.back[own])
        return xi, 2 * G + 2 / 3 * theta @ C

    def excess(dp: Array, own: slice | NDArray[np.bool_]) -> Array:
        xi, stiff = parts(dp, own)
        limit = law.limit(old.equivalent[own] + dp, warm[own])
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


def in_sheet(law: Law, strain: Array, warm: Array, old: State) -> tuple[Array, State]:
    """The same with the strain across that leaves no stress there."""

    def at(across: Array) -> Array:
        found = strain.copy()
        found[:, 2, 2] = across
        return found

    centre = old.strain[:, 2, 2]
    room = 3 * (size(strain) + size(old.strain) + np.abs(centre)) + 1e-300
    across = rooted(lambda x: -in_body(law, at(x), warm, old)[0][:, 2, 2], centre - room, centre + room)
    return in_body(law, at(across), warm, old)


@dataclass(kw_only=True)
class Structure:
    """Bodies, what holds them, and their pairs.

    Attributes
    ----------
    points, laws : one law a body
    thin : plane stress
    T : (dofs, z) displacements by free unknowns
    inner : dofs that are amplitudes of modes
    pairs : (d, n, dofs) motions of the pairs, normal first
    gap, friction : (n,)
    tied : (n,) pairs that neither open nor slip
    """

    points: Points
    laws: list[Law]
    thin: bool
    T: Array
    inner: slice
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
        return self.at(self.points.B @ u - heat[:, None, None] * EYE, heat, old)

    def at(self, strain: Array, heat: Array, old: State) -> tuple[Array, State]:
        """Stresses (p, 3, 3) and states at strains (p, 3, 3) less thermal ones (p,)."""
        stress, new = np.zeros_like(strain), self.untouched()
        for b, law in enumerate(self.laws):
            own, M = self.points.body == b, len(law.backs)
            before = State(strain=old.strain[own], equivalent=old.equivalent[own], back=old.back[own][:, :M])
            stress[own], after = (in_sheet if self.thin else in_body)(law, strain[own], law.warm(heat[own]), before)
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
        yields = min(rows[0, 1] / law.E for law in self.laws for rows in law.tables)
        h = 1e-6 * min(yields, 1.0)
        for i in range(3):
            for j in range(i + 1):
                if not self.points.B[:, i, j].any():
                    continue
                way = np.zeros((3, 3))
                way[i, j] = way[j, i] = h
                slope = (self.at(strain + way, heat, old)[0] - self.at(strain - way, heat, old)[0]) / (2 * h)
                left = np.einsum("p,pij,pijd->pd", self.points.weights, slope, self.points.B)
                K += left.T @ self.points.B[:, i, j]
        return K

    def yielding(self, v: Array, limit: Array) -> Array:
        """A motion whose modes follow: flow below a limit (p,) takes the least of them, with hardly a volume rate."""
        v, G = v.copy(), self.points.B[..., self.inner]
        if not G.shape[-1]:
            return v
        volume = np.trace(G, axis1=1, axis2=2)
        rows = np.concatenate(
            [G - EYE[:, :, None] / 3 * volume[:, None, None], EYE[:, :, None] * volume[:, None, None]]
        )
        share = self.points.weights * np.where(
            np.isfinite(limit), limit / limit[np.isfinite(limit)].max(initial=1.0), 1.0
        )
        for _ in range(_REWEIGHTED):
            rate = self.points.B @ v
            dev, mean = deviator(rate), rate - deviator(rate)
            soft = np.maximum(size(dev), 1e-9 * size(dev).max())
            weight = np.sqrt(np.concatenate([share / soft, share * 1e6 / soft.max()]))
            lead = np.concatenate([dev, 3 * mean])
            A, b = (weight[:, None, None, None] * rows).reshape(-1, G.shape[-1]), (weight[:, None, None] * lead).ravel()
            v[self.inner] -= np.linalg.lstsq(A, b, rcond=None)[0]
        return v

    def dissipation(self, v: Array, heat: Array) -> float:
        """The most that flow can take on a motion (dofs,) at thermal strains (p,), infinite where it hardens on."""
        limit = np.empty(len(heat))
        for b, law in enumerate(self.laws):
            own = self.points.body == b
            endless = law.beyond > 0 or (law.backs[:, 1] == 0).any()
            back = 0.0 if endless or not len(law.backs) else (law.backs[:, 0] / law.backs[:, 1]).sum()
            last = law.limit(np.full(own.sum(), np.inf), law.warm(heat[own])) if not endless else np.inf
            limit[own] = last + back
        rate = size(deviator(self.points.B @ self.yielding(v, limit)))
        with np.errstate(invalid="ignore"):
            work = np.where(rate > 1e-7 * rate.max(), limit * rate / ROOT32, 0.0)
        return float(self.points.weights @ work)
