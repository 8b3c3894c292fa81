# SPDX-License-Identifier: BSD-3-Clause
"""Meshes that are refined where an answer lacks most, until it is as accurate as was asked."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from signorini.accuracy.contacts import ContactErrors, level_errors, trace_errors
from signorini.accuracy.meshes import RefinedMeshes, is_linear
from signorini.accuracy.recovery import stress_error
from signorini.arrays import Array
from signorini.errors import InputError
from signorini.fem.space import make_space
from signorini.fem.stress import DeformedBodies
from signorini.meshing.simplices import Simplices
from signorini.model.accuracy import Accuracy, Asked
from signorini.model.model import Model
from signorini.model.varying import NodeValues
from signorini.solution.accuracy import AccuracyResult, MeshLevel
from signorini.solution.history import History

LINEAR = 0.6
"""Of the differences that are seen on linear cells: what their pressures lack. Stresses recovered from cells in which
they are constant, and a mesh of twice the size, are farther from them than they are from the truth."""

SAFE_SHARE = 0.7
"""Of what was asked for: what the next mesh is made for."""

LEAST_GROWTH, MOST_GROWTH = 1.6, 3.0
"""How many times the cells of a mesh the next one has: with fewer solves add up, with more cells are where no errors
are."""

SHARE_OF_ROOM, SMALLEST_GROWTH = 0.9, 1.2
"""Of the nodes that a mesh may have: what it is made for where errors ask for more; the least growth worth a mesh."""

HALF_AS_MUCH = 0.5
"""Of the error of the mesh before: with more what differs from it is no more than what is lacking."""

LEVELS = 40
"""Meshes that are tried at most; each has some 1.5 times the nodes of the one before, so that nodes end it first."""

PAIRS = {2: 10, 3: 30}
"""Pairs that have to touch, at least, in the plane and in space: with fewer the ends of a contact are known to a tenth.
In space they are those of a circle of ten across, and of a quarter of one twice as large."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Estimate:
    """Estimated errors of a history on one mesh.

    Attributes
    ----------
    pressure, traction, energy : relative, of the step where each is largest
    squares : (m,) of the energy norm of every cell, of all steps together, work
    pairs : that touch at the end of the step where most do
    """

    pressure: float
    traction: float
    energy: float
    squares: Array
    pairs: int

    def of(self, what: str) -> float:
        """By the name that a request has."""
        return {"pressure": self.pressure, "traction": self.traction, "energy": self.energy}[what]


def estimate(history: History, before: tuple[Simplices, History] | None = None) -> Estimate:
    """What a history lacks at the ends of its steps.

    Parameters
    ----------
    history : solved
    before : the simplices that it was solved on, and the history of the mesh before with its accuracy
    """
    model = history.model
    space = make_space(model.mesh, kind=model.kind)
    traced, carried, pairs = list[ContactErrors](), list[ContactErrors](), 0
    squares, lost, norms = np.zeros(model.mesh.number_of_cells), [0.0], [0.0]
    for k, step in enumerate(history.steps):
        stress = stress_error(DeformedBodies.of(space, model, step.displacement, step.factors))
        squares += stress.squares
        lost.append(float(stress.squares.sum()))
        norms.append(stress.norm_square)
        traced.append(trace_errors(space, model, step.contacts, stress))
        if before is not None:
            carried.append(level_errors(step.contacts, _carried(before, k)))
        pairs = max(pairs, sum(int(contact.closed.sum()) for contact in step.contacts))
    energy = float(np.sqrt(max(lost) / max(norms))) if max(norms) > 0.0 else 0.0
    known = None if before is None else before[1].accuracy
    found = traced + [one.scaled(_level_share(energy, known.energy)) for one in carried if known is not None]
    size, share = max((one.scale for one in traced), default=0.0), LINEAR if is_linear(model) else 1.0
    return Estimate(
        pressure=share * _ratio(max((one.pressure for one in found), default=0.0), size),
        traction=share * _ratio(max((one.pressure + one.friction for one in found), default=0.0), size),
        energy=energy,
        squares=squares,
        pairs=pairs,
    )


