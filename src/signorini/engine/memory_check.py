# SPDX-License-Identifier: BSD-3-Clause
"""Whether a model, and the displacements that are asked for, fit in memory, before anything large is made."""

from __future__ import annotations

import numpy as np

from signorini.arrays import BoolArray, distinct
from signorini.engine.way_costs import (
    CONDENSED,
    ITERATED,
    Condensing,
    ContactWay,
    cheaper_way,
    condensing_work,
    iterating_work,
)
from signorini.errors import InputError
from signorini.interface.active import FreeBodies
from signorini.interface.interface import Interface
from signorini.iterative.bodies import ITERATIVE
from signorini.linalg.elsewhere import is_elsewhere
from signorini.linalg.plan import analyse
from signorini.linalg.registry import takes_borders
from signorini.linalg.system import checked_system
from signorini.memory import available_memory
from signorini.model.model import Model
from signorini.sparse_rows import chosen_rows

# measured on cubes of 13 000 to 1 000 000 unknowns and cylinders in the plane (benchmarks/memory.py), the least of each
_LEAST_OF_SOLVE = {2: 75.0, 3: 32.0}  # bytes an entry of K, all in all, by dimension: in space iterating takes least
_BORDER = 24.0  # bytes an entry of K: K with a border of the pairs, its graph and order, beside the factor
_BORDERED = 1.25  # times the factor of K with its contact nodes kept: at most that of K with a border
_ITERATION = 18.0  # bytes an entry of K more, for its blocks, the coarse grids and vectors
_ITERATION_ON_TANGENTS = 44.0  # where bodies yield
_TANGENTS = (
    90.0  # bytes an entry of K more where bodies yield, for patterns of tangents, gradients and states of points
)
_KEPT_TWICE = (
    2.0  # times as much where bodies yield: what is made of a tangent stands beside that of the elastic bodies
)
# of the entries of all element matrices: how many K has in a regular mesh; of families that are not named more
_SHARED = {"tetra": 0.17, "wedge": 0.29}
_SHARED_ELSE = 0.39
_GENEROUS = 300.0, 1.0, 60.0, 4.0 / 3.0  # entries of the factor: at most 300 z in the plane, 60 z^(4/3) in space
_GENEROUS_WORK = 40.0  # operations of a factorisation in space: at most 40 z^2
_SQUARE = 3, 2  # dense matrices of the size of the contact dofs, and of that of the pairs' rows, held at once
_SQUARE_OF_PAIRS = 3  # of the pairs' rows where pairs are kept: as the law takes it, its factor, two of half the bytes
_WAYS_OUT = "a coarser mesh, more memory, or the ranks of more machines (back end 'petsc')"
_SHARE = 0.5  # of the memory that there is: what displacements that are asked for may fill


def likely_entries(model: Model) -> float:
    """Entries that the stiffness will have, nearly.

    Parameters
    ----------
    model : which is not assembled yet
    """
    return sum(
        _SHARED.get(family, _SHARED_ELSE) * number * (nodes * model.components) ** 2
        for family, (number, nodes) in model.mesh.shapes.items()
    )


def least_bytes(model: Model) -> float:
    """What a solve takes at least, whichever way it goes.

    Parameters
    ----------
    model : which is not assembled yet
    """
    return _LEAST_OF_SOLVE[model.dimension] * likely_entries(model)


def refuse_unassembled(model: Model) -> None:
    """Refuse a model that fits in no way, before anything is assembled.

    Raises
    ------
    InputError
        With the least that it takes and what there is.
    """
    asked, room = least_bytes(model), available_memory()
    if asked > room:
        unknowns = model.number_of_dofs
        raise InputError(
            f"a solve of {unknowns} unknowns takes at least {_size(asked)}, and {_size(room)} of memory are free; "
            f"expected {_WAYS_OUT}"
        )


