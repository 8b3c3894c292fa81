# SPDX-License-Identifier: BSD-3-Clause
"""What one parameter changes of the answers of a history, forwards."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.derivative.derivative import TapedHistory
from signorini.derivative.functionals import weights
from signorini.derivative.recursion import PointChange
from signorini.errors import InputError
from signorini.model.outputs import Displacement, Output, Stress


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactTangent:
    """What a parameter changes of a contact, per unit of it.

    Attributes
    ----------
    name : of the contact
    node : (n,) node indices, from 0, as of the contact's result
    pressure, gap : (n,)
    traction, motion : (n,) along the tangent, in space (n, 2); of friction, and of the nodes since the beginning
    """

    name: str
    node: IntArray
    pressure: Array
    gap: Array
    traction: Array
    motion: Array


class HistoryTangent:
    """What one parameter changes of every answer.

    Parameters
    ----------
    history : the history
    changes : what the parameter changes at every point
    load_factor : where it is asked for; None at the end
    """

    def __init__(self, history: TapedHistory, changes: Sequence[PointChange], load_factor: float | None) -> None:
        self._history, self._changes = history, changes
        self._number = history.view.number(load_factor)

    def contact(self, name: str) -> ContactTangent:
        """What it changes of a contact, by name."""
        view, change = self._history.view, self._changes[self._number]
        own = view.pairs(name)
        area = view.interface.area[own]
        traction, motion = (change.r[1:, own] / area).T, change.h[1:, own].T
        plane = view.interface.directions == 2
        return ContactTangent(
            name=name,
            node=view.interface.node[own],
            pressure=change.r[0, own] / area,
            gap=change.h[0, own],
            traction=traction[:, 0] if plane else traction,
            motion=motion[:, 0] if plane else motion,
        )

    def of(self, output: Output) -> float:
        """What it changes of an output of contacts.

        Raises
        ------
        InputError
            For outputs of bodies: ask for the derivative of those.
        """
        if isinstance(output, Displacement | Stress):
            raise InputError(f"{output!r} is an output of bodies; ask for its derivative")
        found = 0.0
        for i, weight in weights(output, self._history.view).items():
            change = self._changes[i]
            found += float(np.vdot(weight.h, change.h) + np.vdot(weight.r, change.r))
        return found
