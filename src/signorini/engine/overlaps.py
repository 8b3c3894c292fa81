# SPDX-License-Identifier: BSD-3-Clause
"""Interferences that vary over sides and that steps change: at nodes, and as the gaps that pairs see."""

from __future__ import annotations

from dataclasses import replace

from signorini.arrays import Array
from signorini.fem.space import Space, make_space
from signorini.fem.supports import make_constraints
from signorini.interface.interface import make_interface
from signorini.interface.sectors import sector_interface
from signorini.interface.side_values import side_values
from signorini.model.model import Model
from signorini.model.stage import stages
from signorini.model.varying import NodeValues, Varying


def with_overlaps(model: Model) -> Model:
    """The model with interferences that steps vary over sides known at every node; one that has them is as it is.

    Raises
    ------
    InputError
        If a node of a side has no value.
    """
    space = make_space(model.mesh, kind=model.kind)
    numbers = {contact.label: i for i, contact in enumerate(model.contacts)}
    steps = []
    for k, step in enumerate(model.steps):
        overlaps: dict[str, Varying] = dict(step.interference)
        for name, given in step.interference.items():
            if not isinstance(given, float):
                where = ("step", k, "interference", name)
                overlaps[name] = NodeValues(side_values(space, model.contacts[numbers[name]], given, where))
        steps.append(replace(step, interference=overlaps))
    return replace(model, steps=steps)


def gap_under(space: Space, model: Model, i: int, interference: Varying) -> Array:
    """(k,) Initial gaps of the pairs of contact i with another interference, length.

    Parameters
    ----------
    space, model : of the contact
    i : its number
    interference : in place of its own
    """
    contacts = [
        replace(contact, interference=interference) if j == i else contact for j, contact in enumerate(model.contacts)
    ]
    changed = replace(model, contacts=contacts)
    always = make_constraints(space, model, without=list(stages(model))[-1].loosened)
    if model.cyclic_symmetries:
        found = sector_interface(space, changed, always)
        return found.gap[found.contact == i]
    return make_interface(space, changed, always, [i]).gap
