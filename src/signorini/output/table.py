# SPDX-License-Identifier: BSD-3-Clause
"""A solution as a table of text: what a user wants to know first."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence

from signorini.arrays import Array
from signorini.output.align import align
from signorini.solution.certificate import TOLERANCE
from signorini.solution.history import History
from signorini.solution.results import OPEN, SLIP, STICK, StepResult

_HEAD = (
    "contact",
    "normal force",
    "friction force",
    "max pressure",
    "at",
    "closed area",
    "open",
    "stick",
    "slip",
    "max slip",
)
_NUMBERS = (6, 7, 8)


def history_table(history: History) -> str:
    """Forces, pressures, states, reactions and the certificate of every step.

    Parameters
    ----------
    history : its numbers are in the units of the model

    Returns
    -------
    Lines joined by newlines, none at the end
    """
    mesh, model = history.model.mesh, history.model
    lines = [
        model.title or "untitled",
        f"{model.kind}, {len(mesh.points)} nodes, {mesh.number_of_cells} elements, {history.pairs} contact pairs, "
        f"back end {history.backend}",
    ]
    for number, step in enumerate(history.steps, start=1):
        lines += ["", *_step_lines(step, number)]
    for note in dict.fromkeys(note for step in history.steps for note in step.notes):
        lines += ["", *textwrap.wrap(f"note: {note}", 112)]
    if not history.solved:
        lines += ["", *textwrap.wrap(f"{history.status}: {history.message}", 112)]
    return "\n".join(lines)


def _step_lines(step: StepResult, number: int) -> list[str]:
    count = f"{step.increments} increment{'s' if step.increments > 1 else ''}"
    rows = [
        (
            contact.name,
            spell_vector(contact.normal_force),
            spell_vector(contact.tangential_force),
            f"{contact.pressure.max(initial=0.0):.5g}",
            spell_vector(contact.points[contact.pressure.argmax()]),
            f"{contact.closed_area:.5g}",
            *(str(contact.count(status)) for status in (OPEN, STICK, SLIP)),
            f"{abs(contact.slip).max(initial=0.0):.4g}",
        )
        for contact in step.contacts
    ]
    reactions = ", ".join(f"{name} {spell_vector(force)}" for name, force in step.reactions.items())
    certificate = step.certificate
    verdict = "passed" if certificate.passed else "NOT passed"
    return [
        f"step {number} '{step.name}', {count} ({', '.join(step.methods)})",
        *(align([_HEAD, *rows], right=_NUMBERS) if rows else ["no contact"]),
        *([f"reactions: {reactions}"] if reactions else []),
        f"certificate {verdict}: worst of five {certificate.worst:.1e}, allowed {TOLERANCE:.0e}",
    ]


def spell_vector(vector: Array | Sequence[float] | Iterable[float]) -> str:
    """A vector in five digits.

    >>> spell_vector([0.0, -78.0])
    '(0, -78)'
    """
    return f"({', '.join(f'{part + 0.0:.5g}' for part in vector)})"