def accurate(model: Model, asked: Asked, solve: Callable[[Model], History]) -> History:
    """A history with what is known of its accuracy, on finer and finer meshes where one is asked for.

    Parameters
    ----------
    model : on the mesh to begin with, which says its shape
    asked : a relative error of the pressures, more of it, or "estimate": of the mesh as it is
    solve : a model that fits a mesh; the history is certified, or says why it is not

    Raises
    ------
    InputError
        For what is no accuracy, and models whose accuracy is not known, by name.
    """
    if asked == "estimate":
        refuse(model)
        history = solve(model)
        return replace(history, accuracy=_result(estimate(history), (), None)) if history.solved else history
    try:
        request = asked if isinstance(asked, Accuracy) else Accuracy(asked)
    except InputError as error:
        words = f"is {asked!r}; expected a relative error > 0, an Accuracy or 'estimate'"
        raise InputError(words, where=("accuracy",)) from error
    refuse(model, whole=True)
    if request.of != "energy" and not model.contacts:
        raise InputError("is that of pressures, and there is no contact; expected of = 'energy'", where=("accuracy",))
    return _refined(model, request, solve)


def _refined(model: Model, request: Accuracy, solve: Callable[[Model], History]) -> History:
    """On finer and finer meshes, until errors are below what was asked, or a bound ends it."""
    meshes, start = RefinedMeshes(model, request), time.perf_counter()
    posed, levels, known = meshes.first(), list[MeshLevel](), None
    while True:
        begun = time.perf_counter()
        history = solve(posed)
        if not history.solved:
            return history if known is None else _interrupted(known, history)
        found = estimate(history, None if known is None else (meshes.simplices, known))
        levels.append(_level(posed, found, time.perf_counter() - begun))
        met, reason = _met(request, found, model.dimension, len(levels)), ""
        if not met:
            posed = meshes.next(found.squares, _growth(request, found, posed))
            reason = _end(request, len(posed.mesh.points), time.perf_counter() - start, len(levels))
            if reason and len(levels) == 1 and found.of(request.of) <= request.error:
                reason = f"it is estimated on one mesh alone: {reason}"
        known = replace(history, accuracy=_result(found, tuple(levels), request, reason, meshes.notes))
        if met or reason:
            return known


def _interrupted(known: History, history: History) -> History:
    """What was solved on the mesh before one on which a history has ended."""
    message = f"on a finer mesh: {history.message}; results are those of the mesh before"
    accuracy = None if known.accuracy is None else replace(known.accuracy, reason=message)
    return replace(known, status=history.status, message=message, accuracy=accuracy)


def refuse_one_mesh(asked: Asked | None, **given: bool) -> None:
    """Refuse what belongs to one mesh where it is refined.

    Parameters
    ----------
    asked : of the accuracy
    given : by the name that the user calls it, whether it is there

    Raises
    ------
    InputError
        With that name.
    """
    for name, there in given.items():
        if there and asked is not None and asked != "estimate":
            raise InputError("belongs to one mesh; expected none where it is refined to an accuracy", where=(name,))


def refuse(model: Model, *, whole: bool = False) -> None:
    """Refuse models whose accuracy is not known.

    Parameters
    ----------
    model : that is asked about
    whole : to be solved on other meshes, too

    Raises
    ------
    InputError
        With what it has that an estimate, or another mesh, does not know.
    """
    found = [("bodies that yield", model.yields), ("contacts that slide far", model.slides)]
    found += [("contacts that wear", model.wears)]
    if whole:
        found += [("bolts", bool(model.bolts)), ("cyclic symmetries", bool(model.cyclic_symmetries))]
        found += [
            ("equations", bool(model.equations)),
            ("forces given node by node", any(_by_nodes(load.nodal_forces) for load in model.loads)),
        ]
        found += [("values given node by node", any(map(_by_nodes, _varying(model))))]
    for name, there in found:
        if there:
            raise InputError(f"does not know {name}; expected a model without", where=("accuracy",))


