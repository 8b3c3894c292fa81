# SPDX-License-Identifier: BSD-3-Clause
"""Meshes that are refined where an answer lacks most, until it is as accurate as was asked."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from signorini.accuracy.bounds import Bounds
from signorini.accuracy.estimate import IN_SPACE, Estimate, estimate
from signorini.accuracy.halving import SolvedMesh, solved_with_halves
from signorini.accuracy.meshes import RefinedMeshes
from signorini.arrays import IntArray, among
from signorini.errors import InputError
from signorini.iterative.bodies import ITERATIVE
from signorini.model.accuracy import Accuracy, Asked
from signorini.model.links import Equation
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.model.outputs import Output
from signorini.solution.accuracy import AccuracyResult, MeshLevel
from signorini.solution.history import History


def accurate(model: Model, asked: Asked, solve: Callable[..., History]) -> History:
    """A history with what is known of its accuracy, on finer and finer meshes where one is asked for.

    Parameters
    ----------
    model : on the mesh to begin with, which says its shape
    asked : a relative error of the pressures, more of it, or "estimate": of the mesh as it is
    solve : a model that fits a mesh, with a tape where one is wanted; the history is certified, or says why it is not

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
    if request.of == "energy" and any(load.nodal_forces is not None for load in model.loads):
        words = "is that of stresses, which have no limit at forces given node by node; expected one of pressures"
        raise InputError(words, where=("accuracy",))
    return _refined(model, request, solve)


def _refined(model: Model, request: Accuracy, solve: Callable[..., History]) -> History:
    """On finer and finer meshes, until errors are below what was asked, or a bound ends it."""
    meshes, bounds = RefinedMeshes(model, request), Bounds(request, model.dimension)
    posed, levels, known = meshes.first(), list[MeshLevel](), None
    goal, before = None, None
    if isinstance(request.of, Output):
        from signorini.accuracy.goals import Goal, named, on_corners  # brings derivatives with it

        told = named(request.of, model)
        request, goal = replace(request, of=told), Goal(on_corners(told, model.mesh))

    def end(history: History, following: Model) -> str:
        nodes, more = (len(one.mesh.points) for one in (history.model, following))
        return bounds.end(nodes, more, len(levels), iterated=history.backend == ITERATIVE)

    while True:
        begun = time.perf_counter()
        try:
            if goal is None:
                mesh = SolvedMesh(model=posed, history=solve(posed, tape=None))
            else:
                mesh = solved_with_halves(posed, solve, goal.value, meshes, end)
            history = mesh.history
            if not history.solved:
                return history if known is None else _interrupted(known, history)
            if mesh.reason and known is not None:
                return _ended(known, mesh.reason)
            found = estimate(history, None if before is None else (meshes.simplices, *before))
            if goal is not None:
                found = goal.estimated(found, mesh)
        except InputError as error:
            if known is None:
                raise
            return _ended(known, f"on a finer mesh: {error}")
        levels.append(_level(mesh.model, found, time.perf_counter() - begun))
        met, reason = bounds.met(found, len(levels)), mesh.reason
        if not met and not reason:
            weights = found.squares if request.of == "energy" else found.weights
            posed = meshes.next(weights, bounds.growth(found, mesh.model, levels))
            reason = end(history, posed)
            if reason and len(levels) == 1 and found.of(request.of) <= request.error:
                reason = f"it is estimated on one mesh alone: {reason}"
        known = replace(history, accuracy=_result(found, tuple(levels), request, reason, meshes.notes))
        if met or reason:
            return known
        before = known, found


def _ended(known: History, reason: str) -> History:
    """What was solved on the mesh before, and why on no finer one."""
    return replace(known, accuracy=None if known.accuracy is None else replace(known.accuracy, reason=reason))


def _interrupted(known: History, history: History) -> History:
    """What was solved on the mesh before one on which a history has ended."""
    message = f"on a finer mesh: {history.message}; results are those of the mesh before"
    return replace(_ended(known, message), status=history.status, message=message)


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
    found = [("contacts that slide far", model.slides), ("contacts that wear", model.wears)]
    if whole:
        found += [
            ("cyclic symmetries in space", bool(model.cyclic_symmetries) and model.dimension == IN_SPACE),
            ("equations between the nodes of two sides", any(map(partial(_pairs, model.mesh), model.equations))),
        ]
    for name, there in found:
        if there:
            raise InputError(f"does not know {name}; expected a model without", where=("accuracy",))


def _pairs(mesh: Mesh, equation: Equation) -> bool:
    """Whether an equation goes from node to node of two places, one of which has more nodes on refined meshes."""
    named = {on for on, _, _ in equation.terms if isinstance(on, str) and (on in mesh.boundaries or on in mesh.nodes)}
    several = [mesh.nodes_of(name) for name in named if len(mesh.nodes_of(name)) > 1]
    return len(several) > 1 and any(_joined(mesh, nodes) for nodes in several)


def _joined(mesh: Mesh, nodes: IntArray) -> bool:
    """Whether some cell has two of some nodes: an edge between them may be halved."""
    held = among([nodes], len(mesh.points))
    return any(bool((np.count_nonzero(held[cells], axis=1) > 1).any()) for cells in mesh.cells.values())


def _known(number: float | None) -> float | None:
    """A number that is one; the first mesh has no error of an output yet."""
    return number if number is not None and np.isfinite(number) else None


def _level(model: Model, found: Estimate, seconds: float) -> MeshLevel:
    return MeshLevel(
        nodes=len(model.mesh.points),
        pairs=found.pairs,
        pressure=found.pressure,
        traction=found.traction,
        energy=found.energy,
        seconds=seconds,
        value=_known(found.value),
        output=_known(found.output),
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
        value=_known(found.value),
        output=_known(found.output),
    )
