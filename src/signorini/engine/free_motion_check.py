# SPDX-License-Identifier: BSD-3-Clause
"""Refuse bodies that neither supports nor contact hold, in any step, by name and with their motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.errors import InputError
from signorini.fem.rigid import ConnectedBody, describe_motions, free_motions
from signorini.fem.space import Space
from signorini.fem.supports import Constraints, make_constraints
from signorini.interface.interface import Interface, pairs_of
from signorini.model.model import Model
from signorini.model.stage import Stage


def refuse_unheld(
    model: Model,
    space: Space,
    constraints: Constraints,
    interface: Interface,
    parts: tuple[ConnectedBody, ...],
    motions: sp.csr_array,
    schedule: Sequence[Stage],
) -> None:
    """Look at every step with other supports or contacts than those before, ahead of solving any.

    Parameters
    ----------
    constraints : under the supports of the first step

    Raises
    ------
    InputError
        If a body can move: with its motion, and with what lets it go.
    """
    seen = set()
    for stage in schedule:
        if (stage.released, stage.inactive) in seen:
            continue
        seen.add((stage.released, stage.inactive))
        alike = stage.released == schedule[0].released
        now = constraints if alike else make_constraints(space, model, without=stage.released)
        left = interface.among(~pairs_of(model, interface, stage.inactive)) if stage.inactive else interface
        try:
            refuse_free_motions(space, now, left, parts, motions)
        except InputError as error:
            raise left_out(error, stage) from error


def left_out(error: InputError, stage: Stage) -> InputError:
    """What is wrong in a step, with the supports and contacts that it does without, and where the step says so."""
    missing = sorted(stage.released | stage.inactive)
    if not missing:
        return error
    where = error.where or ("step", stage.number - 1, "inactive" if stage.inactive else "release")
    return InputError(f"without {', '.join(missing)}, {error.message}", where=where)


def refuse_free_motions(
    space: Space,
    constraints: Constraints,
    interface: Interface,
    parts: tuple[ConnectedBody, ...],
    motions: sp.csr_array,
) -> None:
    """A motion that neither supports nor contact can resist has no place that a solver could find."""
    dofs = space.dofs(np.unique(interface.B.indices // space.dimension)).ravel()
    touching = sp.csr_array((np.ones(len(dofs)), (np.arange(len(dofs)), dofs)), (len(dofs), space.number_of_dofs))
    free = free_motions(motions, constraints, touching)
    if free.shape[1]:
        raise InputError(f"{_say(parts, free)}: no support or contact holds it; add a support")
    along = interface.coefficients + interface.adhesion[:, None] * interface.anisotropy
    rubbing = (along > 0).T.ravel()
    resisting = interface.B[np.concatenate([np.ones(len(interface), bool), rubbing])]
    free = free_motions(motions, constraints, resisting)
    if free.shape[1]:
        raise InputError(
            f"{_say(parts, free)}: nothing but frictionless contact, which cannot resist; add a support or friction"
        )


def _say(parts: tuple[ConnectedBody, ...], motions: Array) -> str:
    return ", and ".join(describe_motions(parts, motions))
