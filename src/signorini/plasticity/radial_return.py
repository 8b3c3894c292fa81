# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops of the flow rule at points: backward Euler by radial return.

Strains xx, yy, zz, xy (yz, xz) with shear strains twice the tensor's; stresses as tensors. In plane stress the strain
across is found that leaves no stress there.

References
----------
Simo, Hughes (1998), Computational Inelasticity, boxes 3.1, 3.2; Chaboche (1986), Int. J. Plasticity 2:149.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from signorini.arrays import Array, BoolArray, IntArray
from signorini.compilation import kernel, part
from signorini.plasticity.laws import Heat, YieldLaws, stress_in_row, yield_stress_at

ROOT23, ROOT32 = np.sqrt(2.0 / 3.0), np.sqrt(1.5)

_RETURN_TOL = 1e-14  # of the radius: rounding of the sums it is made of
_RETURN_ROUNDS = 60  # of Newton's method with bisection in a bracket: the last resort of 1e-18
_ACROSS_TOL = 1e-14  # of the bulk modulus times the strain: stress across that plane stress may leave
_ACROSS_ROUNDS = 40  # of Newton's method for the strain across; 3 to 6 are the rule


class Points(NamedTuple):
    """What every point has, (p,) or (p, n); n components, M back stresses; written by `respond`.

    Attributes
    ----------
    strain : (p, n) total strain
    plastic : (p, n) plastic strain
    equivalent : (p,) equivalent plastic strain
    back : (p, M, n) back stresses
    direction : (p, n) of the flow, a unit tensor; 0 where nothing flows
    slack : (p, 2) a and b of ``M = 2 G (a I_dev + b n n^T)``
    yields : (p,) whether the point flows
    """

    strain: Array
    plastic: Array
    equivalent: Array
    back: Array
    direction: Array
    slack: Array
    yields: BoolArray

    def part(self, own: slice) -> Points:
        """Some of the points."""
        return Points(
            strain=self.strain[own],
            plastic=self.plastic[own],
            equivalent=self.equivalent[own],
            back=self.back[own],
            direction=self.direction[own],
            slack=self.slack[own],
            yields=self.yields[own],
        )


@njit(cache=True, inline="always", error_model="numpy")
def _growth(
    laws: YieldLaws, body: int, level: float, old: Points, i: int, norm: float, trial: Array, turn: Array
) -> tuple[float, float, float]:
    """Growth dp of the equivalent plastic strain, size of the relative stress before it (``turn``), slope of F.

    ``F(dp) = |trial - sum theta X| - sqrt(2/3) Y(p + dp) - sqrt(3/2) (2G + 2/3 sum theta C) dp`` falls: Newton's method
    within a bracket; ``norm`` is the size of the trial stress less the back stresses.
    """
    n, M, G2, p0 = len(trial), old.back.shape[1], 2.0 * laws.shear[body], old.equivalent[i]
    dp, low, high, slope = 0.0, 0.0, norm / (ROOT32 * G2), 1.0
    for _ in range(_RETURN_ROUNDS):
        stiff, taken = G2, 0.0
        for c in range(n):
            turn[c] = trial[c]
        lean = 0.0
        for k in range(M):
            theta = 1.0 / (1.0 + laws.recovery[body, k] * dp)
            stiff += 2.0 / 3.0 * theta * laws.back[body, k]
            taken += 2.0 / 3.0 * laws.back[body, k] * laws.recovery[body, k] * theta * theta
            for c in range(n):
                turn[c] -= theta * old.back[i, k, c]
        norm = 0.0
        for c in range(n):
            norm += turn[c] * turn[c] * (1.0 if c < 3 else 2.0)
        norm = np.sqrt(norm)
        for k in range(M):
            theta = 1.0 / (1.0 + laws.recovery[body, k] * dp)
            for c in range(n):
                weight = 1.0 if c < 3 else 2.0
                lean += weight * turn[c] / norm * laws.recovery[body, k] * theta * theta * old.back[i, k, c]
        stress, hardening = yield_stress_at(laws, body, p0 + dp, level)
        missing = norm - ROOT23 * stress - ROOT32 * stiff * dp
        slope = ROOT23 * hardening + ROOT32 * stiff - ROOT32 * taken * dp - lean
        if abs(missing) <= 4.0 * _RETURN_TOL * (norm + stress):
            break
        if missing > 0.0:
            low = dp
        else:
            high = dp
        following = dp + missing / slope
        dp = following if low < following < high else 0.5 * (low + high)
    return dp, norm, slope


