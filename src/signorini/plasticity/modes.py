# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops over cells with internal modes: what they take of the strain, elastic and where points yield.

The strain of a cell is ``B u + G a``, the amplitudes a leave no force on the modes, ``int G^T sigma = 0``. With
``sigma = D (eps - eps_0)``, of plastic and thermal strains eps_0, they are linear in these::

    a = K_aa^-1 (int G^T D eps_0 - K_au u),   B u + G a = (B - G K_aa^-1 K_au) u + G K_aa^-1 int G^T D eps_0

so that states need not hold them. Plastic strains depend on them in turn: a few unknowns a cell, found by Newton's
method on a convex energy.

References
----------
Simo, Rifai (1990), A class of mixed assumed strain methods and the method of incompatible modes, Int. J. Numer. Methods
Eng. 29:1595.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part
from signorini.plasticity.bracket import Bracket, narrowed, secant
from signorini.plasticity.kernels import strain_rows
from signorini.plasticity.laws import Heat, YieldLaws
from signorini.plasticity.linearised import taken
from signorini.plasticity.radial_return import Points, respond_at

_BALANCE_TOL = 1e-13  # of the yield stress: forces on modes of stresses below that are zero
_NOISE = 1e-10  # of the trial stresses: below it forces that no longer fall are what rounding leaves
_ROUNDS = 60  # of Newton's method in a cell; 3 to 6 are the rule
_CUTS = 12  # of a step in a cell by regula falsi
_UPHILL = 0.8  # of the slope at the beginning of a step: one that ends steeper is cut
_LEVEL = 0.5  # of the slope at the beginning: where a step is cut
_INSIDE = 0.05  # of the bracket: how near its ends the next try may be
_SINGULAR = 1e-12  # of the elastic stiffness: a pivot below that is none
_LEFT = 1e-6  # of what yielding takes off, left in place where nothing else would resist a mode


class Modes(NamedTuple):
    """Internal modes of the cells of a group, i amplitudes a cell, none without; a named tuple for compiled loops.

    Attributes
    ----------
    gradients : (m, q, k', e) of the modes
    share : (m, i, d k) ``K_aa^-1 K_au``
    stiffness, inverse : (m, i, i) K_aa and its inverse
    """

    gradients: Array
    share: Array
    stiffness: Array
    inverse: Array


def eliminated(gradients: Array, modes: Array, weights: Array, law: Array) -> Modes:
    """The modes of elastic cells.

    Parameters
    ----------
    gradients, modes : (m, q, k, e) of the shape functions, (m, q, k', e) of the modes
    weights : (m, q) volumes of the points
    law : (m, n, n) elastic law of every cell
    """
    m, _, k, _ = gradients.shape
    d = 2 if law.shape[1] == 4 else 3
    count = d * modes.shape[2]
    stiffness, coupling = np.zeros((m, count, count)), np.zeros((m, count, d * k))
    if count:
        _couple(gradients, modes, weights, law, stiffness, coupling)
    inverse = np.linalg.inv(stiffness)
    return Modes(gradients=modes, share=inverse @ coupling, stiffness=stiffness, inverse=inverse)


@kernel()
def _couple(gradients: Array, modes: Array, weights: Array, law: Array, stiffness: Array, coupling: Array) -> None:
    """K_aa, (m, i, i), and K_au, (m, i, d k), added to zeros; arguments as of `eliminated`."""
    m, points, k, _ = gradients.shape
    n, count = law.shape[1], stiffness.shape[1]
    d = 2 if n == 4 else 3
    B, G, DG = np.empty((n, k * d)), np.empty((n, count)), np.empty((n, count))
    for c in range(m):
        for q in range(points):
            strain_rows(gradients[c, q], d, B)
            strain_rows(modes[c, q], d, G)
            for r in range(n):
                for x in range(count):
                    value = 0.0
                    for t in range(n):
                        value += law[c, r, t] * G[t, x]
                    DG[r, x] = weights[c, q] * value
            for x in range(count):
                for r in range(n):
                    for y in range(count):
                        stiffness[c, x, y] += G[r, y] * DG[r, x]
                    for y in range(k * d):
                        coupling[c, x, y] += B[r, y] * DG[r, x]


@part()
def factor(A: Array) -> bool:
    """Overwrite the lower triangle of A by its Cholesky factor; whether it has one."""
    for j in range(len(A)):
        least = _SINGULAR * abs(A[j, j])
        for i in range(j, len(A)):
            value = A[i, j]
            for k in range(j):
                value -= A[i, k] * A[j, k]
            A[i, j] = value
        if not A[j, j] > least:
            return False
        root = np.sqrt(A[j, j])
        for i in range(j, len(A)):
            A[i, j] /= root
    return True


@part()
def softened(stiffness: Array, loss: Array, out: Array) -> None:
    """Factorise K_aa less what yielding takes off; where nothing resists some mode a little of that is left.

    Parameters
    ----------
    stiffness : (i, i) K_aa
    loss : (i, i) what yielding takes off
    out : (i, i) its lower triangle becomes the factor
    """
    for left in (0.0, _LEFT, 1.0):
        for x in range(len(out)):
            for y in range(len(out)):
                out[x, y] = stiffness[x, y] - (1.0 - left) * loss[x, y]
        if factor(out):
            return


