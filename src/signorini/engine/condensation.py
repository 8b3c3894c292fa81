# SPDX-License-Identifier: BSD-3-Clause
"""Condense the bodies of a model, and say in its words what cannot be condensed."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, stored
from signorini.clock import Clock
from signorini.condense.condensed import Condensed, condense
from signorini.condense.kept import Kept
from signorini.condense.ties import Ties
from signorini.distributed.ranks import ON_RANKS
from signorini.engine.examine import Examined, on_ranks
from signorini.engine.memory_check import refuse_unassembled
from signorini.errors import InputError, Where, one_of
from signorini.fem.rigid import hinged
from signorini.fem.stiffness import reduced_stiffness, stiffness
from signorini.fem.supports import Constraints
from signorini.interface.active import FreeBodies
from signorini.interface.sliding import sliding_unknowns
from signorini.iterative.bodies import ITERATIVE
from signorini.linalg.elsewhere import is_elsewhere
from signorini.linalg.plan import Plans
from signorini.linalg.protocol import NotPositiveDefinite
from signorini.linalg.registry import BACKENDS
from signorini.memory import give_memory_back
from signorini.sparse_rows import chosen_rows, seen_by

_GIVEN_BACK_FROM = 5_000_000
"""Entries of K from which the milliseconds that it takes to give memory back are worth it."""


def refuse_unknown(backend: str, where: Where = ()) -> None:
    """Refuse a back end that there is not.

    Parameters
    ----------
    backend, where : its name as it was asked for, and where

    Raises
    ------
    InputError
        With the nearest name, and all of them.

    Examples
    --------
    >>> refuse_unknown("petcs")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    signorini.errors.InputError: unknown back end 'petcs'; did you mean 'petsc'? Known: auto, iterative, ...
    """
    known = ("auto", *BACKENDS, ITERATIVE, *ON_RANKS)
    if backend not in known:
        raise InputError(one_of(backend, known, "back end"), where=where)


def free_bodies(examined: Examined, K: sp.csr_array) -> FreeBodies:
    """The bodies and their pairs in terms of the free displacements, K (z, z) their stiffness, here or elsewhere."""
    space, constraints = examined.space, examined.constraints
    # of bodies elsewhere nothing is asked but where nodes of pairs are
    points = stored(space.mesh, "points") if is_elsewhere(K) else space.places
    bodies = FreeBodies(K, constraints.in_free(examined.interface.B), constraints.nodes, points)
    if not examined.model.slides:
        return bodies
    return bodies._replace(kept=sliding_unknowns(space, examined.model, examined.frames, constraints.transform))


def condense_bodies(
    examined: Examined,
    bodies: FreeBodies,
    candidates: BoolArray,
    backend: str,
    clock: Clock,
    plans: Plans | None = None,
) -> Condensed:
    """Factorise the bodies with the nodes of the candidates last.

    Parameters
    ----------
    examined : the model
    bodies : with the pairs
    candidates : (n,) pairs that the law is asked of
    backend : of the factorisation, or "iterative"
    clock : counts the seconds
    plans : see :func:`signorini.linalg.registry.factorise`

    Raises
    ------
    InputError
        Where something moves without resistance, or contact hardly holds a body.
    """
    rigid = examined.constraints.of_free(examined.rigid, examined.floating)
    if not (examined.model.slides or examined.model.wears):  # neither looks for facets again
        examined.space.forget("facets")
    if bodies.K.nnz > _GIVEN_BACK_FROM:
        give_memory_back()
    try:
        return condense(
            bodies,
            examined.interface,
            kept=Kept.of(bodies, examined.interface, candidates),
            rigid=rigid,
            stiffness=examined.scale.stiffness,
            backend="auto" if backend == ITERATIVE else backend,
            clock=clock,
            plans=plans,
        )
    except NotPositiveDefinite as error:
        raise _singular(examined, error) from error
    except np.linalg.LinAlgError as error:
        raise InputError(
            "the compliance of the contacts is so large, or the moduli are so far apart, that contact hardly holds a "
            "body; expected smaller compliances, or supports",
            where=("contact",),
        ) from error


def _singular(examined: Examined, error: NotPositiveDefinite) -> InputError:
    node = examined.constraints.nodes[error.dof]
    part = next((part for part in examined.parts if node in part.nodes), None)
    if part is None:
        return InputError(
            "a rigid body or obstacle has no stiffness against some motion; expected a support or contact"
        )
    at = tuple(float(x) for x in examined.model.mesh.points[node].round(6))
    moving = f"node {examined.model.mesh.labels[node]} at {at}"
    if part.kind == "body" and not hinged(examined.space, part):
        return InputError(
            f"{part.label} is too slender for double precision: what resists the motion of {moving} is less than the "
            "rounding of its stiffness; expected bodies shorter for their height, and moduli that are not extremely "
            "apart"
        )
    return InputError(
        f"{part.label} has no stiffness against some motion of {moving}, though no rigid motion is free; expected "
        "cells that are joined by edges (a hinge at a single node?) and moduli that are not extremely apart"
    )


def assembled(examined: Examined, backend: str) -> tuple[Any, str]:
    """The stiffness of bodies and foundations, a matrix or its pieces on ranks; and the back end, one way of ranks.

    Parameters
    ----------
    examined, backend : the model, and where it is to be solved

    Raises
    ------
    InputError
        If it does not fit, there is no such back end, or ranks do not know something in the model.
    """
    if backend in ON_RANKS:
        from signorini.engine.solver_on_ranks import stiffness_on_ranks  # needs PETSc

        return stiffness_on_ranks(examined, backend)
    refuse_unknown(backend)
    refuse_unassembled(examined.model)
    return whole_stiffness(examined), backend


def reduced_bodies(examined: Examined, K: Any) -> Any:
    """(z, z) The stiffness of the free displacements: a matrix, or what stands for it where its rows are on ranks.

    Parameters
    ----------
    examined, K : the model, and its stiffness as it was assembled
    """
    if not on_ranks(K):
        return reduced_stiffness(K, examined.constraints.transform)
    from signorini.engine.solver_on_ranks import matrix_on_ranks  # needs PETSc

    return matrix_on_ranks(examined)


def whole_stiffness(examined: Examined) -> sp.csr_array:
    """(dofs, dofs) Of bodies and elastic foundations, supports not applied."""
    K = stiffness(examined.space, examined.model)
    for springs in examined.constraints.springs.values():
        K = sp.csr_array(K + springs.T @ springs)
    return K


def softness(examined: Examined, condensed: Condensed) -> float:
    """The farthest that any load moves the bodies, of the sum of its forces: what bends moves far beyond F / (E t).

    Parameters
    ----------
    examined, condensed : the model and its condensed bodies
    """
    constraints, found = examined.constraints, [0.0]
    for forces in examined.loads.values():
        if size := float(np.abs(forces).sum()):
            moved = constraints.displaced(condensed.on_springs(constraints.on_free(forces)))
            found.append(float(np.abs(moved).max(initial=0.0)) / size)
    return max(found)


def with_ties(examined: Examined, ties: Ties) -> Constraints:
    """What moving supports prescribe, and with it what ties make of it: pairs that are tied do not part.

    Parameters
    ----------
    examined, ties : the model and its ties
    """
    constraints = examined.constraints
    return constraints.prescribing({name: closed(examined, ties, u) for name, u in constraints.prescribed.items()})


def closed(examined: Examined, ties: Ties, u: Array) -> Array:
    """Displacements (dofs,) that supports impose, and with them what ties make of them at once.

    Parameters
    ----------
    examined, ties : the model and its ties
    u : (dofs,)
    """
    moved = seen_by(chosen_rows(examined.interface.B, ties.rows), u)
    return u + examined.constraints.displaced(examined.constraints.spread_free(*ties.closing(moved)))
