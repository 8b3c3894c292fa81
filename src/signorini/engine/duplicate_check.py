# SPDX-License-Identifier: BSD-3-Clause
"""What is given twice, which nothing would tell apart, and what would never act."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from signorini.arrays import Array
from signorini.errors import InputError
from signorini.model.model import Model
from signorini.model.obstacle import Obstacle
from signorini.model.stage import Stage

Side = bytes | str | Obstacle


def refuse_same_contacts(model: Model, schedule: Sequence[Stage]) -> None:
    """Two contacts between the same sides would share one pressure, and in no way that the law determines.

    Sides are the same if they have the same facets, whatever they are called and whichever is the nonmortar one. Sides
    that have only some facets in common are left alone, and contacts of which one is always switched off.

    Raises
    ------
    InputError
        For the later of the two, with the name of the other.
    """
    if len(model.contacts) < 2:
        return
    facets: dict[str, Side] = {}
    sides = [(_side(model, c.nonmortar, facets), _side(model, c.mortar, facets)) for c in model.contacts]
    alike: dict[frozenset[Side], list[int]] = {}
    for j, both in enumerate(sides):
        for i in alike.setdefault(frozenset(both), []):
            name, other = model.contacts[j].label, model.contacts[i].label
            if all({name, other} & stage.inactive for stage in schedule):
                continue
            turned = "" if both == sides[i] else ", named the other way round"
            raise InputError(
                f"'{name}' is between the same sides as contact '{other}'{turned}: nothing determines how they share a "
                "pressure; expected one contact, or steps in which one of them is inactive",
                where=("contact", j),
            )
        alike[frozenset(both)].append(j)


def same_loads(model: Model, loads: Mapping[str, Array]) -> Iterator[str]:
    """Loads that are the same nodal forces and act together, which may be meant once; in words.

    Parameters
    ----------
    loads : name to nodal forces (dofs,)
    """
    known: dict[bytes, str] = {}
    history = model.factors()
    for name, forces in loads.items():
        first = known.setdefault((forces + 0.0).tobytes(), name)  # no negative zeros
        if first != name and forces.any() and any(ends[first] != 0.0 != ends[name] for ends in history):
            yield f"loads '{first}' and '{name}' are the same forces, and act together: twice what one of them is"


def _side(model: Model, on: str | Obstacle, facets: dict[str, Side]) -> Side:
    """What a side is, whatever it is called: its facets, or the obstacle."""
    if not isinstance(on, str) or on not in model.mesh.boundaries:
        return on
    if on not in facets:
        kinds = model.mesh.facets(on)
        facets[on] = b"".join(np.unique(np.sort(rows, axis=1), axis=0).tobytes() for rows in kinds)
    return facets[on]


def refuse_idle(model: Model, factors: Mapping[str, float]) -> None:
    """A load that no step names, and that a history to go on from did not know, is a forgotten one.

    Parameters
    ----------
    factors : load factors at the end of that history, empty where there is none

    Raises
    ------
    InputError
        The first of them.
    """
    names = model.scaled_names
    used = set(factors)
    for step in model.steps:
        used |= set(names if step.scale is None else step.scale)
    for name in names:
        if name not in used:
            raise InputError(
                f"no step's scale names '{name}': it would never act. Expected a factor for it in a step",
                where=("step",),
            )
