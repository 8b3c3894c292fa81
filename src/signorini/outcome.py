# SPDX-License-Identifier: BSD-3-Clause
"""How the solution of a problem, a part of a history or a whole history ended: one vocabulary for all of them."""

from __future__ import annotations

from enum import StrEnum


class Outcome(StrEnum):
    """The ending in one word, as ``summary.json`` holds it, with its advice.

    Attributes
    ----------
    advice : what it means, and what to do about it

    Examples
    --------
    >>> Outcome.JUMP == "jump", Outcome("not_found")
    (True, 'not_found')
    >>> print(Outcome.NO_EQUILIBRIUM.advice.partition(":")[0])
    Proved
    """

    advice: str

    SOLVED = "solved", "Every number of the certificate is at most its tolerance: the answer may be used."
    FOLLOWED = "followed", "The end of a part of a history was reached, certified on the way."
    NO_EQUILIBRIUM = (
        "no_equilibrium",
        "Proved: under these loads there is no equilibrium. Hold the bodies that leave, or change loads or friction; "
        "more increments or another method cannot help.",
    )
    NOT_FOUND = (
        "not_found",
        "Neither a solution nor a proof that there is none. Smaller increments, less friction, or moduli, sizes and "
        "compliances less far apart may help.",
    )
    JUMP = (
        "jump",
        "No equilibrium continues the history gradually: bodies slide, snap or lift at once. Prescribe a motion in "
        "place of the load, lower the friction, or let jump = 'follow' look for the equilibrium behind the jump.",
    )
    DISTURBED = (
        "disturbed",
        "The way was cut short because another problem goes on from there, say where a body that rested is touched; "
        "the history goes on by itself.",
    )
    INTERRUPTED = "interrupted", "Stopped from outside; a run can go on from the last step that was finished."
    RUNNING = (
        "running",
        "The next step is being solved; of a run that stays so the process was killed, and the last step that was "
        "finished is where it can go on.",
    )

    def __new__(cls, word: str, advice: str = "") -> Outcome:
        """A word that knows its advice."""
        made = str.__new__(cls, word)
        made._value_, made.advice = word, advice
        return made

    def __repr__(self) -> str:
        return repr(self.value)
