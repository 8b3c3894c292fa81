# SPDX-License-Identifier: BSD-3-Clause
"""Refuse bodies that neither supports nor contact hold, by name and with their motion."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.errors import InputError
from signorini.fem.rigid import ConnectedBody, describe_motions, free_motions
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.interface.interface import Interface
from signorini.model.stage import Stage


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
    """A motion that neither supports nor contact can resist has no place that a solver could find.

    Parameters
    ----------
    space : unknowns
    constraints, interface : the supports and the pairs
    parts, motions : connected pieces, and (dofs, motions of all of them) their rigid motions

    Raises
    ------
    InputError
        If a part can move: with its motion.
    """
    dofs = space.dofs(np.unique(interface.B.indices // space.dimension)).ravel()
    touching = sp.csr_array((np.ones(len(dofs)), (np.arange(len(dofs)), dofs)), (len(dofs), space.number_of_dofs))
    free = free_motions(motions, constraints, touching)
    if free.shape[1]:
        raise InputError(f"{_say(parts, free)}: no support or contact holds it; add a support")
    rubbing = (interface.friction.rubs & (interface.anisotropy > 0).T).ravel()
    resisting = interface.B[np.concatenate([np.ones(len(interface), bool), rubbing])]
    free = free_motions(motions, constraints, resisting)
    if free.shape[1]:
        raise InputError(
            f"{_say(parts, free)}: nothing but frictionless contact, which cannot resist; add a support or friction"
        )


def _say(parts: tuple[ConnectedBody, ...], motions: Array) -> str:
    return ", and ".join(describe_motions(parts, motions))
