# SPDX-License-Identifier: BSD-3-Clause
"""Stresses, energies and violations of the flow rule at the points of bodies that yield, from displacements and states.

Nothing here comes from the solver but its answer: the certificate rests on it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel
from signorini.plasticity.bodies import YieldingBodies
from signorini.plasticity.laws import Heat, YieldLaws, yield_stresses
from signorini.plasticity.radial_return import ROOT32
from signorini.plasticity.state import PlasticState

_TIMES = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])  # that components stand in a tensor
_NO_BACK = np.zeros((0, 0, 0))
_TINY = float(np.finfo(np.float64).tiny)


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


class Flowed(NamedTuple):
    """Plastic strain, equivalent plastic strain and back stresses of points; a named tuple, for compiled loops.

    Attributes
    ----------
    strain, equivalent, back : (p, n), (p,) and (p, M, n), as of `PlasticState`
    """

    strain: Array
    equivalent: Array
    back: Array


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
    return _relative(full_strains(bodies, u, plastic, heat), plastic, _NO_BACK, bodies.laws.shear, bodies.body)


def relative_stress(bodies: YieldingBodies, u: Array, state: PlasticState, heat: Heat) -> Array:
    """(p, n) Deviators of the stresses less the back stresses, tensors.

    Parameters
    ----------
    bodies, u, heat : as of `full_strains`
    state : of the points
    """
    strain = full_strains(bodies, u, state.strain, heat)
    return _relative(strain, state.strain, state.back, bodies.laws.shear, bodies.body)


def yield_stress(bodies: YieldingBodies, equivalent: Array, heat: Heat) -> Array:
    """(p,) Yield stress.

    Parameters
    ----------
    bodies : with their points
    equivalent : (p,) equivalent plastic strains
    heat : what the temperature does to the points
    """
    return yield_stresses(bodies.laws, bodies.body, equivalent, heat.level)


def fullness(bodies: YieldingBodies, u: Array, state: PlasticState, heat: Heat, limit: Array | None = None) -> Array:
    """(p,) Relative stress over the yield stress: 1 where a point is about to flow.

    Parameters
    ----------
    bodies, u, heat : as of `full_strains`
    state : of the points
    limit : (p,) their yield stresses, where they are known
    """
    limit = yield_stress(bodies, state.equivalent, heat) if limit is None else limit
    strain = full_strains(bodies, u, state.strain, heat)
    return ROOT32 * _sizes(strain, state.strain, state.back, bodies.laws.shear, bodies.body) / limit


def violation(bodies: YieldingBodies, u: Array, old: PlasticState, new: PlasticState, heat: Heat) -> FlowViolation:
    """What a state lacks of backward Euler from another.

    Parameters
    ----------
    bodies, u, heat : as of `full_strains`, at the new state
    old, new : states
    """
    relative, limit = relative_stress(bodies, u, new, heat), yield_stress(bodies, new.equivalent, heat)
    before, after = (Flowed(state.strain, state.equivalent, state.back) for state in (old, new))
    excess, flow, consistency, dissipation = _lacks(bodies.laws, bodies.body, relative, limit, before, after)
    return FlowViolation(excess=excess, flow=flow, consistency=consistency, dissipation=dissipation)


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


@njit(cache=True, inline="always", error_model="numpy")
def _relative_at(strain: Array, plastic: Array, back: Array, shear: float, i: int, out: Array) -> float:
    """Relative stress of point i, written to out (n,), and its size; arguments as of `_relative`."""
    mean, square = 0.0, 0.0
    for c in range(3):
        mean += (strain[i, c] - plastic[i, c]) / 3.0
    for c in range(len(out)):
        x = strain[i, c] - plastic[i, c]
        x = 2.0 * shear * (x - mean) if c < 3 else shear * x
        for k in range(back.shape[1]):
            x -= back[i, k, c]
        out[c] = x
        square += x * x if c < 3 else 2.0 * x * x
    return float(np.sqrt(square))


@kernel()
def _relative(strain: Array, plastic: Array, back: Array, shear: Array, body: IntArray) -> Array:
    """(p, n) Relative stresses.

    Parameters
    ----------
    strain, plastic : (p, n) strains
    back : (p, M, n) back stresses
    shear, body : (b,) shear moduli, (p,) body of every point
    """
    out = np.empty(strain.shape)
    for i in range(len(body)):
        _relative_at(strain, plastic, back, shear[body[i]], i, out[i])
    return out


@kernel()
def _sizes(strain: Array, plastic: Array, back: Array, shear: Array, body: IntArray) -> Array:
    """(p,) Sizes of the relative stresses, see `_relative`."""
    room, out = np.empty(strain.shape[1]), np.empty(len(body))
    for i in range(len(body)):
        out[i] = _relative_at(strain, plastic, back, shear[body[i]], i, room)
    return out


@kernel()
def _lacks(
    laws: YieldLaws, body: IntArray, relative: Array, limit: Array, old: Flowed, new: Flowed
) -> tuple[float, float, float, float]:
    """The largest of `FlowViolation` over all points; what is not a number stays one.

    Parameters
    ----------
    laws, body : material data, and the body of every point
    relative, limit : (p, n) relative stresses and (p,) yield stresses at the new state
    old, new : the states
    """
    excess, flow, consistency, dissipation, n = 0.0, 0.0, 0.0, 0.0, relative.shape[1]
    for i in range(len(body)):
        j, square = body[i], 0.0
        for c in range(n):
            square += relative[i, c] ** 2 * (1.0 if c < 3 else 2.0)
        length = np.sqrt(square)
        over, strain = 1.0 / max(length, _TINY), limit[i] / (2.0 * laws.shear[j])
        grown = new.equivalent[i] - old.equivalent[i]
        off, power = 0.0, 0.0
        for c in range(n):
            weight = 1.0 if c < 3 else 2.0
            step = (new.strain[i, c] - old.strain[i, c]) / weight
            off += weight * (step - ROOT32 * grown * over * relative[i, c]) ** 2
            power += weight * relative[i, c] * step
        flow = _larger(flow, np.sqrt(off) / strain)
        for k in range(new.back.shape[1]):
            drift = 0.0
            for c in range(n):
                law = old.back[i, k, c] + 2.0 / 3.0 * laws.back[j, k] * ROOT32 * grown * over * relative[i, c]
                kept = new.back[i, k, c] * (1.0 + laws.recovery[j, k] * grown)
                drift += (kept - law) ** 2 * (1.0 if c < 3 else 2.0)
            flow = _larger(flow, np.sqrt(drift) / limit[i])
        short = 1.0 - ROOT32 * length / limit[i]
        excess = _larger(excess, -short)
        consistency = _larger(_larger(consistency, abs(grown * short) / strain), -grown / strain)
        dissipation = _larger(dissipation, -power / (limit[i] * strain))
    return excess, flow, consistency, dissipation


@njit(cache=True, inline="always")
def _larger(one: float, two: float) -> float:
    """The larger of two numbers, or what is none."""
    return two if two > one or np.isnan(two) else one
