# SPDX-License-Identifier: BSD-3-Clause
"""Bolts as equations between the halves of their sections, a load or a support, and what they bear."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.errors import InputError
from signorini.meshing.cut import HALF_ABOVE, HALF_BELOW, section_normal
from signorini.meshing.halves import halves_match, section_equations
from signorini.model.conditions import Load, Support
from signorini.model.links import Equation
from signorini.model.model import Model
from signorini.solution.bolt_result import BoltResult


def with_bolts(model: Model) -> Model:
    """The model with what its bolts stand for; one that has it already is as it is.

    The halves of a section overlap by the shortening d along the normal n from the one below: ``u_above - u_below + d n
    = 0``, and d is the first displacement of the node of the section. The force of a bolt is a load on it, which works
    as the section is drawn together; what locks it, or prescribes its shortening, is a support.

    Raises
    ------
    InputError
        If the mesh is not cut there, or a bolt has the name of another load or support.
    """
    taken = {load.label for load in model.loads} | {support.label for support in model.supports}
    if all(bolt.label in taken for bolt in model.bolts):
        return model
    equations, loads, supports = list(model.equations), list(model.loads), list(model.supports)
    for i, bolt in enumerate(model.bolts):
        if bolt.label in taken:
            raise InputError(f"a load or support is called '{bolt.label}' too", where=("bolt", i, "name"))
        free = (None,) * (model.components - 1)
        equations += _halves(model, i)
        if bolt.force is not None:
            loads.append(Load(bolt.section, force=(bolt.force, *(0.0 for _ in free)), name=bolt.label))
        supports.append(Support(bolt.section, u=(bolt.shortening or 0.0, *free), name=bolt.label))
    first = model.steps[0]
    loose = [bolt.label for bolt in model.bolts if bolt.force is not None and bolt.label not in first.hold]
    steps = [replace(first, release=(*first.release, *loose)), *model.steps[1:]]
    return replace(model, equations=equations, loads=loads, supports=supports, steps=steps)


def _halves(model: Model, i: int) -> list[Equation]:
    """What keeps the halves of the section of bolt i opposite each other."""
    section = model.bolts[i].section
    try:
        normal = section_normal(model.mesh, section)
    except InputError as error:
        raise error.inside("bolt", i, "section") from error
    _refuse_contact_between_halves(model, section)
    normal = np.pad(normal, (0, model.components - model.dimension))
    if halves_match(model.mesh, section):
        return section_equations(model.mesh, section, section, normal, name=model.bolts[i].label)
    from signorini.engine.halves_apart import mortar_equations

    try:
        return mortar_equations(model, section, normal, name=model.bolts[i].label)
    except InputError as error:
        raise error.inside("bolt", i, "section") from error


def _refuse_contact_between_halves(model: Model, section: str) -> None:
    """Halves that are given as two bodies may still be tied, or in contact, which says other than the bolt does."""
    mesh = model.mesh
    halves = [mesh.nodes_of(section + half) for half in (HALF_BELOW, HALF_ABOVE)]
    for i, contact in enumerate(model.contacts):
        if not isinstance(contact.mortar, str):
            continue
        sides = [mesh.nodes_of(side) for side in (contact.nonmortar, contact.mortar)]
        if any(
            np.isin(one, sides[0]).any() and np.isin(other, sides[1]).any() for one, other in (halves, halves[::-1])
        ):
            raise InputError(
                f"joins the halves of section '{section}', which its bolt holds opposite each other; expected no "
                "contact between them",
                where=("contact", i),
            )


def bolt_results(
    model: Model, displacement: Array, factors: Mapping[str, float], reactions: Mapping[str, Array]
) -> dict[str, BoltResult]:
    """Force and shortening of every bolt, by name.

    Parameters
    ----------
    model : with what its bolts stand for
    displacement : (dofs,) length
    factors : of the loads, by name
    reactions : of the supports, by name
    """
    return {
        bolt.label: BoltResult(
            force=(bolt.force or 0.0) * factors.get(bolt.label, 0.0) + float(reactions[bolt.label][0]),
            shortening=float(displacement[model.components * int(model.mesh.nodes[bolt.section][0])]),
        )
        for bolt in model.bolts
    }
