# SPDX-License-Identifier: BSD-3-Clause
"""Histories of bodies that yield in frictional contact without this package: a judge, and a slow safe solver.

Contact row by row, by the natural map of its law; Newton's method on everything, dense.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.independent_plastic import Array, State, Structure

_NEWTON_ROUNDS = 25
_LEAST_PART = 2e-3  # of a load: where parts would be smaller there is no equilibrium farther on
_TOUCHING = 1e-9  # of the largest force that is tried: pairs that rounding alone keeps apart touch
_BALANCED = 1e-11  # of the largest force


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

    def settled(self, u: Array, acts: Acts) -> Array:
        """Displacements (dofs,) of those of the nodes: modes of cells are in balance."""
        s, own = self.structure, self.structure.inner
        if own.start == own.stop:
            return u
        full = np.concatenate([u, self.u[own]])
        for _ in range(_NEWTON_ROUNDS):
            left = s.forces(s.respond(full, acts.heat, self.state)[0])
            if np.abs(left[own]).max() <= _BALANCED * np.abs(left).max():
                break
            step, part = (
                np.linalg.lstsq(s.tangent(full, acts.heat, self.state)[own, own], left[own], rcond=1e-13)[0],
                1.0,
            )
            while part > _LEAST_PART:
                tried = full.copy()
                tried[own] -= part * step
                if np.linalg.norm(s.forces(s.respond(tried, acts.heat, self.state)[0])[own]) < np.linalg.norm(
                    left[own]
                ):
                    break
                part /= 2
            full = tried
        return full

    def violations(self, u: Array, acts: Acts, *, incremental: bool = True) -> dict[str, float]:
        """How far the next instant is from equilibrium and from the laws; then it is the instant before.

        Parameters
        ----------
        u : displacements of the nodes, or of these and of modes
        acts : what acts
        incremental : whether the law of slip is asked for
        """
        s, load, held = self.structure, acts.force, acts.held
        u = self.settled(u, acts) if len(u) < len(s.T) else u
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
