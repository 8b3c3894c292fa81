# SPDX-License-Identifier: BSD-3-Clause
"""What goes with bodies of revolution: motions along the axis and, where they twist, about it."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from signorini.errors import InputError
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.kind import TWIST
from signorini.model.links import CyclicSymmetry
from signorini.model.material import Orthotropic
from signorini.model.rigid import Rigid


def check_rigid_motions(
    supports: Sequence[Support], obstacles: Sequence[Rigid], rigid_bodies: Collection[str], *, twists: bool
) -> None:
    """Refuse what takes rigid bodies off the axis, or turns them about it where nothing twists.

    Parameters
    ----------
    supports, obstacles : of the model
    rigid_bodies : names of its rigid bodies
    twists : whether bodies turn about the axis

    Raises
    ------
    InputError
        For a support or an obstacle that does.
    """
    for i, support in enumerate(supports):
        if support.on in rigid_bodies and (support.u[0] or (support.u[2] and not twists)):
            raise InputError(
                "moves a rigid body off the axis of revolution; expected 0 or free there", where=("support", i, "u")
            )
    for i, obstacle in enumerate(obstacles):
        if obstacle.u[0] != 0.0 or (obstacle.rotation != 0.0 and not twists):
            rotation = "" if twists else " and rotation 0"
            raise InputError(
                f"moves off the axis of revolution; expected u = (0, ...){rotation}", where=("obstacle", i)
            )


def check_loads(loads: Sequence[Load], symmetries: Sequence[CyclicSymmetry], *, twists: bool) -> None:
    """Refuse loads that are not the same all around.

    Parameters
    ----------
    loads, symmetries : of the model
    twists : whether bodies turn about the axis

    Raises
    ------
    InputError
        For gravity across the axis, an axis of rotation elsewhere, a sector, or a bearing that twists.
    """
    for i, load in enumerate(loads):
        if load.gravity is not None and (load.gravity[0] != 0.0 or any(load.gravity[2:])):
            raise InputError(
                f"is {load.gravity}, which is not symmetric; expected it along the axis", where=("load", i, "gravity")
            )
        if load.centre is not None:
            raise InputError("an axisymmetric body rotates about its axis", where=("load", i, "centre"))
        if load.torque is not None and not twists:
            words = f"is {load.torque:g}, which is for bodies that turn about the axis; expected kind '{TWIST}'"
            raise InputError(words, where=("load", i, "torque"))
        if twists and load.spread == "displacement" and load.force is not None and load.force[2] is not None:
            raise InputError(
                'moves nodes of all radii alike around the axis; expected None (in a deck "free") there, and a rigid '
                "body that a moment turns",
                where=("load", i, "force"),
            )
    if symmetries:
        raise InputError("an axisymmetric body is the same all around", where=("cyclic_symmetry", 0))


def check_twist(bodies: Sequence[Body], contacts: Sequence[Contact]) -> None:
    """Refuse what bodies that turn about the axis do not have.

    Parameters
    ----------
    bodies, contacts : of the model

    Raises
    ------
    InputError
        For a body that lacks shear moduli, and a contact that wears or slides far.
    """
    for i, body in enumerate(bodies):
        if isinstance(body.material, Orthotropic) and not body.material.solid:
            words = "has no G13 and G23; an axisymmetric model with twist needs them"
            raise InputError(words, where=("body", i, "material"))
    for i, contact in enumerate(contacts):
        if contact.friction_axis is not None and contact.friction_axis[2] and any(contact.friction_axis[:2]):
            raise InputError(
                f"is {contact.friction_axis}; expected (r, z, 0) along the meridian or (0, 0, 1) around the axis",
                where=("contact", i, "friction_axis"),
            )
        if contact.wear is not None:
            raise InputError("is given, but bodies twist; expected none", where=("contact", i, "wear"))
        if contact.slides:
            raise InputError('is "finite", but bodies twist; expected "small"', where=("contact", i, "sliding"))
