# SPDX-License-Identifier: BSD-3-Clause
"""Displacements of the bodies that are dual to an output: by them errors of stresses count for it."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.derivative.adjoint import adjoint_of
from signorini.derivative.view import HistoryView
from signorini.model.outputs import Output


def dual_displacement(view: HistoryView, output: Output) -> Array:
    """(dofs,) Of ``K w = B^T J + Z j``, J and j how the output changes with what drives the bodies in every state.

    Those of all states of one interface are summed, each as far as that at which the output is asked for is in it: then
    ``int s(u) : C^-1 : s(w)`` is what the output has of the stresses.

    Parameters
    ----------
    view : the history
    output : asked for at the end of a straight part of its loads
    """
    adjoint, _ = adjoint_of(view, output)
    last = view.number(output.load_factor)
    point = view.points[last]
    system = point.system
    T, condensed = system.prepared.constraints.transform, system.condensed
    motion, resultant = np.zeros((system.directions, system.pairs)), np.zeros(system.motions)
    pulled = np.zeros(T.shape[1])
    for i in sorted({*adjoint.terms, *adjoint.pulled}):
        other = view.points[i]
        if other.system is not system:
            continue
        share = float(np.vdot(other.r, point.r)) / (float(np.vdot(point.r, point.r)) or 1.0)
        if i in adjoint.terms:
            motion += share * adjoint.terms[i].motion
            resultant += share * adjoint.terms[i].resultant
        if i in adjoint.pulled:
            pulled += share * adjoint.pulled[i]
    still = condensed.reduce(np.zeros(T.shape[1]))
    return np.asarray(T @ (condensed.response.displacement(still, motion.ravel(), lambda _: resultant) + pulled))
