# SPDX-License-Identifier: BSD-3-Clause
"""What changes make of an output while pairs, or motions and forces, stay as they are."""

from __future__ import annotations

from collections.abc import Mapping

from signorini.arrays import Array
from signorini.derivative.body_changes import BodyChange
from signorini.derivative.changes import LoadChange
from signorini.derivative.functionals import value
from signorini.derivative.moduli import ModulusChange
from signorini.derivative.view import HistoryView
from signorini.model.outputs import Displacement, Dissipation, Output, Stress, WeightedSum


def pulled_by(view: HistoryView, change: LoadChange, pulled: Mapping[int, Array], pulls: Mapping[int, Array]) -> float:
    """What a load or a moving support changes of an output of bodies while the pairs stay as they are.

    Parameters
    ----------
    view, change : the history, and the load
    pulled : (z,) by number of the point, see `Adjoint`
    pulls : (dofs,) how the output changes with displacements
    """
    found, name = 0.0, change.name
    for i, y in pulled.items():
        point = view.points[i]
        constraints, factor = point.system.prepared.constraints, change.factor(point)
        found += factor * float(y @ constraints.on_free(point.system.unit(name).forces))
        if name in constraints.prescribed:
            found += factor * float(pulls[i] @ constraints.prescribed[name])
    return found


def read_otherwise(output: Output, view: HistoryView, change: BodyChange | ModulusChange) -> float:
    """What a change of the bodies changes of an output while motions, forces and displacements stay.

    Parameters
    ----------
    output, view, change : the output of the history, and the change
    """
    if isinstance(output, Dissipation | Displacement):  # of motions and forces, or displacements, alone
        return 0.0
    if isinstance(change, ModulusChange) and not change.tilts and not isinstance(output, Stress | WeightedSum):
        return 0.0
    low, high = change.views(view)
    return (value(output, high) - value(output, low)) / (2.0 * change.step)
