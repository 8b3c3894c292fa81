# SPDX-License-Identifier: BSD-3-Clause
"""What a history lacks on one mesh, by stresses that are recovered and by the mesh before."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.accuracy.contacts import ContactErrors, level_errors, trace_errors
from signorini.accuracy.influence import influence
from signorini.accuracy.recovery import StressRecovery
from signorini.arrays import Array
from signorini.fem.space import make_space
from signorini.fem.stress import DeformedBodies
from signorini.meshing.simplices import Simplices
from signorini.model.mesh import CORNERS
from signorini.model.model import Model
from signorini.plasticity.fields import by_family
from signorini.solution.history import History

IN_SPACE = 3
"""Dimension in which cells far from a contact are many, and refined by what they count for it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Estimate:
    """Estimated errors of a history on one mesh.

    Attributes
    ----------
    pressure, traction, energy : relative, of the step where each is largest
    squares : (m,) of the energy norm of every cell, of all steps together, work
    weights : (m,) by which cells are refined for pressures: in the plane these over the norm and what the pressures
        lack around their corners over these, in space these by what they count for pressures; or for an output
    effect : sum of the weights for pressures
    pairs : that touch at the end of the step where most do
    value, output : of an output that is asked for, and its relative error
    """

    pressure: float
    traction: float
    energy: float
    squares: Array
    weights: Array
    effect: float
    pairs: int
    value: float | None = None
    output: float | None = None

    def of(self, what: object) -> float:
        """Of what a request asks for."""
        named = {"pressure": self.pressure, "traction": self.traction, "energy": self.energy}
        found = named.get(what, self.output) if isinstance(what, str) else self.output
        assert found is not None
        return found


Before = tuple[Simplices, History, Estimate]
"""The simplices that a history was solved on, and the history of the mesh before with its estimate."""


def estimate(history: History, before: Before | None = None) -> Estimate:
    """What a history lacks at the ends of its steps.

    Parameters
    ----------
    history : solved
    before : the mesh before, in space
    """
    model = history.model
    space, flat = make_space(model.mesh, kind=model.kind), model.dimension == 2
    traced, carried, pairs = list[ContactErrors](), list[ContactErrors](), 0
    recovery = StressRecovery(space, model)
    squares, lost, norms = np.zeros(model.mesh.number_of_cells), [0.0], [0.0]
    weights = np.zeros(model.mesh.number_of_cells)
    for k, step in enumerate(history.steps):
        flowed = {} if step.plastic is None else by_family(space, model, step.plastic.state.strain)
        deformed = DeformedBodies.of(space, model, step.displacement, step.factors, flowed)
        stress = recovery.error(deformed)
        squares += stress.squares
        weights += stress.squares * (influence(model.mesh, step.contacts) if model.dimension == IN_SPACE else 1.0)
        lost.append(float(stress.squares.sum()))
        norms.append(stress.norm_square)
        traced.append(trace_errors(deformed, step.contacts, stress, step.motions))
        if before is not None and not flat:
            carried.append(level_errors(step.contacts, _carried(before, k)))
        pairs = max(pairs, sum(int(contact.closed.sum()) for contact in step.contacts))
    energy = float(np.sqrt(max(lost) / max(norms))) if max(norms) > 0.0 else 0.0
    effect, share = (
        float(weights.sum()),
        1.0 if before is None else space_share(float(weights.sum()), before[2].effect),
    )
    found = traced + [one.scaled(share) for one in carried]
    size, marked = max((one.scale for one in traced), default=0.0), np.zeros(len(model.mesh.points))
    for one in traced:
        marked += one.nodes
    return Estimate(
        pressure=_ratio(max((one.pressure for one in found), default=0.0), size),
        traction=_ratio(max((one.pressure + one.friction for one in found), default=0.0), size),
        energy=energy,
        squares=squares,
        weights=_over(squares, max(norms)) + _around(model, _over(marked, size)) if flat else weights,
        effect=effect,
        pairs=pairs,
    )


def _around(model: Model, squares: Array) -> Array:
    """(m,) Of cells, from those of nodes: every cell at a node has a share of it."""
    corners = [cells[:, : CORNERS[family]] for family, cells in model.mesh.cells.items()]
    count = np.bincount(np.concatenate([part.ravel() for part in corners]), minlength=len(squares))
    share = squares / np.maximum(count, 1)
    return np.concatenate([share[part].sum(axis=1) for part in corners])


def _over(squares: Array, scale: float) -> Array:
    """Of a scale, where there is one."""
    return squares / scale if scale > 0.0 else squares


def _carried(before: Before, step: int) -> list[tuple[Array, Array]]:
    """Of every contact pressure and friction of the mesh before at the corners of this one."""
    simplices, history, _ = before
    older = int((simplices.parents[:, 0] == simplices.parents[:, 1]).sum())
    found = []
    for contact in history.steps[step].contacts:
        values = np.zeros((older, 1 + contact.normals.shape[1]))
        values[contact.node, 0], values[contact.node, 1:] = contact.pressure, contact.shear
        carried = simplices.carried(values)
        found.append((carried[:, 0], carried[:, 1:]))
    return found


def space_share(effect: float, before: float) -> float:
    """Of the square of the difference from the mesh before in space: what this one lacks of it.

    Spaces of refined meshes hold those of coarser ones, so that an error is orthogonal to what the last refinement has
    changed, as Galerkin's method has it: the square of what the mesh before lacked is that of what this one lacks and
    that of the difference. With q the ratio of what they lack it is ``q^2 / (1 - q^2)``.

    Parameters
    ----------
    effect, before : squares of errors of stresses, by what they count for the pressures

    Examples
    --------
    >>> space_share(1.0, 5.0)
    0.25
    """
    return effect / (before - effect) if effect < before else 1.0


def _ratio(square: float, scale: float) -> float:
    """Root of a square over a scale; 1 where nothing presses."""
    return float(np.sqrt(square / scale)) if scale > 0.0 else 1.0
