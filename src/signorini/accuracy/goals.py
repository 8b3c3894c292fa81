# SPDX-License-Identifier: BSD-3-Clause
"""An output that is to be accurate: what it is on a mesh, and how much the errors of every cell count for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import numpy as np

from signorini.accuracy.estimate import Estimate
from signorini.accuracy.recovery import stress_error
from signorini.arrays import Array
from signorini.derivative.derivative import TapedHistory
from signorini.derivative.dual import dual_displacement
from signorini.derivative.functionals import value
from signorini.engine.tape import Tape
from signorini.errors import InputError, one_of
from signorini.fem.stress import DeformedBodies
from signorini.meshing.simplices import corner_numbers
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.model.outputs import AtNode, Displacement, Dissipation, Mean, Output, Peak, Stress, WeightedSum
from signorini.solution.accuracy import MeshLevel

_WHERE = ("accuracy", "of")


def with_output(
    found: Estimate, levels: Sequence[MeshLevel], model: Model, tape: Tape | None, output: Output
) -> Estimate:
    """An estimate with what is asked for: an output, its error, and cells by what their errors count for it.

    Half of a cell's share is that of its stresses, since what is lost at the end of a contact no dual stress tells.

    Parameters
    ----------
    found : without it
    levels : of the meshes before
    model, tape : that was solved, and its history
    output : on the corners of the mesh

    Raises
    ------
    InputError
        By name, what derivatives do not know.
    """
    assert tape is not None
    value, products = _goal(model, tape, output)
    values = [*(float("nan") if level.value is None else level.value for level in levels), value]
    nodes = [*(level.nodes for level in levels), len(model.mesh.points)]
    lacks = _lacks(values, nodes, float(products.sum()))
    shares = [part / part.sum() for part in (products, found.squares) if part.sum() > 0.0]
    return replace(
        found,
        value=value,
        output=lacks / abs(value) if value and np.isfinite(value) else float("inf"),
        weights=sum(shares, np.zeros(len(products))),
    )


def _goal(model: Model, tape: Tape, output: Output) -> tuple[float, Array]:
    """An output, and of every cell the product of its errors in energy, of stresses and of dual ones."""
    view = TapedHistory(tape, model).view
    try:
        found, dual = value(output, view), dual_displacement(view, output)
    except InputError:  # nothing presses yet, or in one place alone
        return float("nan"), np.zeros(model.mesh.number_of_cells)
    i, nodes = view.number(output.load_factor), len(model.mesh.points)
    squares = [
        stress_error(DeformedBodies.of(view.space, model, view.space.at_nodes(u)[:nodes], factors)).squares
        for u, factors in ((view.displacement(i), view.points[i].load.factors), (dual, {}))
    ]
    return found, np.sqrt(squares[0] * squares[1])


def _lacks(values: Sequence[float], nodes: Sequence[int], products: float) -> float:
    """Estimated error of an output, of its own kind.

    The largest of: what errors of stresses come to, all of one sign; what is left of what the last mesh has changed,
    where errors fall with the number of nodes; and the same of the mesh before that.

    Parameters
    ----------
    values, nodes : on all meshes so far
    products : sum over the cells of errors of stresses and of dual ones
    """
    found = [products]
    for i in range(max(len(values) - 2, 1), len(values)):
        growth = nodes[i] / nodes[i - 1]
        found.append(abs(values[i] - values[i - 1]) / max(growth - 1.0, 0.5) * nodes[i] / nodes[-1])
    return max(found) if np.isfinite(found).all() and len(values) > 1 else float("inf")


def named(output: Output, model: Model) -> Output:
    """An output with the name of the only contact, where it has none.

    Parameters
    ----------
    output : asked for
    model : whose contacts and bodies it may name

    Raises
    ------
    InputError
        For a contact or a body that there is not, and weights, which belong to one mesh.
    """
    if isinstance(output, WeightedSum):
        return replace(output, parts=tuple((factor, named(part, model)) for factor, part in output.parts))
    contacts, bodies = [contact.label for contact in model.contacts], [body.name for body in model.bodies]
    if isinstance(output, Mean) and output.weights:
        raise InputError(f"{output!r}: weights belong to one mesh; expected none", where=_WHERE)
    for key, known in (("contact", contacts), ("body", bodies)):
        name = getattr(output, key, "")
        if name and name not in known:
            raise InputError(one_of(name, known, key), where=_WHERE)
    if getattr(output, "contact", None) != "" or isinstance(output, Dissipation):
        return output
    if len(contacts) != 1:
        raise InputError(f"{output!r} names no contact; expected one of {', '.join(contacts)}", where=_WHERE)
    return replace(cast(Peak, output), contact=contacts[0])


def on_corners(output: Output, mesh: Mesh) -> Output:
    """An output with the numbers that its nodes have where a mesh is refined: of corners alone.

    Raises
    ------
    InputError
        For nodes that are no corners.
    """
    if isinstance(output, WeightedSum):
        return replace(output, parts=tuple((factor, on_corners(part, mesh)) for factor, part in output.parts))
    if not isinstance(output, AtNode | Displacement | Stress):
        return output
    numbers = corner_numbers(mesh)
    if not 0 <= output.node < len(numbers) or numbers[output.node] < 0:
        words = f"is node {output.node}; expected the number of a corner of some cell, from 0 to {len(numbers) - 1}"
        raise InputError(words, where=_WHERE)
    return replace(output, node=int(numbers[output.node]))
