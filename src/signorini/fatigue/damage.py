# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of fatigue criteria over histories that are linear between the times at which they are given."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.fatigue.ball import smallest_balls
from signorini.fatigue.criteria import SWT, Crossland, DangVan, FatemiSocie, FatigueCriterion, FatigueLimits, StrainLife
from signorini.fatigue.planes import critical_planes, grid_of_planes
from signorini.short import Short

_LIFE_ROUNDS = 60  # Newton's steps for a life: some five are taken


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Damage(Short):
    """What a criterion says at n points.

    Attributes
    ----------
    parameter : (n,) in its own units
    amplitude, stress : (n,) its two terms, see `FatigueCriterion.terms`
    plane : (n, 3) unit normals of the critical planes; NaN of criteria that know none
    """

    parameter: Array
    amplitude: Array
    stress: Array
    plane: Array


def damage(criterion: FatigueCriterion, stress: Array, strain: Array) -> Damage:
    """What a criterion says of histories of stress and strain.

    Parameters
    ----------
    criterion : any that asks for stresses and strains alone
    stress, strain : (n, t, 6) tensors xx, yy, zz, xy, yz, xz at t times between which they are linear; force per area,
        and without unit (tensor components of shear)

    Examples
    --------
    A bar that is pulled and pressed in turn by 2, modulus 4:

    >>> stress, strain = np.zeros((1, 2, 6)), np.zeros((1, 2, 6))
    >>> stress[0, :, 0], strain[0, :, 0] = (2.0, -2.0), (0.5, -0.5)
    >>> found = damage(SWT(), stress, strain)
    >>> found.parameter.tolist(), found.plane.tolist()
    ([1.0], [[1.0, 0.0, 0.0]])
    """
    if isinstance(criterion, FatigueLimits):
        return _of_deviators(criterion, np.ascontiguousarray(stress))
    assert isinstance(criterion, SWT | FatemiSocie)
    shear = isinstance(criterion, FatemiSocie)
    slope = criterion.sensitivity / criterion.yield_stress if isinstance(criterion, FatemiSocie) else 0.0
    both = np.ascontiguousarray(stress), np.ascontiguousarray(strain)
    plane, found = critical_planes(*both, grid_of_planes(), shear, slope)
    plane = plane * np.where((plane[:, :1] < 0.0) | ((plane[:, :1] == 0.0) & (plane[:, 1:2] < 0.0)), -1.0, 1.0) + 0.0
    return Damage(parameter=found[:, 0], amplitude=found[:, 1], stress=found[:, 2], plane=plane)


def _of_deviators(criterion: FatigueLimits, stress: Array) -> Damage:
    """Crossland's and Dang Van's parameters."""
    hydrostatic = stress[..., :3].mean(axis=-1)
    path = _deviators(stress)
    centre, radius = smallest_balls(path)
    limit = criterion.torsion_limit
    if isinstance(criterion, Crossland):
        amplitude, most = radius / np.sqrt(2.0), hydrostatic.max(axis=1)
        parameter = (amplitude + criterion.slope * most) / limit
    else:
        assert isinstance(criterion, DangVan)
        shear = _tresca(path - centre[:, None])
        worst = (shear + criterion.slope * hydrostatic).argmax(axis=1)[:, None]
        amplitude, most = (np.take_along_axis(each, worst, axis=1)[:, 0] for each in (shear, hydrostatic))
        parameter = (amplitude + criterion.slope * most) / limit
    nowhere = np.full((len(stress), 3), np.nan)
    return Damage(parameter=parameter, amplitude=amplitude, stress=most, plane=nowhere)


def _deviators(stress: Array) -> Array:
    """Deviators (..., 5) of stresses (..., 6), as vectors of the same length ``sqrt(s:s)``."""
    x, y, z, xy, yz, xz = np.moveaxis(stress, -1, 0)
    across = z - (x + y + z) / 3.0
    return np.stack(
        [(x - y) / np.sqrt(2.0), np.sqrt(1.5) * across, *(np.sqrt(2.0) * part for part in (xy, yz, xz))], axis=-1
    )


