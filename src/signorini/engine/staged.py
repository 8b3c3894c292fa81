# SPDX-License-Identifier: BSD-3-Clause
"""The contact law of a step: friction as it is now, contacts that are switched off, gaps with their interferences."""

from __future__ import annotations

from dataclasses import replace

from signorini.arrays import Array
from signorini.engine.prepare import Prepared, contact_law
from signorini.engine.unheld import left_out, refuse_free_motions
from signorini.errors import InputError
from signorini.interface.frames import along_tangents
from signorini.interface.interface import pairs_of
from signorini.iterative.bodies import Bodies
from signorini.model.contact import ratios
from signorini.model.stage import Stage
from signorini.solution.scale import Loading, data_scale


def staged(prepared: Prepared, stage: Stage, loading: Loading) -> Prepared:
    """The prepared model under the law of a step; nothing sparse is factorised again.

    Parameters
    ----------
    prepared : with every contact switched on and the friction that the contacts themselves have
    loading : the most that was imposed up to the end of the step: what its certificates refer to

    Raises
    ------
    InputError
        If the contacts that are left do not hold a body: it is named, with its motion.
    """
    labels = [contact.label for contact in prepared.model.contacts]
    mu, anisotropy = prepared.interface.friction.copy(), prepared.interface.anisotropy.copy()
    for name, value in stage.friction.items():
        i = labels.index(name)
        own = prepared.interface.contact == i
        mu[own] = max(value) if isinstance(value, tuple) else value
        anisotropy[own] = along_tangents(
            ratios(value), prepared.model.contacts[i].friction_axis, prepared.interface.tangents[own]
        )
    absent = pairs_of(prepared.model, prepared.interface, stage.inactive)
    interface = replace(prepared.interface, friction=mu, anisotropy=anisotropy)
    scale = data_scale(prepared.space, prepared.model, loading, interface).bent(prepared.softness)
    if not absent.any():
        law = prepared.law_under(interface, scale)
        return replace(prepared, interface=interface, scale=scale, law_or_none=law)
    left = interface.among(~absent)
    try:
        refuse_free_motions(prepared.space, prepared.constraints, left, prepared.parts, prepared.motions)
        bodies = prepared.bodies.among(~absent)
    except InputError as error:
        raise left_out(error, stage) from error
    law = None if isinstance(bodies, Bodies) else contact_law(interface, bodies, scale)
    return replace(prepared, interface=interface, scale=scale, bodies=bodies, law_or_none=law, absent=absent)


def nominal_gap(prepared: Prepared, stage: Stage) -> Array:
    """(n,) Initial gaps under the interferences at the end of a step."""
    gap = prepared.interface.gap.copy()
    for i, contact in enumerate(prepared.model.contacts):
        if contact.label in stage.interference:
            gap[prepared.interface.contact == i] += contact.interference - stage.interference[contact.label]
    return gap
