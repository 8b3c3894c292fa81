# SPDX-License-Identifier: BSD-3-Clause
"""A solution as a table of text: what a user wants to know first."""

from __future__ import annotations

import textwrap
from collections.abc import Collection, Iterator, Sequence
from itertools import zip_longest

from signorini.arrays import Array, largest, stored
from signorini.model.mesh import Mesh
from signorini.solution.accuracy import AccuracyResult
from signorini.solution.certificate import TOLERANCE
from signorini.solution.fatigue_result import FatigueResult
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
_NUMBER_COLUMNS = (6, 7, 8)
_ROUNDING_TOL = 1e-12  # of the largest of its kind: smaller numbers are rounding, and printed as 0


def history_table(history: History, *, failure: bool = True) -> str:
    """Forces, pressures, states, reactions and the certificate of every step; at the end why it failed, if asked."""
    mesh, model = history.model.mesh, history.model
    lines = [
        model.title or "untitled",
        f"{model.kind}, {mesh.number_of_nodes} nodes, {mesh.number_of_cells} elements, {history.pairs} contact pairs, "
        f"back end {history.backend}",
    ]
    for number, step in enumerate(history.steps, start=1):
        lines += ["", *_step_lines(step, number)]
    lines += fatigue_lines(history)
    for note in dict.fromkeys(note for step in history.steps for note in step.notes):
        lines += ["", *textwrap.wrap(f"{_whose(note, history.steps)}: {note}", 112)]
    if history.accuracy is not None:
        for line in accuracy_lines(history.accuracy):
            lines += ["", *textwrap.wrap(line, 112, subsequent_indent="    ")]
    if history.wellposedness is not None:
        lines += ["", *textwrap.wrap(f"uniqueness: {history.wellposedness.words}", 112)]
    if failure and not history.solved:
        told = f"{history.status}: {history.message}".splitlines()
        lines += ["", *(part for line in told for part in textwrap.wrap(line, 112, subsequent_indent="    "))]
    return "\n".join(lines)


def accuracy_lines(found: AccuracyResult) -> Iterator[str]:
    """What is known of the accuracy, and of the meshes on the way to it."""
    yield (
        f"estimated errors: pressure {found.pressure:.2%}, with friction {found.traction:.2%}, "
        f"stresses in the norm of energy {found.energy:.2%}"
    )
    asked = found.asked
    if asked is not None and found.value is not None:
        lacking = "not known yet" if found.output is None else f"{found.output:.2%}"
        yield f"{asked.of}: {found.value:.6g}, estimated error {lacking}"
    if asked is not None:
        verdict = "met" if found.met else f"NOT met: {found.reason}"
        nodes = ", ".join(str(level.nodes) for level in found.levels)
        yield f"accuracy {asked.error:.3g} of the {asked.of} {verdict}; {len(found.levels)} meshes of {nodes} nodes"
    for note in found.notes:
        yield f"mesh: {note}"


def _whose(note: str, steps: Sequence[StepResult]) -> str:
    """The word that begins a note, with the numbers of its steps where there are others."""
    numbers = [number for number, step in enumerate(steps, start=1) if note in step.notes]
    if len(numbers) == len(steps):
        return "note"
    return f"note, step{'s' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))}"


def _step_lines(step: StepResult, number: int) -> list[str]:
    count = (
        f"exact path, {len(step.events)} events"
        if step.path == "exact"
        else f"{step.increments} increment{'s' if step.increments > 1 else ''}"
    )
    far = "" if step.finished else f"NOT finished, as far as {step.load_factor - (number - 1):.6%}, "
    pressed = [float((abs(contact.pressure) * contact.area).sum()) for contact in step.contacts]
    held = [float(abs(force).max()) for force in step.reactions.values()]
    noise = _ROUNDING_TOL * max([*pressed, *held], default=0.0)
    still = _ROUNDING_TOL * largest(stored(step, "displacement"))
    rows = [
        (
            contact.name,
            spell_vector(contact.normal_force, noise),
            spell_vector(contact.tangential_force, noise),
            f"{contact.pressure.max(initial=0.0):.5g}",
            spell_vector(contact.points[contact.pressure.argmax()]),
            f"{contact.closed_area:.5g}",
            *(str(contact.count(status)) for status in (OPEN, STICK, SLIP)),
            spell_number(float(contact.slipped.max(initial=0.0)), still),
        )
        for contact in step.contacts
    ]
    reactions = ", ".join(f"{name} {spell_vector(force, noise)}" for name, force in step.reactions.items())
    certificate = step.certificate
    verdict = "passed" if certificate.passed else "NOT passed"
    return [
        f"step {number} '{step.name}', {far}{count} ({', '.join(step.methods)})",
        *(align([_HEAD, *rows], right=_NUMBER_COLUMNS) if rows else ["no contact"]),
        *([f"reactions: {reactions}"] if reactions else []),
        *(
            f"{kind} {name}: moved {spell_vector(found.displacement)}, turned {_turn(found.rotation)}, bears "
            f"force {spell_vector(found.force)}, moment {_turn(found.moment)}"
            for kind, every in (("obstacle", step.obstacles), ("rigid body", step.rigid_bodies))
            for name, found in every.items()
        ),
        *(f"bolt {name}: force {b.force:.6g}, shortened by {b.shortening:.6g}" for name, b in step.bolts.items()),
        *_flow_lines(step),
        *_wear_lines(step),
        f"certificate {verdict}: worst of five {certificate.worst:.1e}, allowed {TOLERANCE:.0e}",
    ]


