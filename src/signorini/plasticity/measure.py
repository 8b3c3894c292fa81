# SPDX-License-Identifier: BSD-3-Clause
"""Stresses, energies and violations of the flow rule at the points of bodies that yield, from displacements and states.

Nothing here comes from the solver but its answer: the certificate rests on it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.plasticity.bodies import YieldingBodies
from signorini.plasticity.laws import Heat, yield_stresses
from signorini.plasticity.radial_return import ROOT32
from signorini.plasticity.state import PlasticState

_MEAN = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]) / 3.0  # of the components xx, yy, zz: products with BLAS are fastest
_TIMES = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])  # that components stand in a tensor


@dataclass(frozen=True, kw_only=True)
class FlowViolation:
    """What points lack of the flow rule, dimensionless; strains over Y / 2G.

    Attributes
    ----------
    excess : of the yield stress, over it
    flow : plastic strain that is not along the relative stress, and back stresses off their law
    consistency : flow below the yield stress
    dissipation : energy that plastic flow would give back
    """

    excess: float
    flow: float
    consistency: float
    dissipation: float


def full_strains(bodies: YieldingBodies, u: Array, plastic: Array, heat: Heat) -> Array:
    """(p, n) Strains of displacements; in plane stress that across is the one that leaves no stress there.

    Parameters
    ----------
    bodies : with their points
    u : (dofs,) displacements
    plastic : (p, n) plastic strains
    heat : what the temperature does to the points
    """
    strain = bodies.strains(u, plastic, heat)
    if bodies.laws.thin:
        G, K = bodies.laws.shear[bodies.body], bodies.laws.bulk[bodies.body]
        lame = K - 2.0 / 3.0 * G
        inside = strain[:, 0] + strain[:, 1]
        strain[:, 2] = (2.0 * G * plastic[:, 2] - lame * inside + K * heat.swelling) / (lame + 2.0 * G)
    return strain


def deviator(bodies: YieldingBodies, u: Array, plastic: Array, heat: Heat) -> Array:
    """(p, n) Deviators of the stresses, tensors.

    Parameters
    ----------
    bodies, u, plastic, heat : as of `full_strains`
    """
    stress = full_strains(bodies, u, plastic, heat)
    stress -= plastic
    stress[:, :3] -= (stress @ _MEAN[: stress.shape[1]])[:, None]
    stress[:, 3:] *= 0.5
    stress *= 2.0 * bodies.laws.shear[bodies.body][:, None]
    return stress


def yield_stress(bodies: YieldingBodies, equivalent: Array, heat: Heat) -> Array:
    """(p,) Yield stress.

    Parameters
    ----------
    bodies : with their points
    equivalent : (p,) equivalent plastic strains
    heat : what the temperature does to the points
    """
    return yield_stresses(bodies.laws, bodies.body, equivalent, heat.level)


def fullness(bodies: YieldingBodies, u: Array, state: PlasticState, heat: Heat) -> Array:
    """(p,) Relative stress over the yield stress: 1 where a point is about to flow.

    Parameters
    ----------
    bodies, u, heat : as of `full_strains`
    state : of the points
    """
    relative = deviator(bodies, u, state.strain, heat) - state.back.sum(axis=1)
    return ROOT32 * size(relative) / yield_stress(bodies, state.equivalent, heat)


def violation(bodies: YieldingBodies, u: Array, old: PlasticState, new: PlasticState, heat: Heat) -> FlowViolation:
    """What a state lacks of backward Euler from another.

    Parameters
    ----------
    bodies, u, heat : as of `full_strains`, at the new state
    old, new : states
    """
    laws, own = bodies.laws, bodies.body
    relative = deviator(bodies, u, new.strain, heat) - new.back.sum(axis=1)
    length, limit = size(relative), yield_stress(bodies, new.equivalent, heat)
    unit = relative / np.maximum(length, np.finfo(np.float64).tiny)[:, None]
    grown = new.equivalent - old.equivalent
    step = new.strain - old.strain
    step[:, 3:] *= 0.5
    strain = limit / (2.0 * laws.shear[own])
    off = size(step - ROOT32 * grown[:, None] * unit) / strain
    law = laws.back[own][..., None], laws.recovery[own][..., None]
    kept = new.back * (1.0 + law[1] * grown[:, None, None])
    drift = kept - old.back - 2.0 / 3.0 * law[0] * (ROOT32 * grown[:, None] * unit)[:, None]
    drifted = np.sqrt((drift**2).sum(axis=-1)).max(axis=1, initial=0.0) / limit
    power = inner(relative, step) / (limit * strain)
    short = 1.0 - ROOT32 * length / limit
    return FlowViolation(
        excess=float(np.max(-short, initial=0.0)),
        flow=float(max(off.max(initial=0.0), drifted.max(initial=0.0))),
        consistency=float(
            max(np.max(np.abs(grown * short) / strain, initial=0.0), np.max(-grown / strain, initial=0.0))
        ),
        dissipation=float(max(-power.min(initial=0.0), 0.0)),
    )


def plastic_work(
    bodies: YieldingBodies,
    before: tuple[Array, PlasticState],
    after: tuple[Array, PlasticState],
    heat: tuple[Heat, Heat],
) -> float:
    """Plastic work from one state to another, ``sum w (s_1 + s_2) : deps_p / 2``: with it energies balance exactly.

    Parameters
    ----------
    bodies : with their points
    before, after : displacements and states
    heat : what the temperature does at both
    """
    (u, old), (v, new) = before, after
    stress = deviator(bodies, u, old.strain, heat[0]) + deviator(bodies, v, new.strain, heat[1])
    step = new.strain - old.strain
    step[:, 3:] *= 0.5
    return float(0.5 * bodies.weights @ inner(stress, step))


def stored_by_plastic_strain(bodies: YieldingBodies, u: Array, state: PlasticState, heat: Heat) -> float:
    """What the elastic energy is beyond that of elastic bodies.

    ``- u f_p + sum w (eps_p : D : eps_p / 2 + eps_p : D : eps_T)``; the last is 0 but in plane stress.

    Parameters
    ----------
    bodies : with their points
    u : (dofs,) displacements
    state : of the points
    heat : what the temperature does to the points
    """
    stress = bodies.eigenstress(state.strain)
    held = 0.5 * (state.strain * stress).sum(axis=1) + stress[:, :3].sum(axis=1) * heat.swelling / 3.0
    return float(bodies.weights @ held - u @ state.forces)


def heat_work(bodies: YieldingBodies, before: tuple[PlasticState, Heat], after: tuple[PlasticState, Heat]) -> float:
    """What a change of temperature does on plastic strains, ``sum w (eps_p1 + eps_p2) : D : deps_T / 2``.

    It is 0 but in plane stress: plastic strain keeps the volume, and not the area.

    Parameters
    ----------
    bodies : with their points
    before, after : states, and what the temperature does to the points
    """
    (old, cold), (new, warm) = before, after
    stress = bodies.eigenstress(0.5 * (old.strain + new.strain))
    return float(bodies.weights @ (stress[:, :3].sum(axis=1) * (warm.swelling - cold.swelling)) / 3.0)


def stored_by_back_stresses(bodies: YieldingBodies, state: PlasticState) -> float:
    """``sum w 3 X : X / (4 C)``: what unloading cannot give back, but plastic flow in reverse can."""
    modulus = bodies.laws.back[bodies.body]
    squares = inner(state.back, state.back)
    held = np.divide(0.75 * squares, modulus, out=np.zeros_like(squares), where=modulus > 0.0)
    return float(bodies.weights @ held.sum(axis=1))


def inner(one: Array, two: Array) -> Array:
    """Products of tensors (..., n) whose shear components stand once."""
    result: Array = (one * two) @ _TIMES[: one.shape[-1]]
    return result


def size(tensor: Array) -> Array:
    """Norms of tensors (..., n) whose shear components stand once."""
    result: Array = np.sqrt(inner(tensor, tensor))
    return result
