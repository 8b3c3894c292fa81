# SPDX-License-Identifier: BSD-3-Clause
"""Outputs as functionals of motions and forces: what they are, and how they change with both."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.derivative.adjoint_terms import Weights
from signorini.derivative.points import TapePoint
from signorini.derivative.stress_output import StressOutput, node_of
from signorini.derivative.view import HistoryView
from signorini.errors import InputError
from signorini.interface.interface import Interface
from signorini.model.outputs import (
    AtNode,
    Displacement,
    Dissipation,
    HalfWidth,
    Mean,
    Moment,
    Output,
    Peak,
    Resultant,
    Stress,
    WeightedSum,
)

_HERTZ_LINE, _HERTZ_POINT = 4.0, 2.5  # half-width squared over the second moment of the pressure of Hertz


def value(output: Output, view: HistoryView) -> float:
    """What an output is."""
    if isinstance(output, WeightedSum):
        return sum(factor * value(part, view) for factor, part in output.parts)
    i = view.number(output.load_factor)
    if isinstance(output, Displacement | Stress):
        return _of_bodies(output, view, view.displacement(i))
    if isinstance(output, Dissipation):
        return _dissipation(output, view, i)[0]
    return _of_pairs(output, view, i)[0]


def weights(output: Output, view: HistoryView) -> dict[int, Weights]:
    """How an output of contacts changes with motions and forces of the pairs, by number of the point."""
    i = view.number(output.load_factor)
    if isinstance(output, Dissipation):
        return _dissipation(output, view, i)[1]
    _, h, r = _of_pairs(output, view, i)
    return {i: Weights(h=h, r=r)}


def weights_at_start(output: Output, view: HistoryView, ahead: TapePoint | None) -> Array:
    """(2, d - 1, n) How work changes with motions and friction of pairs where a history begins, which has part in it.

    Parameters
    ----------
    output, view : the output and the history; outputs that are no work do not change
    ahead : its beginning; None where that is one of its points
    """
    found = np.zeros((2, *view.motions(0)[1:].shape))
    for factor, part in output.parts if isinstance(output, WeightedSum) else ((1.0, output),):
        if isinstance(part, Dissipation) and ahead is not None:
            first = weights(part, replace(view, points=[ahead, *view.points]))[0]
            found += factor * np.stack([first.h[1:], first.r[1:]])
    return found


def displacement_weights(output: Displacement | Stress, view: HistoryView) -> Array:
    """(dofs,) How an output of bodies changes with displacements."""
    i = view.number(output.load_factor)
    d, space, constraints = view.model.components, view.space, view.points[i].system.prepared.constraints
    if isinstance(output, Displacement):
        return constraints.spread(space.dofs(np.array(output.node)), _along(output.along, d))
    stress = StressOutput(output, view)
    return constraints.spread(space.dofs(stress.nodes).ravel(), stress.weights(d).ravel())


def _of_bodies(output: Displacement | Stress, view: HistoryView, u: Array) -> float:
    """An output of bodies under displacements (dofs,) at a point."""
    if isinstance(output, Stress):
        stress = StressOutput(output, view)
        return stress.under(u[view.space.dofs(stress.nodes)])
    moved = u[view.space.dofs(np.array(node_of(output.node, view)))]
    return float(moved @ _along(output.along, view.model.components))


def _along(given: tuple[float, ...], dimension: int) -> Array:
    if len(given) != dimension:
        raise InputError(f"has {len(given)} components; expected {dimension}", where=("along",))
    return np.array(given)


def _of_pairs(output: Output, view: HistoryView, i: int) -> tuple[float, Array, Array]:
    """An output of contacts at a point, and how it changes with motions and forces (d, n) of all pairs there."""
    interface, r, h = view.interface, view.forces(i), view.motions(i)
    of_h, of_r = np.zeros_like(h), np.zeros_like(r)
    own = view.pairs(getattr(output, "contact", ""))
    if isinstance(output, Peak):
        k = np.flatnonzero(own)[int(np.argmax((r[0] / interface.area)[own]))]
        of_r[0, k] = 1.0 / interface.area[k]
    elif isinstance(output, AtNode):
        k = _pair(output, view, own, i)
        if output.field in ("pressure", "traction"):
            row = 0 if output.field == "pressure" else 1 + output.axis
            of_r[row, k] = 1.0 / interface.area[k]
        else:
            of_h[0 if output.field == "gap" else 1 + output.axis, k] = 1.0
    elif isinstance(output, Mean):
        weighted = np.array(output.weights) if output.weights else np.ones(int(own.sum()))
        if len(weighted) != own.sum():
            raise InputError(f"has {len(weighted)} weights; expected {own.sum()}", where=("weights",))
        of_r[0, own] = weighted / float(weighted @ interface.area[own])
    elif isinstance(output, Resultant):
        of_r[:, own] = _directions(view, _along(output.along, interface.directions), output.of)[:, own]
    elif isinstance(output, Moment):
        of_r[:, own] = _levers(output, view)[:, own]
    elif isinstance(output, HalfWidth):
        return _half_width(output, view, r, of_h)
    return float(np.vdot(of_h, h) + np.vdot(of_r, r)), of_h, of_r


def _pair(output: AtNode, view: HistoryView, own: BoolArray, i: int) -> int:
    """Number of the pair of a node."""
    found = np.flatnonzero(own & (view.interface.node == output.node))
    if not len(found):
        raise InputError(f"contact '{output.contact}' has no node {output.node}", where=("node",))
    if output.axis not in range(view.interface.directions - 1):
        raise InputError(f"is {output.axis}; expected the number of a tangent", where=("axis",))
    k = int(found[0])
    if k not in view.points[i].system.active and output.field in ("gap", "motion"):
        raise InputError(f"node {output.node} is too far from the other side to be looked at", where=("node",))
    return k


def _directions(view: HistoryView, along: Array, of: str) -> Array:
    """(d, n) Of unit forces of the pairs, their parts along a direction (d,)."""
    interface = view.interface
    rows = np.concatenate([(interface.normals @ along)[None], (interface.tangents @ along).T])
    if of == "pressure":
        rows[1:] = 0.0
    if of == "friction":
        rows[0] = 0.0
    return np.asarray(rows)


def _levers(output: Moment, view: HistoryView) -> Array:
    """(d, n) Moments of unit forces of the pairs about a point."""
    interface = view.interface
    d, n = interface.directions, len(interface)
    about, axis = _along(output.about, d), 0 if d == 2 else output.axis
    found = interface.moments.reshape(d, n, -1)[:, :, axis].copy()
    # the moment about x_0 is that about the origin less x_0 x f, which is linear in f as well
    whole = found + _directions(view, lever_arm(about, axis), "all")
    if output.of == "pressure":
        whole[1:] = 0.0
    if output.of == "friction":
        whole[0] = 0.0
    return np.asarray(whole)


def lever_arm(about: Array, axis: int) -> Array:
    """(d,) What forces are projected on for what a point (d,) that they turn about takes from their moment."""
    return np.array([about[1], -about[0]]) if len(about) == 2 else np.cross(about, np.eye(3))[axis]


def _half_width(output: HalfWidth, view: HistoryView, r: Array, none: Array) -> tuple[float, Array, Array]:
    own, interface = view.pairs(output.contact), view.interface
    if view.model.dimension == 3:
        raise InputError("half-widths are of contacts in the plane or axisymmetric")
    places, of_r = view.space.mesh.points[interface.node[own]], np.zeros_like(r)
    force = r[0, own]
    total = float(force.sum())
    if total <= 0.0:
        raise InputError(f"contact '{output.contact}' does not press; it has no half-width")
    if view.model.axisymmetric:
        s, factor = places[:, 0], _HERTZ_POINT
    else:
        tangent, factor = mean_tangent(interface, own), _HERTZ_LINE
        s = places @ tangent
        s = s - (float(force @ s) / total if not output.about else _along(output.about, 2) @ tangent)
    second = float(force @ s**2) / total
    width = float(np.sqrt(factor * second))
    if width <= 0.0:
        raise InputError(f"contact '{output.contact}' touches in one place; its half-width has no derivative")
    of_r[0, own] = 0.5 * factor * (s**2 - second) / (total * width)
    return width, none, of_r


def mean_tangent(interface: Interface, own: BoolArray) -> Array:
    """(d,) Unit vector along the mean tangent of some pairs (n,)."""
    tangent = interface.tangents[own, 0].mean(axis=0)
    return np.asarray(tangent / np.linalg.norm(tangent))


def _dissipation(output: Dissipation, view: HistoryView, last: int) -> tuple[float, dict[int, Weights]]:
    """What friction has taken: trapezoids between the ends of pieces, increments with the forces at their ends."""
    history, until = view.friction, slice(last + 1)
    h, r, seen = history.h[until], history.r[until], history.moves[until] & view.pairs(output.contact)
    known = history.known[until]
    seen[1:] &= known[:-1, None]
    moved, pushed = np.diff(h, axis=0, prepend=0.0), np.concatenate([np.zeros_like(r[:1]), r[:-1]])
    share = (0.5 + 0.5 * history.late[until])[:, None]  # of the force at the end of the piece
    mean, moved = (np.where(seen, part, 0.0) for part in (share * r + (1.0 - share) * pushed, moved))
    of_h, of_r = np.zeros((2, last + 1, 1 + h.shape[1], h.shape[2]))
    of_h[:, 1:], of_r[:, 1:] = -mean, -share * moved
    of_h[:-1, 1:] += mean[1:]
    of_r[:-1, 1:] -= ((1.0 - share) * moved)[1:]
    found = {i: Weights(h=of_h[i], r=of_r[i]) for i in range(last + 1)}
    return -float(np.vdot(mean, moved)), found
