# SPDX-License-Identifier: BSD-3-Clause
"""A solved history and what is asked of it in numbers: any moment, paths, stresses over steps, fatigue, columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from signorini.derivative.differentiable import DifferentiableHistory
from signorini.engine.fatigue import assess_fatigue
from signorini.engine.fatigue_places import probe_of
from signorini.engine.moments import at_rest
from signorini.engine.outside import outside, outside_names
from signorini.engine.recovery import Recovery
from signorini.engine.stress_history import stress_history
from signorini.errors import InputError
from signorini.fatigue.criteria import FatigueCriterion
from signorini.fem.path import PathResult
from signorini.fem.stress import BodyStress
from signorini.history_moment import HistoryMoment, body_number
from signorini.model.fatigue import Fatigue
from signorini.output.contact_table import contact_table
from signorini.output.fatigue_csv import with_fatigue_fields
from signorini.output.fields import BodyFields, Fields
from signorini.output.history_table import history_columns
from signorini.output.result_table import ResultTable
from signorini.plasticity.fields import PlasticFields
from signorini.solution.fatigue_result import FatigueResult
from signorini.solution.moment import at_load, event_load, increment_end, instant_at, step_number
from signorini.solution.stress_history import StressHistory

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class HistoryFields(DifferentiableHistory):
    """A solved load history with the fields of its bodies and contacts, at any moment and over all of it."""

    def at(
        self,
        step: int | str | None = None,
        *,
        load: float | None = None,
        increment: int | None = None,
        event: int | None = None,
    ) -> HistoryMoment:
        """The bodies and contacts at a moment of the history; the end of the last step if nothing is said.

        On an exact path at any load: between two events all is linear. Displacements that were not kept are found when
        they are asked for, by one solution of a linear system.

        Parameters
        ----------
        step : its name, or its number from 1; the last one if not given
        load : part of the step, 0 .. 1; where a jump is, behind it
        increment, event : the end of an increment, or an event of an exact path, by its number in the step from 1

        Raises
        ------
        InputError
            If there is no such moment, or the step is not linear there: what is known is named.

        Examples
        --------
        >>> import signorini as sg
        >>> block = sg.rectangle(width=2.0, height=1.0, nx=2, ny=1)
        >>> model = sg.Model(block, bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
        ...                  supports=[sg.Support("left", u=(0, None))], loads=[sg.Load("top", pressure=3.0)],
        ...                  contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), name="floor")],
        ...                  steps=[sg.Step(name="press", path="exact")])
        >>> half = sg.solve(model).at("press", load=0.5)
        >>> half.contact("floor").pressure.round(12), half.stress("block").stress[:, 1].max().round(12)
        (array([1.5, 1.5, 1.5]), np.float64(-1.5))
        """
        if sum(part is not None for part in (load, increment, event)) > 1:
            raise InputError("has more than one of 'load', 'increment' and 'event'; expected one of them")
        number = step_number(self, step)
        if event is not None:
            load = event_load(self, number, event)
        if load is None:
            place = increment_end(self, number, increment)
        else:
            place = at_load(self, number, load, partial(at_rest, self))
        return HistoryMoment(
            history=self,
            number=number,
            instant=instant_at(self, place),
            fields=self._fields,
            recovery=lambda: self._recovery,
        )

    def stress(self, body: str) -> BodyStress:
        """Stress of a body at its nodes at the end of the last step, not averaged with other bodies.

        Raises
        ------
        InputError
            If there is no such body.
        """
        return self.at().stress(body)

    def plastic(self, body: str) -> PlasticFields:
        """Plastic strain and back stress of a body at the nodes of its `stress`, at the end of the last step.

        Raises
        ------
        InputError
            If there is no such body, or none that yields.

        Examples
        --------
        >>> import signorini as sg
        >>> steel = sg.Elastic(E=100.0, nu=0.3, plastic=sg.Plastic(4.0, hardening=50.0))
        >>> bar = sg.Model(sg.rectangle(width=2.0), kind="plane stress", bodies=[sg.Body("block", steel)],
        ...                supports=[sg.Support("left", u=(0, None)), sg.Support("bottom", u=(None, 0))],
        ...                loads=[sg.Load("right", traction=(5.0, 0))])
        >>> sg.solve(bar).plastic("block").equivalent.round(12)
        array([0.02, 0.02, 0.02, 0.02])
        """
        return self.at().plastic(body)

    def along(self, points: ArrayLike, *, body: str) -> PathResult:
        """Displacement and stress of a body at points (n, 2), say ``np.linspace(start, end, 50)``, after the last step.

        Raises
        ------
        InputError
            If there is no such body, or a point lies outside it.

        Examples
        --------
        >>> import signorini as sg
        >>> bar = sg.Model(sg.rectangle(width=2.0, nx=2), bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
        ...                supports=[sg.Support("left", u=(0, 0))], loads=[sg.Load("right", traction=(5.0, 0))])
        >>> path = sg.solve(bar).along([(0.0, 0.5), (1.5, 0.5)], body="block")
        >>> path.displacement[:, 0].round(12), path.stress[:, 0].round(12)
        (array([0.   , 0.075]), array([5., 5.]))
        """
        return self.at().along(points, body=body)

    def stress_history(
        self,
        where: str | Sequence[str] = (),
        *,
        points: ArrayLike | None = None,
        body: str = "",
        steps: Sequence[str] = (),
    ) -> StressHistory:
        """Stresses and strains over steps at every event, between which they are linear on an exact path.

        Displacements that were not kept are found from the forces of the contacts, some at once.

        Parameters
        ----------
        where : contacts, boundaries, node sets and bodies whose nodes are looked at; all contacts if none is named
        points : (n, d) undeformed coordinates inside a body instead, length
        body : by name, in which points are
        steps : by name; the last one if none is named. Of a step that repeats, the last cycle

        Raises
        ------
        InputError
            For an unknown name, and where displacements do not follow from loads and contacts alone and were not kept.

        Examples
        --------
        >>> import signorini as sg
        >>> bar = sg.Model(sg.rectangle(width=2.0, nx=2), bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
        ...                supports=[sg.Support("left", u=(0, 0))], loads=[sg.Load("right", traction=(5.0, 0))])
        >>> sg.solve(bar).stress_history(points=[(1.5, 0.5)], body="block").stress[0, :, 0].round(12)
        array([0., 5.])
        """
        number = 0 if points is None else body_number(self.model, body)
        given = None if points is None else np.atleast_2d(np.asarray(points, float))
        names = (where,) if isinstance(where, str) else where
        probe, places = probe_of(self._fields.space, self.model, names, given, number)
        return stress_history(self, probe, places, steps=(steps,) if isinstance(steps, str) else steps)

    def fatigue(
        self,
        criterion: FatigueCriterion,
        *,
        where: str | Sequence[str] = (),
        steps: str | Sequence[str] = (),
        distance: float = 0.0,
        average: Literal["point", "line"] = "point",
    ) -> FatigueResult:
        """What a fatigue criterion says along steps: parameters, critical planes and lives.

        Parameters
        ----------
        criterion, where, steps, distance, average : as of :class:`signorini.model.fatigue.Fatigue`

        Raises
        ------
        InputError
            As `stress_history`; and where a critical distance leaves a body.

        Examples
        --------
        >>> import signorini as sg
        >>> bar = sg.Model(sg.rectangle(width=2.0, nx=2), bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
        ...                supports=[sg.Support("left", u=(0, 0))], loads=[sg.Load("right", traction=(5.0, 0))])
        >>> sg.solve(bar).fatigue(sg.fatigue.SWT(), where="top").parameter.round(12)
        array([0.125, 0.125, 0.125])
        """
        request = Fatigue(criterion, where=where, steps=steps, distance=distance, average=average)
        return assess_fatigue(self, request, lambda: self._fields.space)

    @cached_property
    def history(self) -> ResultTable:
        """Loads, contacts, energies, reactions and approaches at every instant, as columns.

        One row an event, increment, kink of the loads, time asked for and end of a step. ``SUPPORT.reaction_x``,
        ``LOAD.approach`` (how far its points move along it), ``OBSTACLE.displacement_x``, ... are found when they are
        asked for; NaN is what is not known.

        Examples
        --------
        >>> import signorini as sg
        >>> bar = sg.Model(sg.rectangle(width=2.0, nx=2), bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
        ...                supports=[sg.Support("left", u=(0, 0))], loads=[sg.Load("right", traction=(5.0, 0))])
        >>> history = sg.solve(bar).history
        >>> print(history["left.reaction_x"].round(9), history["right.approach"].round(9))
        [-5.] [0.1]
        """
        return history_columns(self, outside_names(self.model), lambda: outside(self, lambda: self._recovery))

    def contact_table(self) -> ResultTable:
        """Nonmortar nodes at the ends of all steps, one row each: ``contact.csv``, and normals, forces, slips.

        Behind its columns: ``arc_length`` along the side in the plane, ``normal_x``, ..., ``force_x``, ... (nodal
        forces on the nonmortar body), ``sliding``, ``slip_range`` and ``slip_amplitude`` of the last cycle,
        ``dissipation_per_area``.
        """
        return contact_table(self.model, [(k, step.contacts) for k, step in enumerate(self.steps, start=1)])

    def to_dataframe(self) -> pandas.DataFrame:
        """`contact_table` as a pandas table.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        return self.contact_table().to_dataframe()

    @cached_property
    def _fields(self) -> Fields:
        return Fields(self.model)

    @cached_property
    def _recovery(self) -> Recovery:
        return Recovery.of(self)

    def _last_fields(self) -> BodyFields:
        """The bodies at the end, with what the criteria say that the model asks for."""
        return with_fatigue_fields(self._fields, self)
