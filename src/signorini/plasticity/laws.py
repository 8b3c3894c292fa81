# SPDX-License-Identifier: BSD-3-Clause
"""Material data of bodies that yield, as compiled loops read them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

from signorini.arrays import Array, BoolArray, IntArray
from signorini.compilation import kernel
from signorini.model.material import Elastic, Material
from signorini.model.model import Model
from signorini.model.plastic import Plastic


class YieldLaws(NamedTuple):
    """Material data of all bodies, a row each; a named tuple, because compiled loops read it.

    Attributes
    ----------
    shear, bulk : (b,) moduli, force per area
    strain : (b, w) equivalent plastic strains of the tables of the yield stress, padded with the last
    stress : (b, t, w) yield stresses there at every temperature, padded with the last
    temperature : (b, t) of the tables, padded with the last
    rows : (b,) rows of the tables; 0: the body never yields
    beyond : (b,) slope behind the last row, force per area
    back : (b, M) C of the back stresses, force per area; 0: none
    recovery : (b, M) gamma of the back stresses
    thin : whether the stress across vanishes, as in plane stress
    """

    shear: Array
    bulk: Array
    strain: Array
    stress: Array
    temperature: Array
    rows: IntArray
    beyond: Array
    back: Array
    recovery: Array
    thin: bool

    @property
    def varies(self) -> bool:
        """Whether some yield stress depends on temperature."""
        return self.stress.shape[1] > 1

    @property
    def endless(self) -> BoolArray:
        """(b,) Whether what flow takes grows without end."""
        found: BoolArray = (self.beyond > 0.0) | ((self.back > 0.0) & (self.recovery == 0.0)).any(axis=1)
        return found

    @property
    def saturated(self) -> Array:
        """(b,) What back stresses tend to in tension, as far as they do."""
        ends = np.divide(self.back, self.recovery, out=np.zeros_like(self.back), where=self.recovery > 0.0)
        found: Array = ends.sum(axis=1)
        return found


class Heat(NamedTuple):
    """What temperature does to points; a named tuple, because compiled loops read it.

    Attributes
    ----------
    swelling : (p,) volume strain
    temperature : (p,) above that without strain
    level : (p,) place among the temperatures of the tables: number of the one below, and part of the way to the next
    """

    swelling: Array
    temperature: Array
    level: Array

    def part(self, own: slice) -> Heat:
        """Of some of the points."""
        return Heat(swelling=self.swelling[own], temperature=self.temperature[own], level=self.level[own])


def heat_of(laws: YieldLaws, body: IntArray, swelling: Array, temperature: Array) -> Heat:
    """What temperature does to points.

    Parameters
    ----------
    laws : of the bodies
    body, swelling, temperature : (p,) of every point
    """
    level = np.zeros(len(body))
    if laws.varies:
        for b in np.unique(body):
            own, table = body == b, np.unique(laws.temperature[b])
            level[own] = np.interp(temperature[own], table, np.arange(len(table)))
    return Heat(swelling=swelling, temperature=temperature, level=level)


@njit(cache=True, inline="always", error_model="numpy")
def stress_in_row(stress: Array, body: int, i: int, level: float) -> float:
    """Yield stress in a row of the tables, between two temperatures.

    Parameters
    ----------
    stress, body : of `YieldLaws`, which would be counted at every call, and the body
    i : row
    level : place among the temperatures of the tables, see `Heat`
    """
    low = int(level)
    found: float = stress[body, low, i]
    if level > low:
        found += (level - low) * (stress[body, low + 1, i] - found)
    return found


@njit(cache=True, inline="always", error_model="numpy")
def yield_stress_at(laws: YieldLaws, body: int, p: float, level: float) -> tuple[float, float]:
    """Yield stress of a body and its slope at an equivalent plastic strain.

    Parameters
    ----------
    laws, body : material data, and the body
    p : equivalent plastic strain
    level : place among the temperatures of the tables, see `Heat`
    """
    return stress_in_tables(laws.rows[body], laws.strain, laws.stress, laws.beyond[body], body, p, level)


@njit(cache=True, inline="always", error_model="numpy")
def stress_in_tables(
    rows: int, strain: Array, stress: Array, beyond: float, body: int, p: float, level: float
) -> tuple[float, float]:
    """Yield stress and its slope, see `yield_stress_at`.

    Parameters
    ----------
    rows, strain, stress, beyond : of `YieldLaws`, rows and slope those of the body
    body, p, level : as there
    """
    i, last = 0, rows - 1
    while i < last and p >= strain[body, i + 1]:
        i += 1
    low, slope = stress_in_row(stress, body, i, level), beyond
    if i < last:
        slope = (stress_in_row(stress, body, i + 1, level) - low) / (strain[body, i + 1] - strain[body, i])
    return low + slope * (p - strain[body, i]), slope


@kernel()
def yield_stresses(laws: YieldLaws, body: IntArray, p: Array, level: Array) -> Array:
    """(p,) Yield stress at points.

    Parameters
    ----------
    laws, body : material data, and the body of every point
    p, level : (p,) equivalent plastic strains and places of the temperature, see `yield_stress_at`
    """
    found, rows, strain, stress, beyond = np.empty(len(p)), laws.rows, laws.strain, laws.stress, laws.beyond
    for i in range(len(p)):  # `stress_in_tables` without a call for each point, which would count its arrays
        j, row = body[i], 0
        last = rows[j] - 1
        while row < last and p[i] >= strain[j, row + 1]:
            row += 1
        low, slope = stress_in_row(stress, j, row, level[i]), beyond[j]
        if row < last:
            slope = (stress_in_row(stress, j, row + 1, level[i]) - low) / (strain[j, row + 1] - strain[j, row])
        found[i] = low + slope * (p[i] - strain[j, row])
    return found


def yield_laws(model: Model) -> YieldLaws:
    """Material data of all bodies, with tables of one width, those of a body at the same plastic strains."""
    plastics = [_plastic(body.material) for body in model.bodies]
    tables = [_tables(plastic) for plastic in plastics]
    strain, stress, temperature = (_padded([table[k] for table in tables]) for k in range(3))
    backs = [() if plastic is None else plastic.backstresses for plastic in plastics]
    most = max(len(back) for back in backs)
    back = np.zeros((len(backs), most, 2))
    for b, rows in enumerate(backs):
        back[b, : len(rows)] = np.reshape(rows, (-1, 2))
    return YieldLaws(
        shear=np.array([body.material.shear_modulus for body in model.bodies]),
        bulk=np.array([body.material.bulk_modulus for body in model.bodies]),
        strain=strain,
        stress=stress,
        temperature=temperature,
        rows=np.array(
            [0 if plastic is None else len(table[0]) for plastic, table in zip(plastics, tables, strict=True)]
        ),
        beyond=np.array([0.0 if plastic is None else plastic.hardening for plastic in plastics]),
        back=np.ascontiguousarray(back[..., 0]),
        recovery=np.ascontiguousarray(back[..., 1]),
        thin=model.kind == "plane stress",
    )


def _plastic(material: Material) -> Plastic | None:
    return material.plastic if isinstance(material, Elastic) else None


def _tables(plastic: Plastic | None) -> tuple[Array, Array, Array]:
    """(w,) Plastic strains at which the tables of any temperature bend, (t, w) stresses there, (t,) temperatures."""
    if plastic is None:
        return np.zeros(1), np.zeros((1, 1)), np.zeros(1)
    strain = np.unique(np.concatenate([curve[:, 0] for curve in plastic.curves]))
    stress = np.array([plastic.at(strain, temperature)[0] for temperature in plastic.temperatures])
    return strain, stress, plastic.temperatures


def _padded(tables: Sequence[Array]) -> Array:
    """Tables of one shape: the last entry along every axis is repeated."""
    shape = np.max([table.shape for table in tables], axis=0)
    pads = [[(0, most - own) for own, most in zip(table.shape, shape, strict=True)] for table in tables]
    return np.array([np.pad(table, pad, mode="edge") for table, pad in zip(tables, pads, strict=True)])
