# SPDX-License-Identifier: BSD-3-Clause
"""A solved load history: its steps, what it cost, and whether it was finished."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from signorini.arrays import Array, elsewhere
from signorini.errors import InputError, one_of
from signorini.model.model import Model
from signorini.outcome import Outcome
from signorini.short import Short
from signorini.solution.accuracy import AccuracyResult
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.fatigue_result import FatigueResult
from signorini.solution.results import ContactResult, Instant, StepResult
from signorini.solution.wellposedness import WellPosedness

PHASES = ("read", "assembly", "factorisation", "condensation", "complementarity", "recovery", "output", "total")


@elsewhere("escape")
@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class History(Short):
    """The end of every step, of one that could not be finished how far it was followed.

    Attributes
    ----------
    model : what was solved
    status : SOLVED, or why not, with its ``advice``; RUNNING while the next step is being solved
    message : the same in words, empty where solved
    steps : certified, in order; the last one may not be finished, see `StepResult`
    backend : of the factorisation
    timings : seconds by phase
    pairs : contact pairs
    end : the state at the end of the last finished step, from which another history may go on; None before the first
    wellposedness : whether other solutions exist, where that was asked
    begin : the end of the history that it goes on from; None where it begins with bodies at rest
    fatigue_results : of the criteria that the model asks for, where every step was solved
    accuracy : estimated errors, where these were asked for; None
    escape : (nodes, d) rigid motion along which bodies run away where that was found, largest entry 1; otherwise None
    """

    model: Model
    status: Outcome
    message: str
    steps: tuple[StepResult, ...]
    backend: str
    timings: Mapping[str, float]
    pairs: int
    end: Checkpoint | None = None
    wellposedness: WellPosedness | None = None
    begin: Instant | None = None
    fatigue_results: tuple[FatigueResult, ...] = ()
    accuracy: AccuracyResult | None = None
    escape: Array | None = None

    def __post_init__(self) -> None:
        """An archive holds the word alone."""
        object.__setattr__(self, "status", Outcome(self.status))

    @property
    def solved(self) -> bool:
        """Whether every step was solved and certified."""
        return self.status == Outcome.SOLVED

    @property
    def loaded(self) -> bool:
        """Whether it goes on from another whose end pressed on contacts."""
        contacts = () if self.begin is None else self.begin.contacts
        return any(bool(contact.pressure.any() or contact.traction.any()) for contact in contacts)

    @property
    def last(self) -> StepResult:
        """The last step, finished or not.

        Raises
        ------
        InputError
            If nothing was solved.
        """
        if not self.steps:
            raise InputError("nothing was solved; there is no result")
        return self.steps[-1]

    def contact(self, name: str) -> ContactResult:
        """A contact at the end of the last step, by name."""
        return find_contact(self.last, name)


def find_contact(state: StepResult | Instant, name: str) -> ContactResult:
    """A contact in a state, by name.

    Raises
    ------
    InputError
        If there is none of that name; the known ones are listed.
    """
    for contact in state.contacts:
        if contact.name == name:
            return contact
    raise InputError(one_of(name, [contact.name for contact in state.contacts], "contact"))
