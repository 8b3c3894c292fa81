# SPDX-License-Identifier: BSD-3-Clause
"""A model on its mesh, and what can be checked of it without solving."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, distinct
from signorini.engine.bolts import with_bolts
from signorini.engine.bond_company import refuse_beside_bonds
from signorini.engine.duplicate_check import refuse_idle, refuse_same_contacts
from signorini.engine.fatigue_places import refuse_requests
from signorini.engine.overlaps import with_overlaps
from signorini.errors import InputError
from signorini.fem.body_frames import BodyFrames
from signorini.fem.links import linked_nodes
from signorini.fem.loads import nodal_loads
from signorini.fem.locking import refuse_locking
from signorini.fem.rigid import ConnectedBody, connected_bodies, describe_motions, free_motions
from signorini.fem.rigid_motions import RigidMotions, resistance
from signorini.fem.space import Space, make_space
from signorini.fem.supports import Constraints, make_constraints
from signorini.fem.turning_bodies import turning_bodies
from signorini.interface.interface import Interface, make_interface, pairs_of
from signorini.interface.sectors import sector_interface
from signorini.model.model import Model
from signorini.model.stage import Stage, Standing, stages
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.scale import Loading, Scale, data_scale, loading_of
from signorini.sparse_rows import chosen_rows


@dataclass(frozen=True, kw_only=True, eq=False)
class Examined:
    """A model on its mesh, checked; nothing is assembled yet.

    Attributes
    ----------
    always : what supports hold that no step lets go: planes of symmetry of the pairs
    loads : name to nodal forces at factor 1, each (dofs,)
    parts, rigid : connected pieces and their rigid motions
    resisted : (motions, motions) what supports and foundations take of them, see `fem.rigid_motions.resistance`
    floating : (motions, k) rigid motions that supports leave free and contact must hold
    frames : of bodies that may turn by any angle
    loading : the most that its first step imposes, or steps before it did
    scale : the sizes that go with it
    """

    model: Model
    space: Space
    constraints: Constraints
    always: Constraints
    interface: Interface
    loads: Mapping[str, Array]
    parts: tuple[ConnectedBody, ...]
    rigid: RigidMotions
    resisted: Array
    floating: Array
    frames: BodyFrames
    loading: Loading
    scale: Scale

    @property
    def motions(self) -> sp.csr_array:
        """(dofs, motions of all parts), see :func:`signorini.fem.rigid_motions.rigid_motions`."""
        return self.rigid.matrix

    @property
    def has_laws(self) -> bool:
        """Whether any pair closes by a law or is bonded."""
        return self.interface.closure is not None or self.interface.cohesion is not None

    @property
    def turns(self) -> bool:
        """Whether any body may turn by any angle."""
        return self.model.slides and bool(self.frames)


def examine(model: Model, *, start: Checkpoint | None = None) -> Examined:
    """Put a model on its mesh and check what can be checked without solving.

    Parameters
    ----------
    start : from which its history goes on

    Raises
    ------
    InputError
        If something in the model does not fit the mesh or the start, a load never acts, two contacts are between the
        same sides, or a body can move freely: it is named, with its motion.
    """
    if model.bolts:
        model = with_bolts(model)
    if any(step.varies for step in model.steps):
        model = with_overlaps(model)
    refuse_locking(model)
    factors = {} if start is None else start.state.point.factors
    before = Standing() if start is None else start.standing
    refuse_idle(model, factors)
    schedule = list(stages(model, factors=factors, before=before))
    refuse_same_contacts(model, schedule)
    carriers = len(model.obstacles) + len(model.rigid_bodies)
    linked = linked_nodes(model) if model.couples else None
    space = make_space(model.mesh, kind=model.kind, obstacles=carriers, linked=linked)
    first, sometimes = schedule[0].released, schedule[-1].loosened
    constraints = make_constraints(space, model, without=first)
    always = make_constraints(space, model, without=sometimes) if sometimes != first else constraints
    loads = nodal_loads(space, model)
    interface = (sector_interface if model.cyclic_symmetries else make_interface)(space, model, always)
    if interface.cohesion is not None:
        refuse_beside_bonds(model)
    if start is not None:
        start.check(model, interface)
    parts = connected_bodies(space, model)
    rigid = RigidMotions(space, parts)
    resisted = resistance(rigid, constraints)
    loading = loading_of(schedule[0], loads, constraints.prescribed, None if start is None else start.loading)
    examined = Examined(
        model=model,
        space=space,
        constraints=constraints,
        always=always,
        interface=interface,
        loads=loads,
        parts=parts,
        rigid=rigid,
        resisted=resisted,
        floating=floating_motions(rigid, resisted, interface),
        frames=turning_bodies(space, model, parts) if model.slides else BodyFrames(dimension=space.components),
        loading=loading,
        scale=data_scale(space, model, loading, interface),
    )
    if model.yields and examined.turns:
        _refuse_sliding(model, "a body yields and one may turn; expected elastic bodies, or supports against turning")
    _refuse_unheld(examined, schedule)
    if model.fatigue:
        refuse_requests(space, model)
    return examined


def _refuse_sliding(model: Model, words: str) -> None:
    """Refuse contacts that slide far, for what the words say.

    Raises
    ------
    InputError
        The first contact that slides far.
    """
    for i, contact in enumerate(model.contacts):
        if contact.slides:
            raise InputError(f'is "finite", {words}', where=("contact", i, "sliding"))


def _refuse_unheld(examined: Examined, schedule: Sequence[Stage]) -> None:
    """Look at every step with other supports or contacts than those before, ahead of solving any.

    Raises
    ------
    InputError
        If a body can move: with its motion, and with what lets it go.
    """
    space, model, interface, seen = examined.space, examined.model, examined.interface, set()
    for stage in schedule:
        if (stage.released, stage.inactive) in seen:
            continue
        seen.add((stage.released, stage.inactive))
        resisted = examined.resisted
        if stage.released != schedule[0].released:
            resisted = resistance(examined.rigid, make_constraints(space, model, without=stage.released))
        left = interface.among(~pairs_of(model, interface, stage.inactive)) if stage.inactive else interface
        try:
            refuse_free_motions(space, resisted, left, examined.parts, examined.rigid)
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
    resisted: Array,
    interface: Interface,
    parts: tuple[ConnectedBody, ...],
    rigid: RigidMotions,
) -> None:
    """A motion that neither supports nor contact can resist has no place that a solver could find.

    Parameters
    ----------
    space : unknowns
    resisted, interface : what supports take of the motions, and the pairs
    parts, rigid : connected pieces and their rigid motions

    Raises
    ------
    InputError
        If a part can move: with its motion.
    """
    dofs = space.dofs(distinct(interface.B.indices // space.components)).ravel()
    touching = chosen_rows(rigid.seen_by(dofs), dofs)
    free = free_motions(resisted, touching)
    if free.shape[1]:
        raise InputError(f"{_say(parts, free)}: no support or contact holds it; add a support")
    rubbing = (interface.friction.rubs & (interface.anisotropy > 0).T).ravel()
    resisting = chosen_rows(interface.felt(rigid), np.concatenate([np.ones(len(interface), bool), rubbing]))
    free = free_motions(resisted, resisting)
    if free.shape[1]:
        raise InputError(
            f"{_say(parts, free)}: nothing but frictionless contact, which cannot resist; add a support or friction"
        )


def _say(parts: tuple[ConnectedBody, ...], motions: Array) -> str:
    return ", and ".join(describe_motions(parts, motions))


def floating_motions(rigid: RigidMotions, resisted: Array, interface: Interface) -> Array:
    """(motions, k) Combinations of rigid motions that neither supports nor ties resist.

    Parameters
    ----------
    rigid : motions of all parts
    resisted, interface : what supports take of them, and the pairs with their ties
    """
    return free_motions(resisted, chosen_rows(interface.felt(rigid), interface.rows(interface.tied)))


def on_ranks(K: Any) -> bool:
    """Whether the rows of a stiffness are on the ranks of MPI.

    Parameters
    ----------
    K : as it was assembled, see `condensation.assembled`
    """
    return not isinstance(K, sp.csr_array)
