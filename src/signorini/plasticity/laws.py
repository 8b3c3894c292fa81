# SPDX-License-Identifier: BSD-3-Clause
"""Material data of bodies that yield, as compiled loops read them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from signorini.arrays import Array, IntArray
from signorini.model.material import Elastic, Material
from signorini.model.model import Model
from signorini.model.plastic import Plastic


class YieldLaws(NamedTuple):
    """Material data of all bodies, a row each; a named tuple, because compiled loops read it.

    Attributes
    ----------
    shear, bulk : (b,) moduli, force per area
    strain, stress : (b, w) tables of the yield stress over the equivalent plastic strain, padded with the last row
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
    rows: IntArray
    beyond: Array
    back: Array
    recovery: Array
    thin: bool


@njit(cache=True, inline="always", error_model="numpy")
def yield_stress_at(laws: YieldLaws, body: int, p: float) -> tuple[float, float]:
    """Yield stress of a body and its slope at an equivalent plastic strain p; ``laws`` are the material data."""
    n = laws.rows[body]
    last = laws.strain[body, n - 1]
    if p >= last:
        return laws.stress[body, n - 1] + laws.beyond[body] * (p - last), laws.beyond[body]
    i = 0
    while p >= laws.strain[body, i + 1]:
        i += 1
    slope = (laws.stress[body, i + 1] - laws.stress[body, i]) / (laws.strain[body, i + 1] - laws.strain[body, i])
    return laws.stress[body, i] + slope * (p - laws.strain[body, i]), slope


def yield_laws(model: Model) -> YieldLaws:
    """Material data of all bodies, with tables of one width."""
    plastics = [_plastic(body.material) for body in model.bodies]
    tables = [np.zeros((1, 2)) if plastic is None else plastic.curve for plastic in plastics]
    backs = [() if plastic is None else plastic.backstresses for plastic in plastics]
    width, most = max(len(table) for table in tables), max(len(back) for back in backs)
    filled = np.array([[*table, *[table[-1]] * (width - len(table))] for table in tables])
    back = np.zeros((len(backs), most, 2))
    for b, rows in enumerate(backs):
        back[b, : len(rows)] = np.reshape(rows, (-1, 2))
    return YieldLaws(
        shear=np.array([body.material.shear_modulus for body in model.bodies]),
        bulk=np.array([body.material.bulk_modulus for body in model.bodies]),
        strain=np.ascontiguousarray(filled[:, :, 0]),
        stress=np.ascontiguousarray(filled[:, :, 1]),
        rows=np.array([0 if plastic is None else len(plastic.curve) for plastic in plastics]),
        beyond=np.array([0.0 if plastic is None else plastic.hardening for plastic in plastics]),
        back=np.ascontiguousarray(back[..., 0]),
        recovery=np.ascontiguousarray(back[..., 1]),
        thin=model.kind == "plane stress",
    )


def _plastic(material: Material) -> Plastic | None:
    return material.plastic if isinstance(material, Elastic) else None
