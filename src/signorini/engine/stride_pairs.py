# SPDX-License-Identifier: BSD-3-Clause
"""Pairs of sides that slide far: those of bodies at a displacement, and the model with them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.engine.prepare import UNCONDENSED, Prepared
from signorini.engine.solver import CondensedSolver
from signorini.engine.step_parts import StepPart
from signorini.errors import InputError, SolveFailed
from signorini.fem.boundary import boundary
from signorini.interface.interface import Interface
from signorini.interface.sliding import paired_at
from signorini.interface.worn_sides import worn_sides
from signorini.outcome import Outcome
from signorini.solution.state import State

_STRIDE = 0.25  # of the shortest facet: how far sides slide before pairs are made anew


@dataclass(frozen=True, kw_only=True, eq=False)
class Pairing:
    """Pairs of bodies at a displacement.

    Attributes
    ----------
    interface : gaps are those of the bodies where they are
    displacement : (dofs,) length
    """

    interface: Interface
    displacement: Array

    @staticmethod
    def at(part: StepPart, displacement: Array) -> Pairing:
        """The pairs of bodies that have moved."""
        prepared = part.prepared
        model, space, constraints = prepared.model, prepared.space, prepared.constraints
        try:
            interface = paired_at(prepared.interface, space, model, constraints, prepared.frames, displacement)
        except InputError as error:
            words = f"{part.where} at {part.interval.low:.6%}: {error}"
            raise SolveFailed(words, status=Outcome.NOT_FOUND) from error
        return Pairing(interface=interface, displacement=displacement)

    def gap_before(self, interface: Interface) -> Array:
        """(n,) Gaps before anything moved, as pairs see the motion since then."""
        return np.asarray(self.interface.gap - interface.B[: len(interface)] @ self.displacement)


def paired(prepared: Prepared, interface: Interface) -> Prepared:
    """The model with other pairs; nothing sparse is factorised again.

    Parameters
    ----------
    prepared : under the law of the moment
    interface : with as many pairs, in the same order
    """
    B = sp.csr_array(interface.B @ prepared.constraints.transform)
    condensed = prepared.solver.condensed
    if condensed is None:
        raise InputError(UNCONDENSED, where=("step",))
    condensed = condensed.paired(B, interface, prepared.scale.stiffness, stride_of(prepared))
    if prepared.absent.any():
        condensed = condensed.among(~prepared.absent)
    elastic = CondensedSolver.of(condensed, interface, prepared.scale, prepared.settings)
    solver = prepared.solver.paired(elastic, interface)
    return replace(prepared, interface=interface, solver=solver)


def wearing_at(prepared: Prepared, interface: Interface) -> Prepared:
    """The model with its sides that wear as other pairs see them."""
    if prepared.wearing is None:
        return prepared
    return replace(prepared, wearing=worn_sides(prepared.space, prepared.model, interface))


def where_bodies_are(prepared: Prepared, state: State) -> Prepared:
    """The model with the pairs of where its bodies are, between strides; itself where nothing lies between the sides.

    What lies there stores energy by the areas of its pairs, which change as the sides slide.
    """
    interface, u = prepared.interface, state.displacement
    if not prepared.model.slides or not u.any() or (interface.closure is None and not interface.compliance.any()):
        return prepared
    found = paired_at(interface, prepared.space, prepared.model, prepared.constraints, prepared.frames, u)
    return replace(prepared, interface=found)


def stride_of(prepared: Prepared) -> float:
    """How far sides slide at most before pairs are made anew, length."""
    return _STRIDE * shortest_facet(prepared)


def shortest_facet(prepared: Prepared) -> float:
    """Of all contacts that slide far, length."""
    lengths = []
    for i, contact in enumerate(prepared.model.contacts):
        if contact.slides:
            sides = contact.meshed_sides(prepared.model.mesh)
            lengths += [float(boundary(prepared.space, side, ("contact", i)).lengths.min()) for side in sides]
    return min(lengths)
