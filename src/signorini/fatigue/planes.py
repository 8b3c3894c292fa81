# SPDX-License-Identifier: BSD-3-Clause
"""Critical planes: on which plane through a point a parameter of stress and strain over time is largest.

Stresses and strains are linear between the times at which they are given, so that their extremes on every plane, and
the smallest circle around the path of a shear, are those at these times: nothing is sampled in time. Planes are looked
at on a grid over all directions of space, and from its best ones on by steps that halve.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.compilation import kernel, part
from signorini.fatigue.ball import smallest_ball

_SPACING = np.radians(6.0)  # between planes of the grid: maxima are wider than 45 degrees
_STARTS = 4  # of the best planes of the grid, apart from each other, from which the maximum is sought
_FINEST = 1e-6  # radians: what is left then of a smooth maximum is rounding, of one with a kink 1e-6
_PROMISING = 0.9  # of the largest parameter: a maximum is at most some hundredths above the nearest plane of the grid
_SAME_MAXIMUM = 3.0  # spacings: planes of the grid that are nearer lead to one maximum
_BETTER = 1e-12  # of a parameter: planes that are alike to rounding do not replace the first


def grid_of_planes() -> Array:
    """(m, 3) unit normals, one for every plane through a point, `_SPACING` apart; those across z come first."""
    rings = round(0.5 * np.pi / _SPACING)
    found = []
    for ring in range(rings + 1):
        height = ring * 0.5 * np.pi / rings
        around = 2 * rings if ring == 0 else max(1, round(4 * rings * np.cos(height)))
        turn = np.arange(around) * (np.pi if ring == 0 else 2.0 * np.pi) / around
        level = np.full(around, np.sin(height))
        found.append(np.column_stack([np.cos(height) * np.cos(turn), np.cos(height) * np.sin(turn), level]))
    return np.concatenate(found)


@kernel()
def critical_planes(stress: Array, strain: Array, grid: Array, shear: bool, slope: float) -> tuple[Array, Array]:
    """The planes on which a parameter is largest, (n, 3) normals, and the parameter with its terms, (n, 3).

    Parameters
    ----------
    stress, strain : (n, t, 6) tensors xx, yy, zz, xy, yz, xz at the ends of straight parts of a history
    grid : of planes to look at first, see `grid_of_planes`
    shear : the amplitude is that of the shear strain, ``gamma_a max(1 + slope sigma_n,max, 0)``; otherwise of the
        normal strain, ``eps_a max(sigma_n,max, 0)``
    slope : of the first, area per force
    """
    n = len(stress)
    planes, found = np.zeros((n, 3)), np.zeros((n, 3))
    values = np.zeros(len(grid))
    apart = np.cos(_SAME_MAXIMUM * _SPACING)
    for i in range(n):
        for m in range(len(grid)):
            values[m] = _on_plane(grid[m], stress[i], strain[i], shear, slope)[0]
        found[i, 0] = -1.0
        for _ in range(_STARTS):
            best = int(np.argmax(values))
            if values[best] < _PROMISING * found[i, 0] or values[best] < 0.0:
                break
            for m in range(len(grid)):
                if abs((grid[m] * grid[best]).sum()) > apart:
                    values[m] = -1.0
            normal = _steepest(grid[best], stress[i], strain[i], shear, slope)
            here = _on_plane(normal, stress[i], strain[i], shear, slope)
            if here[0] > (1.0 + _BETTER) * found[i, 0]:
                planes[i] = normal
                found[i, 0], found[i, 1], found[i, 2] = here
    return planes, found


@part()
def _steepest(start: Array, stress: Array, strain: Array, shear: bool, slope: float) -> Array:
    """The plane of the maximum near one, by steps along eight directions that halve where none of them leads up.

    Where a parameter is nearly the same along a circle of planes, eight directions follow its ridge by small steps
    alone: from the last two steps on it is followed by ones that double (pattern moves of Hooke and Jeeves, 1961).
    """
    normal, before, step = start.copy(), start.copy(), 0.5 * _SPACING
    value = _on_plane(normal, stress, strain, shear, slope)[0]
    while step > _FINEST:
        one, other = _tangents(normal)
        next_normal, next_value = normal, value
        for k in range(8):
            angle = 0.25 * np.pi * k
            trial = normal + np.tan(step) * (np.cos(angle) * one + np.sin(angle) * other)
            trial /= np.sqrt((trial * trial).sum())
            here = _on_plane(trial, stress, strain, shear, slope)[0]
            if here > (1.0 + _BETTER) * next_value:
                next_normal, next_value = trial, here
        if not next_value > value:
            step *= 0.5
            continue
        ahead, before = next_normal - before, normal
        while next_value > (1.0 + _BETTER) * value:
            normal, value = next_normal, next_value
            next_normal = normal + ahead
            next_normal /= np.sqrt((next_normal * next_normal).sum())
            next_value = _on_plane(next_normal, stress, strain, shear, slope)[0]
            ahead *= 2.0
    return normal


@part()
def _tangents(normal: Array) -> tuple[Array, Array]:
    """Two unit vectors of a plane, the second along z as far as it can be."""
    one = np.array([-normal[1], normal[0], 0.0])
    length = np.sqrt((one * one).sum())
    if length < _FINEST:
        return np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    one /= length
    other = np.array(
        [-normal[2] * one[1], normal[2] * one[0], normal[0] * one[1] - normal[1] * one[0]],
    )
    return one, other


@part()
def _on_plane(normal: Array, stress: Array, strain: Array, shear: bool, slope: float) -> tuple[float, float, float]:
    """The parameter on a plane, the amplitude of its strain and its largest normal stress."""
    most, low, high = -np.inf, np.inf, -np.inf
    across = _weights(normal, normal)
    for t in range(len(stress)):
        most = max(most, _component(stress, t, across))
        if not shear:
            along = _component(strain, t, across)
            low, high = min(low, along), max(high, along)
    if not shear:
        return 0.5 * (high - low) * max(most, 0.0), 0.5 * (high - low), most
    one, other = _tangents(normal)
    first, second = _weights(normal, one), _weights(normal, other)
    path = np.empty((len(strain), 2))
    for t in range(len(strain)):
        path[t, 0] = 2.0 * _component(strain, t, first)
        path[t, 1] = 2.0 * _component(strain, t, second)
    amplitude = smallest_ball(path)[1]
    return amplitude * max(1.0 + slope * most, 0.0), amplitude, most


@part()
def _weights(a: Array, b: Array) -> Array:
    """(6,) What the components of a tensor s count for in ``a . s b``."""
    products = (a[0] * b[1] + a[1] * b[0], a[1] * b[2] + a[2] * b[1], a[0] * b[2] + a[2] * b[0])
    return np.array([a[0] * b[0], a[1] * b[1], a[2] * b[2], products[0], products[1], products[2]])


@part()
def _component(tensors: Array, t: int, weights: Array) -> float:
    """A weighted sum of the components of one of several tensors."""
    total = 0.0
    for k in range(6):
        total += weights[k] * tensors[t, k]
    return total