def _flow_lines(step: StepResult) -> Iterator[str]:
    """How far bodies have yielded, and with what energy; nothing where none may."""
    found, yielding = step.plastic, step.yielding
    if found is None or yielding is None:
        return
    if not yielding.largest:
        yield "plastic flow: none"
        return
    begun = "plastic flow before this step" if yielding.first is None else f"plastic flow from {yielding.first:.6g} on"
    yield (
        f"{begun}: strain up to {yielding.largest:.5g} in '{yielding.body}' at {spell_vector(yielding.at)}, "
        f"{yielding.share:.1%} of the volume; work {found.dissipation:.5g}, {found.stored:.5g} in back stresses, "
        f"energy defect {step.energy_defect:.1e}"
    )


def _wear_lines(step: StepResult) -> Iterator[str]:
    """How deep the sides of every contact are worn, k int p ds, and the way slid that a nominal k P s counts as s."""
    for contact in step.contacts:
        if contact.wear is None:
            continue
        (depth, mortar_depth), (volume, mortar_volume) = contact.wear.deepest, contact.wear.volume
        yield (
            f"worn: {contact.name}: {contact.nonmortar} by up to {depth:.5g}, volume {volume:.5g}; {contact.mortar} by "
            f"up to {mortar_depth:.5g}, volume {mortar_volume:.5g}; slid by up to {contact.wear.distance.max():.5g}"
        )


def fatigue_lines(history: History) -> list[str]:
    """The worst places of all fatigue criteria, an empty line before each."""
    mesh, lines = history.model.mesh, []
    for result in history.fatigue_results:
        lines += ["", *textwrap.wrap(_fatigue_line(result, mesh), 112, subsequent_indent="    ")]
    return lines


def _fatigue_line(result: FatigueResult, mesh: Mesh) -> str:
    """The worst place of a fatigue criterion, and its plane."""
    one = result.at_worst
    amplitude, stress = result.request.criterion.terms
    plane = f", on the plane with the normal {spell_vector(one.plane[0], _ROUNDING_TOL)}" if result.planes else ""
    life = f"; life {one.life[0]:.4g} cycles" if result.lives else ""
    below = f", {result.request.average} at distance {result.request.distance:g}" if result.request.distance else ""
    return (
        f"fatigue, {result.name} over {', '.join(result.steps)}{below}: at most {one.parameter[0]:.5g} in "
        f"'{one.body[0]}' at node {mesh.labels_of(one.node)[0]}, {spell_vector(one.points[0])}{plane}: {amplitude} "
        f"{one.amplitude[0]:.5g}, {stress} {one.stress[0]:.5g}{life}"
    )


def _turn(value: float | Array) -> str:
    return f"{value:.5g}" if isinstance(value, float) else spell_vector(value)


def spell_vector(vector: Array | Sequence[float], noise: float = 0.0) -> str:
    """A vector in five digits; components of at most ``noise`` are 0.

    >>> spell_vector([1e-15, -78.0], noise=1e-10)
    '(0, -78)'
    """
    return f"({', '.join(spell_number(float(part), noise) for part in vector)})"


def spell_number(value: float, noise: float = 0.0) -> str:
    """A number in five digits; 0 if its size is at most ``noise``."""
    return "0" if abs(value) <= noise else f"{value:.5g}"


def align(rows: Sequence[Sequence[str]], *, right: Collection[int] = (), indent: str = "  ") -> list[str]:
    """Lines whose columns stand below each other.

    Parameters
    ----------
    rows : those that are shorter end in empty words
    right : columns that are set flush right, for numbers
    indent : before every line

    Examples
    --------
    >>> print(*align([["name", "n"], ["foundation", "12"], ["top", "3"]], right=[1]), sep="|\\n")
      name         n|
      foundation  12|
      top          3
    >>> align([["a", "b"], ["c"]])
    ['  a  b', '  c']
    """
    widths = [max(map(len, column)) for column in zip_longest(*rows, fillvalue="")]
    lines = []
    for row in rows:
        words = [
            word.rjust(width) if i in right else word.ljust(width)
            for i, (word, width) in enumerate(zip(row, widths, strict=False))
        ]
        lines.append((indent + "  ".join(words)).rstrip())
    return lines