def _varying(model: Model) -> Iterator[object]:
    """All that may be given node by node."""
    for load in model.loads:
        yield from (load.temperature, load.pressure, load.traction)
    for support in model.supports:
        yield from support.u
    for contact in model.contacts:
        yield from (contact.gap, contact.interference)


def _by_nodes(value: object) -> bool:
    return isinstance(value, np.ndarray | NodeValues)


def _carried(before: tuple[Simplices, History], step: int) -> list[tuple[Array, Array]]:
    """Of every contact pressure and friction of the mesh before at the corners of this one."""
    simplices, history = before
    older = int((simplices.parents[:, 0] == simplices.parents[:, 1]).sum())
    found = []
    for contact in history.steps[step].contacts:
        values = np.zeros((older, 1 + contact.normals.shape[1]))
        values[contact.node, 0], values[contact.node, 1:] = contact.pressure, contact.shear
        carried = simplices.carried(values)
        found.append((carried[:, 0], carried[:, 1:]))
    return found


def _met(request: Accuracy, found: Estimate, dimension: int, levels: int) -> bool:
    """Whether errors are small enough, of pressures on two meshes and with enough pairs."""
    if found.of(request.of) > request.error:
        return False
    return request.of == "energy" or (levels > 1 and found.pairs >= PAIRS[dimension])


def _rate(model: Model) -> float:
    """Power of the number of nodes with which errors fall."""
    return (1.0 if is_linear(model) else 2.0) / model.dimension


def _growth(request: Accuracy, found: Estimate, model: Model) -> float:
    """Of the number of cells, as far as errors that fall as usual ask for it."""
    needed = (found.of(request.of) / (SAFE_SHARE * request.error)) ** (1.0 / _rate(model))
    room = SHARE_OF_ROOM * request.nodes / len(model.mesh.points)
    return min(max(needed, LEAST_GROWTH), MOST_GROWTH, room if room > SMALLEST_GROWTH else MOST_GROWTH)


def _level_share(energy: float, before: float) -> float:
    """Of the square of the difference from the mesh before: what this one lacks of it, where errors fall as in energy.

    Parameters
    ----------
    energy, before : errors of the stresses on both
    """
    fall = energy / before if before > 0.0 else 1.0
    return (fall / (1.0 - fall)) ** 2 if fall < HALF_AS_MUCH else 1.0


def _end(request: Accuracy, nodes: int, seconds: float, levels: int) -> str:
    """Why no finer mesh is tried; empty: it is."""
    if nodes > request.nodes:
        return f"the next mesh has {nodes} nodes, more than {request.nodes}"
    if request.seconds is not None and seconds > request.seconds:
        return f"{seconds:.1f} s have passed, more than {request.seconds:g}"
    return f"{levels} meshes were tried" if levels >= LEVELS else ""


def _ratio(square: float, scale: float) -> float:
    """Root of a square over a scale; 1 where nothing presses."""
    return float(np.sqrt(square / scale)) if scale > 0.0 else 1.0


def _level(model: Model, found: Estimate, seconds: float) -> MeshLevel:
    return MeshLevel(
        nodes=len(model.mesh.points),
        pairs=found.pairs,
        pressure=found.pressure,
        traction=found.traction,
        energy=found.energy,
        seconds=seconds,
    )


def _result(
    found: Estimate,
    levels: tuple[MeshLevel, ...],
    request: Accuracy | None,
    reason: str = "",
    notes: tuple[str, ...] = (),
) -> AccuracyResult:
    total = found.squares.sum()
    return AccuracyResult(
        pressure=found.pressure,
        traction=found.traction,
        energy=found.energy,
        cells=found.squares / total if total > 0.0 else found.squares,
        levels=levels,
        asked=request,
        reason=reason,
        notes=notes,
    )
