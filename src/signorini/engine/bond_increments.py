# SPDX-License-Identifier: BSD-3-Clause
"""Straight parts of a step with bonds that are followed in increments, not exactly."""

from __future__ import annotations

from dataclasses import replace

from signorini.engine.bond_solver import BondSolver
from signorini.engine.step_parts import FollowedPart, StepPart

BOND_INCREMENTS = 64
"""Of a straight part, at which it ends whatever more of them would change where no number is asked for."""

_BROKEN = (
    "bonds let go within increments; the equilibrium behind is a candidate: inertia, or shorter ones, may lead "
    "elsewhere, and what that sets free is missing in the energy"
)


def with_increments(part: StepPart) -> StepPart:
    """A part of a step whose bonds are followed in increments."""
    paths = part.prepared.solver.paths
    if paths is None:
        return part
    return replace(
        part, prepared=replace(part.prepared, solver=BondSolver(bodies=paths, labels=part.prepared.model.mesh.labels))
    )


def told_of_breaks(part: StepPart, followed: FollowedPart) -> FollowedPart:
    """A part as it was followed, with a note where bonds have let go."""
    before, after = part.before.bonds, followed.after.bonds
    if before is None or after is None or not ((before.damage < 1.0) & (after.damage == 1.0)).any():
        return followed
    return replace(followed, notes=(*followed.notes, f"{part.where}: {_BROKEN}"))
