# SPDX-License-Identifier: BSD-3-Clause
"""What the two ways through contact in space cost: condensed by a factorisation, or iterated on the bodies as they are.

Both are counted in operations of a factorisation. A product with the stiffness of the bodies reads memory and computes
little, so that an entry of it counts as many; what an iteration takes beside its product is counted in products.
Constants are fits to what both ways take (`python -m benchmarks.ways`).

The choice is a matter of the past alone: increments so far and those of the step at hand. So a history that is cut and
goes on takes the same way, and one that goes on for long in short steps pays at most twice.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from signorini.engine.examine import Examined
from signorini.model.stage import Stage
from signorini.solution.checkpoint import Checkpoint

# fits to what benchmarks/ways.py measures, 2400 to 140 000 unknowns and 1 to 20 increments, by one thread
_ENTRY = 25.0  # operations of a factorisation in the time of an entry of K in a product: 10 to 30, by the machine
_FRONTS = 360.0  # products with K in the time of what a factorisation does beside them: order, plan, gathering fronts
_START = 2e9  # operations: what iterating takes whatever there is
_GRIDS = 130.0  # products with K in the time of making the coarse grids
_CYCLE = 3.2  # products with K in the time of an iteration, a cycle of multigrid included
_FIRST, _EACH = 26.0, 8.0  # iterations at the beginning, and of every increment, whose work counts in them
_DENSE = 0.55  # operations of what is made of the compliance of the pairs, of its rows cubed
_LAW_ROWS = 700.0  # operations of Newton's method an increment, of the rows of the pairs squared
_LAW = 14.0  # products with K in the time of an increment for its displacements and certificate
_ENDLESS = 1e6  # increments, where none of them costs more iterated than condensed


class Condensing(NamedTuple):
    """What condensing takes.

    Attributes
    ----------
    bytes : at the worst time
    operations : multiplications and additions of the factorisation
    rows : of the pairs, all directions
    """

    bytes: float
    operations: float
    rows: int


class ContactWay(NamedTuple):
    """How contact is solved.

    Attributes
    ----------
    worth : increments from which bodies are condensed: 0 always, infinite where they are iterated on whatever they are
    most : conjugate gradients of an increment after which they are condensed after all
    """

    worth: float
    most: float = np.inf


CONDENSED, ITERATED = ContactWay(0.0), ContactWay(np.inf)


def iterating_work(entries: int, increments: float) -> float:
    """Operations of a factorisation in the time of which contact is iterated on.

    Parameters
    ----------
    entries : of the stiffness
    increments : how many
    """
    return _START + entries * _ENTRY * (_GRIDS + _CYCLE * (_FIRST + _EACH * increments))


def condensing_work(condensing: Condensing, entries: int) -> float:
    """Operations in the time of condensing, before the law is asked.

    Parameters
    ----------
    condensing : what it takes
    entries : of the stiffness
    """
    return condensing.operations + _FRONTS * entries * _ENTRY + _DENSE * condensing.rows**3.0


def cheaper_way(condensing: Condensing, entries: int, increments: float) -> ContactWay:
    """The way that is cheaper for some increments.

    Parameters
    ----------
    condensing : what it takes
    entries : of the stiffness
    increments : in which contact is solved

    Examples
    --------
    A block on a plate, 45 852 unknowns with 196 pairs, and two cubes of 4374; one increment, and many:

    >>> large, small = Condensing(6e8, 8.7e9, 588), Condensing(4e7, 3e8, 243)
    >>> [round(cheaper_way(large, 3_010_000, number).worth) for number in (1, 100)]
    [28, 0]
    >>> cheaper_way(small, 280_000, 1).worth
    0.0
    """
    own = condensing_work(condensing, entries)
    each = _LAW * entries * _ENTRY + _LAW_ROWS * condensing.rows**2.0
    first = iterating_work(entries, 0.0)
    more = iterating_work(entries, 1.0) - first - each
    worth = (own - first) / more if more > 0.0 else _ENDLESS
    return ContactWay(worth, own / (entries * _ENTRY * _CYCLE)) if increments < worth else CONDENSED


def increments_of(stage: Stage, examined: Examined) -> float:
    """Increments of a step, infinite where it is followed to events or in as many as it takes, or bodies float in it.

    Parameters
    ----------
    stage, examined : the step, and the model under its supports
    """
    step, interface = stage.step, examined.interface
    chosen = step.increments is not None or step.path is not None
    rubs = bool(interface.friction.bounded.any()) or bool(stage.friction) or interface.remembers
    to_events = step.path == "exact" or step.at == "events" or (rubs and not chosen)
    if to_events or step.increments == "auto" or examined.floating.shape[1]:
        return np.inf
    return float(int(step.increments or 1) * len(stage.ends))


def increments_before(examined: Examined, start: Checkpoint | None, backend: str) -> float:
    """Increments so far that bodies were iterated on because that is cheaper; infinite where they are condensed.

    Sides that wear or slide far are followed on the condensed interface, and what yields is factorised anew.

    Parameters
    ----------
    examined, start, backend : the model, what it goes on from, and what was asked for
    """
    model, interface = examined.model, examined.interface
    if backend != "auto" or examined.space.dimension == 2:
        return np.inf
    if model.slides or model.wears or model.yields or examined.has_laws or interface.cohesion is not None:
        return np.inf
    if interface.facets.any() or (interface.anisotropy != 1.0).any() or not interface.friction.straight:
        return np.inf
    return 0.0 if start is None else start.increments