def way_through(
    bodies: FreeBodies, interface: Interface, *, candidates: BoolArray, backend: str, yields: bool, increments: float
) -> ContactWay:
    """How contact is solved: condensed, or on the bodies as they are where that is asked for, cheaper or all that fits.

    Parameters
    ----------
    bodies, interface, candidates : as of `condensing`
    backend : as asked for
    yields : whether tangents are made of the bodies too
    increments : in which contact is solved; infinite: the cheaper way is not asked for

    Raises
    ------
    InputError
        Where what was asked for does not fit, or nothing does: with what it takes, what there is, and ways out.
    """
    K = bodies.K
    if is_elsewhere(K):
        return CONDENSED
    if not K.nnz:  # nothing deforms, so there is nothing to iterate on
        return CONDENSED
    times, more = (_KEPT_TWICE, _TANGENTS * K.nnz) if yields else (1.0, 0.0)
    own = _ITERATION_ON_TANGENTS if yields else _ITERATION
    room, iterated = available_memory(), times * own * K.nnz + more
    if backend == ITERATIVE and len(bodies.kept):
        raise InputError("back end 'iterative' does not know contacts that slide far; expected another, or small slips")
    if backend == ITERATIVE:
        if iterated <= room:
            return ITERATED
        needs, ways = f"{_size(iterated)} to iterate on", ""
    else:
        plenty, dear = (0.5 * room - more) / times, iterating_work(K.nnz, 1.0) if increments < np.inf else np.inf
        found = condensing(bodies, interface, candidates=candidates, plenty=plenty, dear=dear)
        condensed = times * found.bytes + more
        if condensed <= room:
            cheap = increments < np.inf and iterated <= room
            return cheaper_way(found, K.nnz, increments) if cheap else CONDENSED
        if backend == "auto" and iterated <= room and not len(bodies.kept):
            return ITERATED
        needs = f"{_size(condensed)} to factorise and condense, {_size(iterated)} to iterate on"
        ways = f"back end '{ITERATIVE}', " if iterated <= room else ""
    raise InputError(
        f"{K.shape[0]} unknowns with {len(interface)} contact pairs take about {needs}, and {_size(room)} of memory "
        f"are free; expected {ways}{_WAYS_OUT}"
    )


def condensing(
    bodies: FreeBodies, interface: Interface, *, candidates: BoolArray, plenty: float, dear: float = np.inf
) -> Condensing:
    """What :func:`signorini.condense.condensed.condense` takes, and the law on its result.

    Parameters
    ----------
    bodies : as they are
    interface : the pairs
    candidates : (n,) pairs that may touch
    plenty, dear : bytes and operations; where generous bounds stay below, the pattern of K is not analysed
    """
    K, B, nodes, points = bodies[:4]
    chosen = interface.rows(candidates | interface.tied)
    dofs = distinct(np.concatenate([chosen_rows(B, chosen).indices, bodies.kept]))
    rows = int(np.count_nonzero(chosen))
    by_nodes = interface.directions == 2 or interface.tied.any() or not takes_borders("auto")
    if by_nodes:  # contact nodes are kept; else pairs, in a border
        dense, border = _SQUARE[1] * rows**2 + _SQUARE[0] * len(dofs) ** 2, 0.0
    else:
        dense, border = _SQUARE_OF_PAIRS * rows**2, _BORDER * K.nnz
    factor, power = _GENEROUS[:2] if interface.directions == 2 else _GENEROUS[2:]
    bound = Condensing(8.0 * (factor * K.shape[0] ** power + dense) + border, _GENEROUS_WORK * K.shape[0] ** 2.0, rows)
    if bound.bytes <= plenty and (dear == np.inf or condensing_work(bound, K.nnz) <= dear):
        return bound
    plan = analyse(checked_system(K, dofs, nodes, points))
    if by_nodes:
        return Condensing(max(plan.peak_bytes, 8.0 * (plan.nnz_factor + dense)), plan.flops, rows)
    stacks = sum(plan.stacks) + rows**2  # given back before the dense matrices are made
    factor = _BORDERED * (plan.peak_bytes - 8.0 * (sum(plan.stacks) + len(dofs) ** 2))
    return Condensing(factor + 8.0 * max(stacks, dense) + border, plan.flops, rows)


def _size(number: float) -> str:
    """Bytes in words.

    >>> _size(1.234e10), _size(5.0e7)
    ('12.3 GB', '0.05 GB')
    """
    return f"{number / 1e9:.3g} GB"


def refuse_fields(model: Model) -> None:
    """Refuse to keep more displacements than fit in half of the memory; stresses are computed one state at a time.

    Raises
    ------
    InputError
        The first step whose times are too many, with how many there is room for.
    """
    if not any(isinstance(step.at, tuple) and step.at for step in model.steps):
        return
    each = 8 * model.number_of_dofs
    room = max(int(_SHARE * available_memory() / each) - len(model.steps), 0)
    left = room
    for i, step in enumerate(model.steps):
        asked = len(step.at) if isinstance(step.at, tuple) else 0
        left -= asked
        if left < 0:
            raise InputError(
                f"asks for {asked} fields of {each / 1e6:.3g} MB; in half of the memory there is room for {room} in "
                "all steps. Expected fewer, or steps in runs of their own (--from)",
                where=("step", i, "at"),
            )