@part()
def substitute(L: Array, x: Array) -> None:
    """Overwrite x by ``(L L^T)^-1 x``; L is a lower triangle."""
    for i in range(len(x)):
        for k in range(i):
            x[i] -= L[i, k] * x[k]
        x[i] /= L[i, i]
    for i in range(len(x) - 1, -1, -1):
        for k in range(i + 1, len(x)):
            x[i] -= L[k, i] * x[k]
        x[i] /= L[i, i]


class _Cell(NamedTuple):
    """A cell whose points yield.

    Attributes
    ----------
    first : of its points among those of the group
    body : of the cell
    weights : (q,) volumes of the points
    law : (n, n) elastic law
    G : (q, n, i) strains of the modes at amplitude 1
    base : (q, n) strains of the points with elastic modes
    stiffness : (i, i) of the modes
    """

    first: int
    body: int
    weights: Array
    law: Array
    G: Array
    base: Array
    stiffness: Array


@part()
def _imbalance(
    laws: YieldLaws, heat: Heat, cell: _Cell, old: Points, new: Points, a: Array, h: Array, room: Array
) -> None:
    """Forces h on the modes at amplitudes a beyond the elastic ones, after the points have answered; (2, n) room."""
    n, count = cell.base.shape[1], len(a)
    trial, turn = room[0], room[1]
    h[:] = 0.0
    for q in range(len(cell.weights)):
        i = cell.first + q
        for r in range(n):
            if r != 2 or not laws.thin:  # the strain across is found by the point itself
                new.strain[i, r] = cell.base[q, r]
                for x in range(count):
                    new.strain[i, r] += cell.G[q, r, x] * a[x]
        respond_at(laws, cell.body, heat.swelling[i], heat.level[i], old, new, i, trial, turn)
        for t in range(n):
            turn[t] = new.strain[i, t] - new.plastic[i, t] - (heat.swelling[i] / 3.0 if t < 3 else 0.0)
        for r in range(n):
            stress = 0.0
            for t in range(n):
                stress += cell.law[r, t] * turn[t]
            for x in range(count):
                h[x] += cell.weights[q] * stress * cell.G[q, r, x]


@part()
def _find_loss(laws: YieldLaws, cell: _Cell, new: Points, M: Array, loss: Array) -> None:
    """What yielding takes off the stiffness of the modes, ``sum_q w G^T M G``, into ``loss``; M is room."""
    n, count = cell.base.shape[1], len(loss)
    loss[:] = 0.0
    for q in range(len(cell.weights)):
        i = cell.first + q
        if not new.yields[i]:
            continue
        taken(laws, cell.body, new, i, new.direction[i], 0.0, M)
        for r in range(n):
            for x in range(count):
                value = 0.0
                for t in range(n):
                    value += M[r, t] * cell.G[q, t, x]
                for y in range(count):
                    loss[y, x] += cell.weights[q] * cell.G[q, r, y] * value


@kernel()
def settle(
    laws: YieldLaws,
    body: IntArray,
    heat: Heat,
    law: Array,
    weights: Array,
    modes: Modes,
    old: Points,
    new: Points,
) -> None:
    """Bring the modes of cells in which points yield into balance.

    Parameters
    ----------
    laws : material data
    body, heat : (m q,) body of every point, and what temperature does to it
    law : (b, n, n) elastic law of every body
    weights : (m, q) volumes of the points
    modes : of the cells
    old, new : states of the points; the new one has answered to strains with elastic modes
    """
    m, points = weights.shape
    n, count = new.strain.shape[1], modes.stiffness.shape[1]
    d = 2 if n == 4 else 3
    G, base, M = np.empty((points, n, count)), np.empty((points, n)), np.empty((n, n))
    loss, L, room = np.empty((count, count)), np.empty((count, count)), np.empty((2, n))
    at, end, h, step = np.empty(count), np.empty(count), np.empty(count), np.empty(count)
    for c in range(m):
        first = c * points
        if not new.yields[first : first + points].any():
            continue
        size, unit, b = 0.0, 0.0, body[first]
        for q in range(points):
            strain_rows(modes.gradients[c, q], d, G[q])
            base[q] = new.strain[first + q]
            force = weights[c, q] * np.abs(G[q]).max()
            unit += force * laws.stress[b, 0, 0]
            size += force * np.abs(base[q]).max() * 2.0 * laws.shear[b]
        cell = _Cell(first, b, weights[c], law[b], G, base, modes.stiffness[c])
        at[:] = 0.0
        _imbalance(laws, heat, cell, old, new, at, h, room)
        last = np.inf
        for _ in range(_ROUNDS):
            worst = np.abs(h).max()
            if worst <= _BALANCE_TOL * unit or (worst <= _NOISE * size and worst > 0.5 * last):
                break
            last = worst
            _find_loss(laws, cell, new, M, loss)
            softened(cell.stiffness, loss, L)
            step[:] = -h
            substitute(L, step)
            start, s = -np.dot(h, step), 1.0
            bracket = Bracket(0.0, s, -start, 0.0, 0)
            for cut in range(_CUTS):
                end[:] = at + s * step
                _imbalance(laws, heat, cell, old, new, end, h, room)
                slope = np.dot(h, step)
                if (cut == 0 and slope <= _UPHILL * start) or abs(slope) <= _LEVEL * start:
                    break
                bracket = narrowed(bracket, s, slope, slope > 0.0)
                s = secant(bracket, 0.0, _INSIDE)
            at[:] = end