@njit(cache=True, inline="always", error_model="numpy")
def _return(
    laws: YieldLaws, body: int, level: float, old: Points, i: int, new: Points, trial: Array, turn: Array
) -> None:
    """Backward Euler at point i from the old state to the strain of the new one; ``trial``, ``turn``: room."""
    n, M, G2 = new.strain.shape[1], new.back.shape[1], 2.0 * laws.shear[body]
    e = new.strain[i]
    mean = (e[0] + e[1] + e[2]) / 3.0
    for c in range(n):
        trial[c] = G2 * (e[c] - mean - old.plastic[i, c]) if c < 3 else 0.5 * G2 * (e[c] - old.plastic[i, c])
        new.plastic[i, c] = old.plastic[i, c]
        new.direction[i, c] = 0.0
        for k in range(M):
            new.back[i, k, c] = old.back[i, k, c]
    p0 = old.equivalent[i]
    new.equivalent[i], new.yields[i], new.slack[i, 0], new.slack[i, 1] = p0, False, 0.0, 0.0
    norm = 0.0
    for c in range(n):
        x = trial[c]
        for k in range(M):
            x -= old.back[i, k, c]
        norm += x * x * (1.0 if c < 3 else 2.0)
    norm = np.sqrt(norm)
    stress, _ = yield_stress_at(laws, body, p0, level)
    if norm <= ROOT23 * stress * (1.0 + _RETURN_TOL):
        return
    dp, norm, slope = _growth(laws, body, level, old, i, norm, trial, turn)
    new.equivalent[i], new.yields[i] = p0 + dp, True
    new.slack[i, 0] = G2 * ROOT32 * dp / norm
    new.slack[i, 1] = G2 * ROOT32 / slope - new.slack[i, 0]
    for c in range(n):
        way = turn[c] / norm
        new.direction[i, c] = way
        new.plastic[i, c] = old.plastic[i, c] + ROOT32 * dp * way * (1.0 if c < 3 else 2.0)
        for k in range(M):
            theta = 1.0 / (1.0 + laws.recovery[body, k] * dp)
            step = 2.0 / 3.0 * laws.back[body, k] * ROOT32 * dp * way
            new.back[i, k, c] = theta * (old.back[i, k, c] + step)


@part()
def _stay(laws: YieldLaws, body: IntArray, level: Array, old: Points, new: Points, stays: BoolArray) -> None:
    """Which points stay elastic, and their states: most of them, so without a call for each."""
    strain, plastic, back = new.strain, old.plastic, old.back
    n, M = strain.shape[1], back.shape[1]
    for i in range(len(body)):
        j, norm = body[i], 0.0
        G2, mean = 2.0 * laws.shear[j], (strain[i, 0] + strain[i, 1] + strain[i, 2]) / 3.0
        for c in range(n):
            x = G2 * (strain[i, c] - mean - plastic[i, c]) if c < 3 else 0.5 * G2 * (strain[i, c] - plastic[i, c])
            for k in range(M):
                x -= back[i, k, c]
                new.back[i, k, c] = back[i, k, c]
            norm += x * x * (1.0 if c < 3 else 2.0)
            new.plastic[i, c], new.direction[i, c] = plastic[i, c], 0.0
        p = old.equivalent[i]
        stress, _ = yield_stress_at(laws, j, p, level[i])
        new.equivalent[i], new.slack[i, 0], new.slack[i, 1], new.yields[i] = p, 0.0, 0.0, False
        stays[i] = np.sqrt(norm) <= ROOT23 * stress * (1.0 + _RETURN_TOL)


