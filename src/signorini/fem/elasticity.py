# SPDX-License-Identifier: BSD-3-Clause
"""The law of the materials: stresses from strains, xx, yy, zz, xy (yz, xz), shear strains twice the tensor's."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np

from signorini.arrays import Array
from signorini.model.kind import axes
from signorini.model.material import Elastic, Material, Orthotropic
from signorini.model.model import Model

_PLANE = np.array([[0, 3], [3, 1]])
_SPACE = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
_RING = np.array([[0, 3, 2], [3, 1, -1]])
_TWIST = np.array([[0, 3, 2, -1], [3, 1, -1, -1], [-1, 4, -1, 5]])
STRAIN_PARTS = {parts.shape: parts for parts in (_PLANE, _RING, _TWIST, _SPACE)}
"""By the numbers of displacements and derivatives: of the strain, which part the derivative j of displacement i is, -1
of none. In bodies of revolution ``u_i / r`` is a third derivative, with twist ``d_r u_i - u_i / r`` a fourth."""


def isotropic(lame: float, shear: float) -> Array:
    """``sigma = lambda tr(eps) I + 2 G eps`` as a matrix, (6, 6); the first four rows and columns are the plane's.

    >>> isotropic(1.0, 0.5)[:4, :4]
    array([[2. , 1. , 1. , 0. ],
           [1. , 2. , 1. , 0. ],
           [1. , 1. , 2. , 0. ],
           [0. , 0. , 0. , 0.5]])
    """
    D = np.diag([2.0 * shear] * 3 + [shear] * 3)
    D[:3, :3] += lame
    return D


def elasticity(material: Material, kind: str) -> Array:
    """Stress xx, yy, zz, xy from strain, (4, 4), force per area; in space, and with twist, yz and xz too, (6, 6).

    Plane stress: zz has a zero row and column, what it adds to the others is condensed.
    """
    if isinstance(material, Elastic):
        shear = material.shear_modulus
        D = isotropic(2.0 * shear * material.nu / (1.0 - 2.0 * material.nu), shear)
    else:
        stiff = np.asarray(np.linalg.inv(_compliance(material)), np.float64)
        D = _rotated_stiffness(stiff, material.angle)
    if len(axes(kind)) == 3:
        return D
    D = D[:4, :4]
    if kind == "plane stress":
        D = D - np.outer(D[:, 2], D[2]) / D[2, 2]
        D[2], D[:, 2] = 0.0, 0.0
    return D


def expansion(material: Material) -> Array:
    """Free thermal strain xx, yy, zz, xy, yz, xz per temperature, (6,)."""
    if isinstance(material, Elastic):
        return material.expansion * np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    alpha = np.array([material.expansion1, material.expansion2, material.expansion3, 0.0, 0.0, 0.0])
    strain: Array = _strain_turn(-material.angle) @ alpha
    return strain


def elasticities(model: Model) -> Array:
    """Of every body, (bodies, 4, 4), in space and with twist (bodies, 6, 6)."""
    return np.array([elasticity(body.material, model.kind) for body in model.bodies])


def expansions(model: Model) -> Array:
    """Of every body, (bodies, 4), in space and with twist (bodies, 6)."""
    parts = 4 if model.components == 2 else 6
    return np.array([expansion(body.material)[:parts] for body in model.bodies])


def law_tensor(D: Array, *, hoop: bool = False, twist: bool = False) -> Array:
    """The law on displacement gradients: what multiplies ``d_i N_a d_j N_b`` in the stiffness of (a, r) and (b, s).

    Parameters
    ----------
    D : (n, 4, 4) of the plane or (n, 6, 6) of space
    hoop : a further "derivative" ``N / r`` of the first component: axisymmetric
    twist : and ``d_r N - N / r`` of a third component

    Returns
    -------
    (n, c, e, c, e), indices material, r, i, s, j; e = c, with the hoop c + 1
    """
    plane = _RING if hoop else _PLANE
    at = _TWIST if twist else _SPACE if D.shape[-1] == 6 else plane
    flat = at.ravel()
    law = D[:, flat][:, :, flat] * np.outer(flat >= 0, flat >= 0)
    return np.asarray(law.reshape(len(D), *at.shape, *at.shape))


def _compliance(material: Orthotropic) -> Array:
    """Strain 1, 2, 3, 12, 23, 13 from stress, (6, 6); G12 stands for moduli that plane models do not need."""
    E1, E2 = material.E1, material.E2
    shear = [1.0 / (modulus or material.G12) for modulus in (material.G12, material.G23, material.G13)]
    S = np.diag([1.0 / E1, 1.0 / E2, 1.0 / material.E3, *shear])
    S[0, 1] = S[1, 0] = -material.nu12 / E1
    S[0, 2] = S[2, 0] = -material.nu13 / E1
    S[1, 2] = S[2, 1] = -material.nu23 / E2
    return S


def _strain_turn(angle: float) -> Array:
    """Strains along axes turned about z by an angle, degrees, from those along x and y, (6, 6)."""
    c, s = cos(radians(angle)), sin(radians(angle))
    return np.array(
        [
            [c * c, s * s, 0.0, c * s, 0.0, 0.0],
            [s * s, c * c, 0.0, -c * s, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            [-2.0 * c * s, 2.0 * c * s, 0.0, c * c - s * s, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, c, -s],
            [0.0, 0.0, 0.0, 0.0, s, c],
        ]
    )


def _rotated_stiffness(D: Array, angle: float) -> Array:
    """A law along axes turned by an angle, in x and y: energy does not care for axes."""
    turn = _strain_turn(angle)
    law: Array = turn.T @ D @ turn
    return law
