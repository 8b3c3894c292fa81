# SPDX-License-Identifier: BSD-3-Clause
"""What a report and the cards say of results, as rows of words."""

from __future__ import annotations

from signorini.law.friction import FrictionLaw
from signorini.model.contact import Contact
from signorini.model.model import Model
from signorini.model.rigid import Rigid
from signorini.model.varying import spell
from signorini.output.table import spell_number, spell_vector
from signorini.solution.certificate import NUMBERS, TOLERANCE, Certificate
from signorini.solution.history import History
from signorini.solution.results import OPEN, SLIP, STICK, ContactResult

CONTACT_HEAD = (
    "normal force",
    "friction force",
    "largest pressure",
    "closed area",
    "open",
    "stick",
    "slip",
    "most slip",
)

MEANINGS = {
    "equilibrium": "what is missing for equilibrium at a node, or of a body as a whole, over the force",
    "penetration": "the largest overlap of the sides, over the length",
    "tension": "the largest force that pulls where contact can only press, over the force",
    "cone": "by how much friction is larger than its law allows, over the force",
    "complementarity": "pressure beside a gap, slip below the bound of friction, or friction along slip",
}
"""Of the numbers of a certificate, for a reader who has not met them."""


def contact_row(contact: ContactResult) -> tuple[str, ...]:
    """Numbers of a contact at the end of a step, below `CONTACT_HEAD`."""
    noise = 1e-12 * float((abs(contact.pressure) * contact.area).sum())
    return (
        spell_vector(contact.normal_force, noise),
        spell_vector(contact.tangential_force, noise),
        f"{contact.pressure.max(initial=0.0):.5g}",
        f"{contact.closed_area:.5g}",
        *(str(contact.count(status)) for status in (OPEN, STICK, SLIP)),
        spell_number(float(contact.slipped.max(initial=0.0))),
    )


def certificate_rows(certificate: Certificate) -> list[tuple[str, str, str]]:
    """Name, violation and what is allowed of every number of a certificate."""
    return [(name, f"{getattr(certificate, name):.1e}", f"{TOLERANCE:.0e}") for name in NUMBERS]


def verdict(history: History) -> str:
    """How a history ended, in a sentence."""
    if not history.steps:
        return f"{history.status}: {history.message}"
    worst = max(step.certificate.worst for step in history.steps)
    if history.solved:
        return f"solved and certified, the worst violation {worst:.1e} of {TOLERANCE:.0e} allowed"
    return f"{history.status}: {history.message}"


def load_rows(model: Model) -> list[tuple[str, str, str]]:
    """Name, kind and value of every load."""
    rows = []
    for load in model.loads:
        value = getattr(load, load.kind)
        words = (
            ", ".join("free" if part is None else spell(part) for part in value)
            if isinstance(value, tuple)
            else spell(value)
        )
        rows.append((load.label, load.kind.replace("_", " "), words))
    return rows


def material_words(model: Model) -> list[tuple[str, str, str]]:
    """Name, material and number of elements of every body."""
    return [(body.name, str(body.material), str(len(model.mesh.bodies[body.name]))) for body in model.bodies]


def support_words(model: Model) -> list[tuple[str, str]]:
    """Name of every support, and what it prescribes."""
    return [
        (support.label, ", ".join("free" if part is None else spell(part) for part in support.u))
        for support in model.supports
    ]


def contact_words(model: Model) -> list[tuple[str, str, str]]:
    """Name, sides and friction of every contact."""
    return [
        (contact.label, f"{contact.nonmortar} on {contact.mortar}", _friction(contact)) for contact in model.contacts
    ]


def further_words(model: Model) -> list[tuple[str, str]]:
    """Name of every moving obstacle, bolt, foundation, rigid body and equation, and what it is."""
    driven = [(rigid.name, f"{rigid.shape}, {_driven(rigid)}") for rigid in model.obstacles]
    bolts = [
        (bolt.label, f"bolt, shortening {bolt.shortening:g}" if bolt.force is None else f"bolt, force {bolt.force:g}")
        for bolt in model.bolts
    ]
    beds = [(bed.label, f"foundation, {bed.normal_stiffness:g} along its normal") for bed in model.foundations]
    stiff = [(body.label, "rigid body") for body in model.rigid_bodies]
    tied = [("equations", f"{len(model.equations)} between displacements")] if model.equations else []
    rings = [("sectors", f"one of {ring.sectors}") for ring in model.cyclic_symmetries]
    return [*driven, *bolts, *beds, *stiff, *tied, *rings]


def _driven(rigid: Rigid) -> str:
    parts = ", ".join("free" if part is None else f"{part:g}" for part in rigid.u)
    bears = f", bears {spell_vector([part or 0.0 for part in rigid.force])}" if rigid.force else ""
    return f"moves by ({parts}){bears}"


def _friction(contact: Contact) -> str:
    if contact.tied:
        return "tied"
    if isinstance(contact.friction, FrictionLaw):
        return contact.friction.words
    if isinstance(contact.friction, tuple):
        words = f"{contact.friction[0]:g} along, {contact.friction[1]:g} across"
    else:
        words = contact.friction if isinstance(contact.friction, str) else spell(contact.friction)
    limit = "" if contact.shear_limit is None else f", at most {contact.shear_limit:g}"
    return words + limit + (f", adhesion {contact.adhesion:g}" if contact.adhesion else "")
