# SPDX-License-Identifier: BSD-3-Clause
"""Halves of a bolt whose meshes do not match: what one does in the mean around a node, the other does there."""

from __future__ import annotations

from functools import partial

import numpy as np

from signorini.arrays import Array
from signorini.errors import InputError
from signorini.fem.boundary import Boundary, boundary
from signorini.fem.measure import contact_measure
from signorini.fem.space import make_space
from signorini.interface.coupling import Coupling
from signorini.interface.mortar import mortar_coupling
from signorini.meshing.cut import HALF_ABOVE, HALF_BELOW
from signorini.model.links import AXES, Equation, Term
from signorini.model.model import Model

_COVERED = 1e-6  # of the area of a half: what may lie beside the other one
_WEIGHTLESS = 1e-12  # what a weight is by rounding alone


def mortar_equations(model: Model, section: str, normal: Array, *, name: str = "") -> list[Equation]:
    """``int psi (u_above - u_below + d n) dA = 0`` for the dual functions psi of the coarser half, in one plane.

    The d are the first displacement of the node of the section. Linear displacements of both halves that differ by d n
    fulfil them, and a uniform pressure passes.

    Parameters
    ----------
    model : with the section
    section : its name
    normal : (components,) n, of length 1
    name : of the equations, what messages call them

    Raises
    ------
    InputError
        If neither half lies on the other as a whole.
    """
    (below, above), space_labels = _sides(model, section), model.mesh.labels
    coarser = below if below.lengths.mean() >= above.lengths.mean() else above
    finer = above if coarser is below else below
    for nonmortar, mortar in ((coarser, finer), (finer, coarser)):
        found = mortar_coupling(nonmortar, mortar, measure=partial(contact_measure, model))
        if _covers(model, found, nonmortar):
            break
    else:
        raise InputError(
            f"the halves of section '{section}' do not lie on each other; expected one that the other covers as a whole"
        )
    # the half above moves by -d n against the one below
    sign = 1.0 if nonmortar is above else -1.0
    equations = []
    for node, row in zip(found.nodes, found.relative, strict=True):
        weights = dict(zip(row.indices.tolist(), row.data.tolist(), strict=True))
        own = weights.pop(int(node))
        for axis, part in zip(AXES, normal.tolist(), strict=False):
            terms: list[Term] = [(int(space_labels[node]), axis, own)]
            terms += [(int(space_labels[j]), axis, w) for j, w in weights.items() if abs(w) > _WEIGHTLESS]
            equations.append(Equation([*terms, *([(section, "x", sign * part)] if part else [])], name=name))
    return equations


def _sides(model: Model, section: str) -> tuple[Boundary, Boundary]:
    """Both halves as boundaries."""
    space = make_space(model.mesh, kind=model.kind, linked=np.concatenate(list(model.mesh.nodes.values())))
    below, above = (boundary(space, section + half, ()) for half in (HALF_BELOW, HALF_ABOVE))
    return below, above


def _covers(model: Model, found: Coupling, nonmortar: Boundary) -> bool:
    """Whether all of the nonmortar half has the other opposite it."""
    measure = partial(contact_measure, model)
    whole = sum(
        float((block.weights * measure(block.at, block.cells, block.cells)).sum()) for block in nonmortar.blocks
    )
    return bool(found.area.sum() >= (1.0 - _COVERED) * whole)
