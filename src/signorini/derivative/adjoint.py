# SPDX-License-Identifier: BSD-3-Clause
"""The adjoint of an output: of contacts, of bodies, or of a weighted sum of both, in one way back."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.derivative.adjoint_terms import Adjoint, Weights
from signorini.derivative.functionals import displacement_weights, weights
from signorini.derivative.points import TapePoint
from signorini.derivative.recursion import backward
from signorini.derivative.view import HistoryView
from signorini.model.outputs import Displacement, Output, Stress, WeightedSum


def adjoint_of(view: HistoryView, output: Output, stops: Collection[int] = ()) -> tuple[Adjoint, dict[int, Array]]:
    """The adjoint of an output, and how it changes with displacements (dofs,) by number of the point.

    Parameters
    ----------
    view : the history
    output : of it
    stops : as of `backward`
    """
    together: dict[int, Weights] = {}
    pulls: dict[int, Array] = {}
    for factor, part in output.parts if isinstance(output, WeightedSum) else ((1.0, output),):
        if isinstance(part, Displacement | Stress):
            i, pull = view.number(part.load_factor), factor * displacement_weights(part, view)
            pulls[i] = pulls[i] + pull if i in pulls else pull
            continue
        for i, weight in weights(part, view).items():
            _add(together, i, factor * weight.h, factor * weight.r)
    pulled, beyond = {}, {}
    for i, pull in pulls.items():
        of_h, of_r, pulled[i], beyond[i] = _of_bodies(view.points[i], len(view.interface), pull)
        _add(together, i, of_h, of_r)
    adjoint = backward(view.points, together, {i: -motion for i, motion in beyond.items()}, stops)
    return replace(adjoint, pulled=pulled, weights=together), pulls


def _add(together: dict[int, Weights], i: int, h: Array, r: Array) -> None:
    """Add how an output changes with motions and forces (d, n) at a point."""
    known = together.get(i)
    together[i] = Weights(h=h, r=r) if known is None else Weights(h=known.h + h, r=known.r + r)


def _of_bodies(point: TapePoint, count: int, pull: Array) -> tuple[Array, Array, Array, Array]:
    """What pulls on displacements, as an output of the pairs: with h and r (d, n), y (z,), and v (d, a).

    With ``u = K^-1 (f + B^T r) + Z a`` and a the travel of ``h - C r - h_0 - B K^-1 (f + B^T r)``
    (see `Condensed.displacement`), pull . u changes with h by v, with r by ``B y - (C + B K^-1 B^T) v``, with f by
    ``y = K^-1 pull`` directly, and with motions of the pairs that nothing else tells of by - v.

    Parameters
    ----------
    point : where the displacements are
    count : n, of all pairs
    pull : (dofs,)
    """
    system = point.system
    prepared, condensed, none = system.prepared, system.condensed, np.zeros(system.motions)
    on_free = prepared.constraints.on_free(pull)
    rows, flat = (system.directions, system.pairs), np.zeros(system.directions * system.pairs)
    y = condensed.response.displacement(condensed.reduce(on_free), flat, lambda _: none)
    rigid = prepared.constraints.of_free(prepared.rigid, prepared.floating)
    v = condensed.travel_transposed(rigid.T @ on_free) if system.motions else flat
    back = condensed.response.displacement(condensed.reduce(np.zeros_like(on_free)), v, lambda _: none)
    of_h, of_r = (np.zeros((system.directions, count)) for _ in range(2))
    of_h[:, system.active] = v.reshape(rows)
    seen = prepared.interface.motion(prepared.constraints.displaced(y - back))[:, system.active]
    of_r[:, system.active] = seen - condensed.compliance * v.reshape(rows)
    return of_h, of_r, y, v.reshape(rows)
