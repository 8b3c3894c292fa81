# SPDX-License-Identifier: BSD-3-Clause
"""All refusals of a deck at once, as far as one does not follow from another, and what to write instead."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from signorini.deck.error import DeckError

_SOLIDS = "write the part as solid or plane elements with a *SOLID SECTION"
_SLOWLY = "write *STATIC, which is right for loads that act slowly"
_TEMPERATURES = "write *STATIC, and the temperatures of that analysis as *TEMPERATURE"
_SMALL_STRAINS = "write *ELASTIC, which is right for strains up to some per cent"
_ELASTIC_ANSWER = "leave it out for the answer at once, without the time that it takes"

ADVICE = {
    **dict.fromkeys(("SHELL SECTION", "MEMBRANE SECTION", "BEAM SECTION", "BEAM GENERAL SECTION"), _SOLIDS),
    **dict.fromkeys(("SHELL GENERAL SECTION", "TRUSS SECTION", "FRAME SECTION", "COHESIVE SECTION"), _SOLIDS),
    **dict.fromkeys(("DYNAMIC", "MODAL DYNAMIC", "STEADY STATE DYNAMICS", "COMPLEX FREQUENCY"), _SLOWLY),
    **dict.fromkeys(("HEAT TRANSFER", "COUPLED TEMPERATURE-DISPLACEMENT"), _TEMPERATURES),
    "UNCOUPLED TEMPERATURE-DISPLACEMENT": _TEMPERATURES,
    **dict.fromkeys(("HYPERELASTIC", "HYPERFOAM", "MOONEY-RIVLIN", "DEFORMATION PLASTICITY"), _SMALL_STRAINS),
    **dict.fromkeys(("CREEP", "VISCOELASTIC", "RATE DEPENDENT"), _ELASTIC_ANSWER),
    **dict.fromkeys(("DAMAGE INITIATION", "DAMAGE EVOLUTION"), "leave it out, and see where its criterion is exceeded"),
    **dict.fromkeys(("SPRING", "SPRINGA", "JOINTC"), "write *EQUATION, or a part of solid elements as stiff as it is"),
    **dict.fromkeys(("GAP", "GAPUNI"), "write a *CONTACT PAIR of the surfaces that it stands between"),
    "DASHPOT": "leave it out: nothing moves fast enough for it here",
    "MPC": "write *EQUATION, *RIGID BODY or *COUPLING",
    "DISTRIBUTING COUPLING": "write *COUPLING with *KINEMATIC, or the force as *DSLOAD on the surface",
    "SUBMODEL": "write the displacements of the coarse model as *BOUNDARY",
    "USER MATERIAL": "write *ELASTIC and *PLASTIC",
    "NODAL THICKNESS": "write the thickness under *SOLID SECTION",
    "BASE MOTION": "write the motion as *BOUNDARY",
    "INITIAL STRAIN INCREASE": "write *EXPANSION and *TEMPERATURE that strain as much",
}
"""What to write instead of a keyword that stops a deck."""

MOST_TOLD = 20
"""Refusals that are told at once: more than a screen of them helps nobody."""

_LINES_TOLD = 5  # of one refusal that stands in many lines


class Refusals:
    """Refusals of a deck that do not follow from each other.

    Examples
    --------
    >>> refusals = Refusals()
    >>> for line in (3, 7, 9):
    ...     with refusals.gather():
    ...         raise DeckError("*MPC: no" if line < 9 else "*GAP: no", path="a.inp", line=line)
    >>> refusals.stop()
    Traceback (most recent call last):
    signorini.deck.error.DeckError: a.inp:3: *MPC: no (line 7 too)
    a.inp:9: *GAP: no
    """

    def __init__(self) -> None:
        self._found: list[DeckError] = []

    @contextmanager
    def gather(self) -> Iterator[None]:
        """Keep the refusal that ends what stands inside, and go on behind it."""
        try:
            yield
        except DeckError as error:
            self._found.append(error)

    def stop(self) -> None:
        """Raise what has been gathered, each refusal once, with its place and the further ones.

        Raises
        ------
        DeckError
            If there is any.
        """
        if not self._found:
            return
        alike: dict[tuple[str, str], list[DeckError]] = {}
        for error in self._found:
            alike.setdefault((str(error.path), error.message), []).append(error)
        files = list(dict.fromkeys(str(error.path) for error in self._found))
        told = [_once(errors) for errors in alike.values()]
        told.sort(key=lambda error: (files.index(str(error.path)), error.line or 0))
        if len(told) > MOST_TOLD:
            last = told[MOST_TOLD - 1]
            last = DeckError(
                f"{last.message}; {len(told) - MOST_TOLD} more behind it are not told", path=last.path, line=last.line
            )
            told[MOST_TOLD - 1 :] = [last]
        first, *others = told
        raise DeckError(first.message, path=first.path, where=first.where, line=first.line, others=others)


def _once(errors: list[DeckError]) -> DeckError:
    """One refusal of several that say the same, with their lines."""
    first, *others = errors
    lines = [str(error.line) for error in others if error.line is not None and error.line != first.line]
    if not lines:
        return first
    more = f" and {len(lines) - _LINES_TOLD} more" if len(lines) > _LINES_TOLD else ""
    words = f"line{'s' * (len(lines) > 1)} {', '.join(lines[:_LINES_TOLD])}{more} too"
    return DeckError(f"{first.message} ({words})", path=first.path, where=first.where, line=first.line)
