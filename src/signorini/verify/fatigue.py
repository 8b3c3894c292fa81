# SPDX-License-Identifier: BSD-3-Clause
"""Fatigue: the trailing edge of Cattaneo and Mindlin, and criteria on histories that are known in closed form."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.arrays import Array
from signorini.engine.fatigue_places import probe_of
from signorini.engine.solve import solve
from signorini.engine.stress_history import stress_history
from signorini.fatigue.criteria import SWT, Crossland, DangVan, FatemiSocie, FatigueCriterion
from signorini.fatigue.damage import damage
from signorini.fem.space import make_space
from signorini.gallery.half_planes import EQUAL, HALF_WIDTH, equal_half_planes
from signorini.model.step import Step
from signorini.verify.check import Check, checks_of

_PULL = 0.7  # of mu P
_SIZE = 160.0  # of the blocks, in half-widths of contact: what the far ends add to the stress is below the tolerances
_E, _NU = 200e3, 0.3
_PULLED, _SHEARED = 200.0, 90.0  # amplitudes of the tension and the shear stress of a shaft
_MOMENTS = 720  # of a cycle of the shaft


def trailing_edge() -> Iterator[Check]:
    """Two equal cylinders, 20 and 40 cells to a half-width of contact: the stress along the surface at x = a.

    Its slope is singular there, so that errors fall with the root of the size of the cells.
    """
    most = 2.0 * EQUAL.friction * EQUAL.normal.peak_pressure * np.sqrt(_PULL)
    coarse, fine = (_edge_stress(spacing) for spacing in (0.05, 0.025))
    extrapolated = (fine - coarse / np.sqrt(2.0)) / (1.0 - 1.0 / np.sqrt(2.0))
    rate = np.log2((most - coarse) / (most - fine))
    yield from checks_of(
        f"trailing edge of Cattaneo-Mindlin, Q = {_PULL:g} mu P",
        ("sigma_xx at x = a, cells a/40", fine, most, 0.08),
        ("the same, extrapolated from a/20 and a/40", extrapolated, most, 0.01),
        ("rate of convergence", rate, 0.5, 0.05, "its slope is singular"),
        source="2 mu p_0 sqrt(Q / (mu P)), Hills and Nowell (1994)",
    )


def _edge_stress(spacing: float) -> float:
    """Half the difference of the stresses along the surface at both edges of contact, of the lower body."""
    steps = [Step(name="press", scale={"press": 1.0}), Step(name="pull", scale={"pull": _PULL})]
    history = solve(equal_half_planes(steps, spacing=spacing, size=_SIZE))
    model = history.model
    probe, points = probe_of(make_space(model.mesh), model, ["lower.seat"], None, 0)
    along = stress_history(history, probe, points, steps=())
    edges = [int(np.abs(points[:, 0] - x).argmin()) for x in (-HALF_WIDTH, HALF_WIDTH)]
    left, right = along.stress[edges, -1, 0]
    return float(0.5 * (left - right))


def known_histories() -> Iterator[Check]:
    """A bar that is pulled to and fro, a shaft that is twisted, and one that is pulled a quarter of a cycle later."""
    limits = {"bending_limit": 300.0, "torsion_limit": 190.0}
    crossland, dang_van = Crossland(**limits), DangVan(**limits)
    fatemi = FatemiSocie(yield_stress=350.0, sensitivity=0.8)
    bar = _stresses(np.array([_PULLED, -0.25 * _PULLED]), np.zeros(2))
    shaft = _stresses(np.zeros(2), np.array([_SHEARED, -_SHEARED]))
    turn = 2.0 * np.pi * np.arange(_MOMENTS + 1) / _MOMENTS
    both = _stresses(_PULLED * np.cos(turn), _SHEARED * np.sin(turn))
    kappa = 0.5 * fatemi.sensitivity * _PULLED / fatemi.yield_stress
    cosine = (np.sqrt((1.0 + kappa) ** 2 + 8.0 * kappa**2) - 1.0 - kappa) / (4.0 * kappa)
    sheared = 0.625 * _PULLED * (1.0 + _NU) / _E * np.sqrt(1.0 - cosine**2) * (1.0 + kappa * (1.0 + cosine))
    amplitude = max(_PULLED / np.sqrt(3.0), _SHEARED)
    # along the ellipse Tresca's shear and the hydrostatic stress: a quadratic in cos
    tresca = np.sqrt(0.25 * (_PULLED * np.cos(turn)) ** 2 + (_SHEARED * np.sin(turn)) ** 2)
    worst = (tresca + dang_van.slope * _PULLED * np.cos(turn) / 3.0).max()
    quarter = (amplitude + crossland.slope * _PULLED / 3.0) / 190.0
    yield from checks_of(
        "fatigue of a bar and a shaft",
        ("SWT, bar, R = -1/4", _parameter(SWT(), bar), 0.625 * _PULLED**2 / _E, 1e-12),
        ("SWT, shaft: at 45 degrees", _parameter(SWT(), shaft), _SHEARED**2 * (1.0 + _NU) / _E, 1e-12),
        ("Fatemi-Socie, bar, over all angles", _parameter(fatemi, bar), sheared, 1e-10),
        ("Crossland, shaft at its limit", _parameter(crossland, shaft), _SHEARED / 190.0, 1e-12),
        ("Crossland, pulled a quarter later", _parameter(crossland, both), quarter, 1e-9),
        ("Dang Van, shaft at its limit", _parameter(dang_van, shaft), _SHEARED / 190.0, 1e-12),
        ("Dang Van, pulled a quarter later", _parameter(dang_van, both), worst / 190.0, 1e-9),
        source="closed forms",
    )


def _stresses(tension: Array, shear: Array) -> Array:
    """(1, t, 6) Stresses of a shaft."""
    found = np.zeros((1, len(tension), 6))
    found[0, :, 0], found[0, :, 3] = tension, shear
    return found


def _parameter(criterion: FatigueCriterion, stress: Array) -> float:
    """The parameter of a criterion for an isotropic body."""
    strain = (1.0 + _NU) / _E * stress
    strain[..., :3] -= _NU / _E * stress[..., :3].sum(axis=-1, keepdims=True)
    return float(damage(criterion, stress, strain).parameter[0])