@part()
def _without_back_stresses(laws: YieldLaws, body: IntArray, level: Array, old: Points, new: Points) -> None:
    """The states of all points where yield stresses alone harden: exact row by row, without a call for each point."""
    strain, plastic, direction, slack = new.strain, new.plastic, new.direction, new.slack
    rows, begin, table, beyond, before = laws.rows, laws.strain, laws.stress, laws.beyond, old.plastic
    n = strain.shape[1]
    for i in range(len(body)):
        j, p0 = body[i], old.equivalent[i]
        G2, mean = 2.0 * laws.shear[j], (strain[i, 0] + strain[i, 1] + strain[i, 2]) / 3.0
        square = 0.0
        for c in range(n):
            x = G2 * (strain[i, c] - mean - before[i, c]) if c < 3 else 0.5 * G2 * (strain[i, c] - before[i, c])
            direction[i, c] = x
            square += x * x * (1.0 if c < 3 else 2.0)
        norm, row, last = np.sqrt(square), 0, rows[j] - 1
        while row < last and p0 >= begin[j, row + 1]:
            row += 1
        dp, slope = 0.0, 1.0
        while True:
            hardening, stress = beyond[j], stress_in_row(table, j, row, level[i])
            if row < last:
                hardening = (stress_in_row(table, j, row + 1, level[i]) - stress) / (begin[j, row + 1] - begin[j, row])
            radius = ROOT23 * (stress + hardening * (p0 - begin[j, row]))
            slope = ROOT23 * hardening + ROOT32 * G2
            dp = (norm - radius) / slope
            if row == last or p0 + dp < begin[j, row + 1]:
                break
            row += 1
        yields = norm > radius * (1.0 + _RETURN_TOL)
        new.yields[i] = yields
        if not yields:
            new.equivalent[i], slack[i, 0], slack[i, 1] = p0, 0.0, 0.0
            for c in range(n):
                direction[i, c], plastic[i, c] = 0.0, before[i, c]
            continue
        new.equivalent[i] = p0 + dp
        slack[i, 0] = G2 * ROOT32 * dp / norm
        slack[i, 1] = G2 * ROOT32 / slope - slack[i, 0]
        over, length = 1.0 / norm, ROOT32 * dp
        for c in range(n):
            way = direction[i, c] * over
            direction[i, c] = way
            plastic[i, c] = before[i, c] + length * way * (1.0 if c < 3 else 2.0)


@part()
def respond_at(
    laws: YieldLaws,
    body: int,
    swelling: float,
    level: float,
    old: Points,
    new: Points,
    i: int,
    trial: Array,
    turn: Array,
) -> None:
    """The state of point i, see `respond`.

    Parameters
    ----------
    laws, body, swelling, level : material data; body, volume strain and place of the temperature of the point
    old, new : states of all points
    i : the point
    trial, turn : (n,) room
    """
    G2, K, e = 2.0 * laws.shear[body], laws.bulk[body], new.strain[i]
    size = abs(e[0]) + abs(e[1]) + abs(e[3]) + abs(swelling) + abs(old.plastic[i, 2])
    low, high = -np.inf, np.inf
    for _ in range(_ACROSS_ROUNDS):
        _return(laws, body, level, old, i, new, trial, turn)  # in one place: every place holds a copy of it
        if not laws.thin:
            return
        volume = e[0] + e[1] + e[2]
        across = K * (volume - swelling) + G2 * (e[2] - volume / 3.0 - new.plastic[i, 2])
        if abs(across) <= _ACROSS_TOL * (K + G2) * size:
            break
        if across > 0.0:
            high = e[2]
        else:
            low = e[2]
        way = new.direction[i, 2]
        stiff = K + G2 * (2.0 / 3.0 * (1.0 - new.slack[i, 0]) - new.slack[i, 1] * way * way)
        following = e[2] - across / stiff
        if not low < following < high:
            following = 0.5 * (low + high) if np.isfinite(low) and np.isfinite(high) else following
        e[2] = following


@kernel()
def respond(laws: YieldLaws, body: IntArray, heat: Heat, old: Points, new: Points) -> None:
    """The state of every point at the strains of the new one, from the old state; plane stress finds the strain across.

    Parameters
    ----------
    laws : of the bodies
    body : (p,) of every point
    heat : what temperature does: strain that no stress resists, and the yield stress
    old, new : states; the strains of the new one are given
    """
    n = new.strain.shape[1]
    trial, turn = np.empty(n), np.empty(n)
    stays = np.zeros(len(body), np.bool_)
    if not laws.thin and old.back.shape[1] == 0:
        _without_back_stresses(laws, body, heat.level, old, new)
        return
    if not laws.thin:
        _stay(laws, body, heat.level, old, new, stays)
    for i in range(len(body)):
        if not stays[i]:
            respond_at(laws, body[i], heat.swelling[i], heat.level[i], old, new, i, trial, turn)
