# SPDX-License-Identifier: BSD-3-Clause
"""A history whose answers have derivatives: from its tape, or solved again with one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from signorini.derivative.derivative import Derivative
from signorini.derivative.refusals import refuse_model
from signorini.derivative.sensitivities import sensitivities
from signorini.derivative.tangent import HistoryTangent, tangent, tangent_sides
from signorini.derivative.taped_history import TapedHistory
from signorini.engine.solve import raise_failure, solve
from signorini.engine.tape import Tape
from signorini.errors import InputError
from signorini.model.outputs import Output
from signorini.solution.history import History
from signorini.solution.sensitivities import Sensitivities


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class DifferentiableHistory(History):
    """A solved load history with the derivatives of its answers.

    Attributes
    ----------
    tape : the history as it was followed; None unless asked for
    """

    tape: Tape | None = None

    def derivative(self, output: Output) -> Derivative:
        """The derivative of an output by everything that is given, exact through all events of the history.

        From what ``solve(model, tape=True)`` keeps; otherwise the history is solved again, once.

        Parameters
        ----------
        output : ``signorini.pressure("c").peak``, ``signorini.force("c", along=(1, 0))``, ...

        Raises
        ------
        InputError
            By name, what derivatives do not know: jumps, bodies that yield, contacts that wear or slide far, ...

        Examples
        --------
        >>> import signorini as sg
        >>> block = sg.rectangle(width=2.0, height=1.0, nx=2, ny=1)
        >>> model = sg.Model(block, bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
        ...                  supports=[sg.Support("left", u=(0, None))], loads=[sg.Load("top", pressure=3.0)],
        ...                  contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), name="floor")])
        >>> D = sg.solve(model, tape=True).derivative(sg.pressure("floor").peak)
        >>> round(D.value, 9), round(D.load["top"], 9), abs(round(D.E["block"], 9))
        (3.0, 3.0, 0.0)
        """
        return Derivative(self._taped, output)

    def tangent(self, *, at: float | None = None, **parameter: str) -> HistoryTangent:
        """What one parameter changes of every field of the contacts, ``tangent(friction="c")``.

        Parameters
        ----------
        at : load factor, k at the end of step k; the end of the history if not given
        parameter : its kind and name: ``E="pad"``, ``load="press"``, ...

        Raises
        ------
        InputError
            As `derivative`, and where it has two sides.
        """
        return tangent(self._taped, *_one(parameter), at)

    def tangent_sides(self, *, at: float | None = None, **parameter: str) -> tuple[HistoryTangent, HistoryTangent]:
        """What one parameter changes downwards and upwards, parameters as of `tangent`; mostly the same.

        They differ where pairs touch before anything is loaded, and at an event at the end.

        Raises
        ------
        InputError
            As `derivative`, and where one of both is not known.
        """
        return tangent_sides(self._taped, *_one(parameter), at)

    def sensitivities(self) -> Sensitivities:
        """Peak pressures, resultants, half-widths and dissipation by all that is given, per cent for per cent.

        Raises
        ------
        InputError
            As `derivative`.
        """
        return self._sensitivities

    @property
    def known_sensitivities(self) -> Sensitivities | None:
        """Sensitivities that were asked for, which reports show; None where none were."""
        found: Sensitivities | None = self.__dict__.get("_sensitivities")
        return found

    @cached_property
    def _sensitivities(self) -> Sensitivities:
        """What `sensitivities` gives, found once."""
        return sensitivities(self._taped)

    @cached_property
    def _taped(self) -> TapedHistory:
        """The history on its tape, solved again where it was solved without one."""
        if self.tape is not None:
            return TapedHistory(self.tape, self.model)
        if self.loaded:
            raise InputError("goes on from another history; solve both with 'tape=True' for derivatives")
        refuse_model(self.model)
        tape = Tape()
        raise_failure(solve(self.model, tape=tape, raise_on_failure=False))
        return TapedHistory(tape, self.model)


def _one(parameter: Mapping[str, str]) -> tuple[str, str]:
    """Kind and name of one parameter."""
    if len(parameter) != 1:
        raise InputError(f"has {len(parameter)} parameters; expected one, friction='contact'", where=("parameter",))
    return next(iter(parameter.items()))


def tape_of(start: object) -> Tape:
    """A tape for a history: one that goes on from that of a solution, where there is one."""
    if isinstance(start, DifferentiableHistory) and start.tape is not None:
        return Tape(
            legs=list(start.tape.legs), whole=start.tape.whole, lost=start.tape.lost, changed=start.tape.changed
        )
    return Tape(whole=start is None)
