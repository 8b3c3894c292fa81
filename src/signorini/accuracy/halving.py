# SPDX-License-Identifier: BSD-3-Clause
"""A history on a mesh; for an output on that and then with the facets that touch halved, which tells what they lose."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from signorini.accuracy.meshes import RefinedMeshes
from signorini.accuracy.touching import touching_cells
from signorini.engine.tape import Tape
from signorini.model.model import Model
from signorini.solution.history import History


@dataclass(frozen=True, kw_only=True, eq=False)
class SolvedMesh:
    """What was solved on a mesh.

    Attributes
    ----------
    model, history : on it
    tape : of the history, where an output is asked for
    whole : the output before the facets that touch were halved; nan where they were not
    reason : why they were not, where a bound forbids it
    """

    model: Model
    history: History
    tape: Tape | None = None
    whole: float = float("nan")
    reason: str = ""


def solved_with_halves(
    model: Model,
    solve: Callable[..., History],
    value: Callable[[Model, Tape], float],
    meshes: RefinedMeshes,
    end: Callable[[History, Model], str],
) -> SolvedMesh:
    """A model solved as it is and then, where something touches and no bound forbids it, with halved facets.

    Parameters
    ----------
    model : on the last of the meshes
    solve : see :func:`signorini.accuracy.refine.accurate`
    value : of the output
    meshes : which are refined with the facets
    end : why a model is not solved after a history; empty: it is
    """
    tape = Tape()
    history = solve(model, tape=tape)
    touching = touching_cells(history, meshes.simplices.cells)
    if not history.solved or not touching.any():
        return SolvedMesh(model=model, history=history, tape=tape)
    finer, whole = meshes.halved(touching), value(model, tape)
    reason = end(history, finer)
    if reason:
        return SolvedMesh(model=model, history=history, tape=tape, reason=reason)
    tape = Tape()
    return SolvedMesh(model=finer, history=solve(finer, tape=tape), tape=tape, whole=whole)