def _tresca(deviator: Array) -> Array:
    """Half the difference of the largest and the smallest principal stress of deviators (..., 5)."""
    one, other, *shear = np.moveaxis(deviator, -1, 0)
    z = other / np.sqrt(1.5)
    xy, yz, xz = (part / np.sqrt(2.0) for part in shear)
    x, y = one / np.sqrt(2.0) - 0.5 * z, -one / np.sqrt(2.0) - 0.5 * z
    rows = [np.stack(row, axis=-1) for row in ((x, xy, xz), (xy, y, yz), (xz, yz, z))]
    principal = np.linalg.eigvalsh(np.stack(rows, axis=-2))
    half: Array = 0.5 * (principal[..., 2] - principal[..., 0])
    return half


def path_amplitudes(paths: Array) -> Array:
    """(n,) Radii of the smallest circles around paths (n, t, d): half the range where d is 1."""
    if paths.shape[2] == 1:
        half: Array = 0.5 * np.ptp(paths[..., 0], axis=1)
        return half
    return smallest_balls(np.ascontiguousarray(paths))[1]


def largest_product(friction: Array, stress: Array) -> Array:
    """(n,) The largest ``|q| max(sigma, 0)`` over histories (n, t) of both that are linear between the times.

    Between two times the product is a parabola, whose vertex may be higher than both ends.

    Examples
    --------
    Friction that comes while the stress goes:

    >>> largest_product(np.array([[0.0, 2.0]]), np.array([[4.0, 0.0]])).tolist()
    [2.0]
    """
    found: Array = (np.abs(friction) * np.maximum(stress, 0.0)).max(axis=1)
    (q, s), (dq, ds) = ([each[:, :-1] for each in (friction, stress)], [np.diff(each) for each in (friction, stress)])
    with np.errstate(divide="ignore", invalid="ignore"):  # no vertex where one of both stays
        at = -(q * ds + s * dq) / (2.0 * dq * ds)
    at = np.clip(np.nan_to_num(at, nan=0.0, posinf=0.0, neginf=0.0), 0.0, 1.0)
    between = np.abs(q + at * dq) * np.maximum(s + at * ds, 0.0)
    return np.maximum(found, between.max(axis=1, initial=0.0))


def cycles_to_failure(criterion: StrainLife, parameter: Array, modulus: Array) -> Array:
    """(n,) Lives in cycles by the constants of a criterion; infinite where the parameter is 0.

    Both sides grow as sums of powers of the life, whose logarithm is convex: Newton's method from below finds it.

    Parameters
    ----------
    criterion : SWT or Fatemi-Socie with the constants of a life
    parameter : (n,) of `damage`
    modulus : (n,) Young's modulus for SWT, the shear modulus for Fatemi-Socie, force per area

    Examples
    --------
    >>> law = SWT(strength=1000.0, strength_exponent=-0.1, ductility=0.5, ductility_exponent=-0.6)
    >>> cycles_to_failure(law, np.array([1000.0**2 / 2e5 * 1e5**-0.2 + 500.0 * 1e5**-0.7]), np.array([2e5])).round(6)
    array([50000.])
    """
    strength, b, ductility, c = criterion.constants
    if isinstance(criterion, SWT):
        logs, powers = [np.log(strength**2 / modulus), np.log(strength * ductility)], (2.0 * b, b + c)
    else:
        logs, powers = [np.log(strength / modulus), np.log(ductility)], (b, c)
    found = np.full(parameter.shape, np.inf)
    finite = parameter > 0.0
    asked = np.log(parameter[finite])
    scales = [np.broadcast_to(log, parameter.shape)[finite] for log in logs]
    x = np.maximum((asked - scales[0]) / powers[0], (asked - scales[1]) / powers[1])
    for _ in range(_LIFE_ROUNDS):
        one, other = scales[0] + powers[0] * x, scales[1] + powers[1] * x
        both = np.logaddexp(one, other)
        slope = powers[0] * np.exp(one - both) + powers[1] * np.exp(other - both)
        step = (both - asked) / slope
        x = x - step
        if np.abs(step).max(initial=0.0) <= np.finfo(float).eps * np.abs(x).max(initial=1.0):
            break
    with np.errstate(over="ignore"):
        found[finite] = 0.5 * np.exp(x)
    return found
