# SPDX-License-Identifier: BSD-3-Clause
"""The main answers of a history by all that is given, per cent for per cent: what matters, and how far that holds."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.derivative.derivative import Derivative
from signorini.derivative.functionals import value
from signorini.derivative.parameters import given_value, names_of
from signorini.derivative.taped_history import TapedHistory
from signorini.derivative.view import HistoryView
from signorini.errors import InputError
from signorini.model.outputs import Output, dissipation, force, halfwidth, pressure
from signorini.solution.sensitivities import Sensitivities, Validity

_KINDS = ("friction", "interference", "load", "support", "E", "nu", "expansion")
_RUBS = 1e-6  # of the normal force of a contact: the least friction force that is a main output


def sensitivities(history: TapedHistory) -> Sensitivities:
    """The main answers at the end of a history by all parameters that are not zero."""
    view, prepared = history.view, history.prepared
    derivatives = [Derivative(history, output) for output in main_outputs(view)]
    names, given, rows, holds, refused = [], [], [], [], []
    for kind in _KINDS:
        for name in names_of(prepared, kind):
            size = given_value(prepared, kind, name)
            if not size or not np.isfinite(size) or (kind == "expansion" and not prepared.model.heats):
                continue
            try:
                row = [size * derivative.by(f"{kind}.{name}") / derivative.value for derivative in derivatives]
            except InputError as error:
                refused.append(f"{kind}.{name}: {error}")
                continue
            names.append(f"{kind}.{name}")
            given.append(size)
            rows.append(row)
            holds.append(_in_per_cent(history, kind, name, size))
    return Sensitivities(
        outputs=tuple(repr(derivative.output) for derivative in derivatives),
        values=np.array([derivative.value for derivative in derivatives]),
        parameters=tuple(names),
        given=np.array(given),
        per_cent=np.array(rows).reshape(len(names), len(derivatives)),
        holds=tuple(holds),
        refused=tuple(refused),
    )


def main_outputs(view: HistoryView) -> list[Output]:
    """Peak pressure, resultants and half-width of every contact that presses, and what friction has taken."""
    found: list[Output] = []
    last, interface = len(view.points) - 1, view.interface
    forces, flat = view.forces(last), view.interface.directions == 2
    for number, contact in enumerate(view.model.contacts):
        own = interface.contact == number
        pressing = float(forces[0, own].sum())
        if contact.tied or pressing <= 0.0:
            continue
        found.append(pressure(contact.label).peak)
        rubbing = forces[1:, own].sum(axis=1)
        normal, tangent = (_axis(rows[own].mean(axis=0)) for rows in (interface.normals, interface.tangents[:, 0]))
        found.append(force(contact.label, along=normal, of="pressure"))
        if flat and not view.model.axisymmetric and abs(rubbing[0]) > _RUBS * pressing:
            found.append(force(contact.label, along=tangent, of="friction"))
        if flat:
            found.append(halfwidth(contact.label, about=_middle(view, own)))
    if value(dissipation(), view) > 0.0:
        found.append(dissipation())
    return found


def _in_per_cent(history: TapedHistory, kind: str, name: str, given: float) -> Validity:
    """In which changes of a parameter, in per cent of what is given, the sequence of events stays."""
    found = history.holds(kind, name)
    low, high = sorted((100.0 * found.low / given, 100.0 * found.high / given))
    return Validity(low=low, high=high, ends=found.ends if given > 0.0 else found.ends[::-1])


def _axis(direction: Array) -> tuple[float, ...]:
    """The axis that is nearest to a direction, either way."""
    k = int(np.abs(direction).argmax())
    return tuple(float(np.copysign(i == k, direction[i])) + 0.0 for i in range(len(direction)))


def _middle(view: HistoryView, own: BoolArray) -> tuple[float, ...]:
    """The place of the one pair of some, (n,), that a plane of symmetry keeps from sliding; nothing where none is."""
    system = view.points[-1].system
    pairs = system.active[system.law.locked[0] & own[system.active]]
    if len(pairs) != 1:
        return ()
    return tuple(float(x) for x in view.model.mesh.points[view.interface.node[pairs[0]]])
