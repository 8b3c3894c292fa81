# SPDX-License-Identifier: BSD-3-Clause
"""An output that is to be accurate: what it is on a mesh, and how much the errors of every cell count for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import cast

import numpy as np

from signorini.accuracy.estimate import Estimate
from signorini.accuracy.halving import SolvedMesh
from signorini.accuracy.output_error import OutputLevel, output_error
from signorini.accuracy.recovery import StressRecovery
from signorini.arrays import Array
from signorini.derivative.dual import dual_displacement
from signorini.derivative.functionals import value
from signorini.derivative.taped_history import TapedHistory
from signorini.engine.tape import Tape
from signorini.errors import InputError, one_of
from signorini.fem.stress import DeformedBodies
from signorini.meshing.simplices import corner_numbers
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.model.outputs import AtNode, Displacement, Dissipation, Mean, Output, Peak, Stress, WeightedSum

_WHERE = ("accuracy", "of")


class Goal:
    """An output that is to be accurate, on mesh after mesh.

    Parameters
    ----------
    output : on the corners of the mesh to begin with
    """

    def __init__(self, output: Output) -> None:
        self._output, self._levels = output, list[OutputLevel]()

    def value(self, model: Model, tape: Tape) -> float:
        """The output; nan where nothing presses, or in one place alone.

        Parameters
        ----------
        model, tape : solved
        """
        try:
            return value(self._output, TapedHistory(tape, model).view)
        except InputError:
            return float("nan")

    def estimated(self, found: Estimate, mesh: SolvedMesh) -> Estimate:
        """An estimate with what is asked for: the output, its error, and cells by what their errors count for it.

        Half of a cell's share is the product of its errors of stresses and of dual ones, half is what counts for
        pressures, since what is lost between the nodes of a contact no dual stress tells.

        Parameters
        ----------
        found : without it
        mesh : solved

        Raises
        ------
        InputError
            By name, what derivatives do not know.
        """
        assert mesh.tape is not None
        number, products, signed = self.products(mesh.model, mesh.tape)
        length = float(len(products)) ** (-1.0 / mesh.model.dimension)
        self._levels.append(OutputLevel(value=number, whole=mesh.whole, length=length, signed=signed))
        lacks = output_error(self._levels)
        shares = [part / part.sum() for part in (products, found.weights) if part.sum() > 0.0]
        return replace(
            found,
            value=number,
            output=lacks / abs(number) if number and np.isfinite(number) else float("inf"),
            weights=sum(shares, np.zeros(len(products))),
        )

    def products(self, model: Model, tape: Tape) -> tuple[float, Array, float]:
        """The output, of every cell the product of its errors of stresses and of dual ones in energy, and their work.

        The work of two errors is half of what that of their sum has more than they have: one of them is scaled, so that
        neither is lost in rounding. It is what the output lacks of the stresses, more of it where it is > 0.

        Parameters
        ----------
        model, tape : solved

        Raises
        ------
        InputError
            For bolts that lock.
        """
        view, output = TapedHistory(tape, model).view, self._output
        if view.points[-1].system.locked:  # what is lost before they lock would be missing
            raise InputError("does not know bolts that lock", where=_WHERE)
        try:
            found, dual = value(output, view), dual_displacement(view, output)
        except InputError:  # nothing presses yet, or in one place alone
            return float("nan"), np.zeros(model.mesh.number_of_cells), 0.0
        point = view.points[view.number(output.load_factor)]
        motion = view.displacement(view.number(output.load_factor))

        recovery = StressRecovery(view.space, model)

        def squares(u: Array, factors: Mapping[str, float]) -> Array:
            at_nodes = view.space.at_nodes(u)[: len(model.mesh.points)]
            return recovery.error(DeformedBodies.of(view.space, model, at_nodes, factors)).squares

        own, of_dual = squares(motion, point.load.factors), squares(dual, {})
        scale = float(np.sqrt(own.sum() / of_dual.sum())) if own.any() and of_dual.any() else 1.0
        both = squares(motion + scale * dual, point.load.factors)
        work = float((both - own - scale**2 * of_dual).sum()) / (2.0 * scale)
        return found, np.sqrt(own * of_dual), work


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
