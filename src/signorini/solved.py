# SPDX-License-Identifier: BSD-3-Clause
"""A solved load history that prints, writes and draws itself, and is asked for stresses along paths and over steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array
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
from signorini.output.archive import write_archive
from signorini.output.atomic_write import atomic_write
from signorini.output.checkpoint import write_checkpoint
from signorini.output.contact_table import contact_table
from signorini.output.fatigue_csv import fatigue_fields
from signorini.output.fields import Fields
from signorini.output.folder import write_folder
from signorini.output.frd import write_frd
from signorini.output.history_table import history_columns
from signorini.output.result_table import ResultTable
from signorini.output.series import write_pvd
from signorini.output.table import history_table
from signorini.output.vtu import write_bodies
from signorini.plasticity.fields import PlasticFields
from signorini.plot.animation import animate_path
from signorini.plot.look import Look
from signorini.plot.picture_data import PictureData
from signorini.plot.pictures import VIEW, check_picture, picture
from signorini.plot.view import write_view
from signorini.report.page import write_report
from signorini.solution.fatigue_result import FatigueResult
from signorini.solution.moment import at_load, counted, instant_at, step_number
from signorini.solution.stress_history import StressHistory

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Solution(DifferentiableHistory):
    """A solved load history; see :class:`signorini.solution.history.History` for its fields.

    Printing it gives the table of forces, pressures, states and the certificate; `at` gives any moment of it.
    """

    def __str__(self) -> str:
        return history_table(self)

    def write(self, path: str | Path) -> None:
        """Write the last state, or everything, as the file's name says.

        Parameters
        ----------
        path : ``.vtu``: the last state with displacement, stress and von Mises stress; ``.pvd``: a series of these for
            ParaView, at the ends of steps and at times asked for; ``.h5``: everything, to be read again with
            :func:`load`; ``.frd``: all steps, as CalculiX writes them; ``.csv``: `contact_table`

        Raises
        ------
        InputError
            For any other name, or if nothing was solved.
        """
        path = Path(path)
        writers: dict[str, Callable[[], object]] = {
            ".vtu": lambda: write_bodies(self._fields.at(self.last), path, self._fatigue_fields),
            ".pvd": lambda: write_pvd(self, self._fields, path),
            ".h5": lambda: write_archive(self, path),
            ".frd": lambda: write_frd(self, self._fields, path),
            ".csv": lambda: self.contact_table().write(path),
        }
        if path.suffix.lower() not in writers:
            words = f"a name that ends in {', '.join(writers)}, or 'save_results' for a folder"
            raise InputError(f"is '{path}'; expected {words}", where=("path",))
        writers[path.suffix.lower()]()

    def save_results(self, folder: str | Path) -> list[Path]:
        """Write the files that ``signorini run`` writes into a folder, which is made if need be; they are returned.

        What an earlier call left there is replaced. ``signorini plot`` and ``signorini report`` read the folder, and
        :func:`load`.

        Raises
        ------
        InputError
            If the folder cannot be written to, or holds the results of a deck.
        """
        return write_folder(self, Path(folder))

    def save_state(self, path: str | Path) -> None:
        """Write the end of the last finished step, from which :func:`solve` can go on: a NumPy archive, ``*.npz``.

        Raises
        ------
        InputError
            If no step was finished.
        """
        if self.end is None:
            raise InputError("no step was finished; there is no state to save")
        write_checkpoint(self.end, Path(path))

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
        if load is None:
            place = counted(self, number, increment, event)
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
        return assess_fatigue(self, request, self._fields.space)

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

    @property
    def _fatigue_fields(self) -> dict[str, Array]:
        """Point arrays of the criteria that the model asks for."""
        results = self.fatigue_results
        return fatigue_fields(results, self._fields.stresses(self.last)) if results else {}

    def plot(
        self,
        what: str = "contact",
        *,
        step: int | str | None = None,
        load: float | None = None,
        component: str | None = None,
        range: tuple[float, float] | None = None,
        zoom: Sequence[float] | None = None,
        scale: float | None = None,
    ) -> Figure:
        """Draw a picture at the end of the last step, or at a moment that :meth:`at` knows, as `signorini plot` does.

        Parameters
        ----------
        what : "contact": pressure and friction of every contact; "stress", "displacement", "peeq" and "mesh" of the
            bodies; "history", "wear", "fatigue", "accuracy", "escape"
        step, load : the moment, as of :meth:`at`
        component : of a stress, "von_mises", "principal", "least_principal" or two directions, "xy"; of a displacement,
            "magnitude" or a direction
        range : smallest and largest value of the colours, or of the axis of pressures
        zoom : from and to along every direction of the picture: x and y, in space x, y and z; along a contact
        scale : factor of displacements, 0: undeformed

        Raises
        ------
        InputError
            If there is no such picture, or moment, or choice of it: what is expected is named.

        Examples
        --------
        >>> import signorini as sg
        >>> block = sg.rectangle(width=2.0, height=1.0, nx=2, ny=1)
        >>> model = sg.Model(block, bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
        ...                  supports=[sg.Support("bottom", u=(0, 0))], loads=[sg.Load("top", pressure=3.0)])
        >>> sg.solve(model).plot("stress", component="yy", range=(-4, 0)).axes[-1].get_ylabel()
        'stress yy, force per area'
        """
        return picture(
            self._pictured(what, Look(component=component, range=range, zoom=zoom, scale=scale), step, load), what
        )

    def _pictured(self, what: str, look: Look, step: int | str | None, load: float | None) -> PictureData:
        """What a picture shows at a moment."""
        check_picture(what, self, look, {"step": step, "load": load})
        if step is None and load is None:
            return PictureData(self, self._fields, look=look)
        moment = self.at(step, load=load)
        when = f"end of step '{moment.step}'" if load is None else f"step '{moment.step}' at {moment.load:.6g} of it"
        return PictureData(self, self._fields, moment=moment, when=when, look=look)

    def view(self, path: str | Path, *, step: int | str | None = None, load: float | None = None) -> None:
        """Write a picture of a model in space, ``*.png``, rendered off-screen.

        Stress of the deformed bodies, pressure and friction of the contact that presses most. Needs PyVista, the extra
        ``signorini[view]``.

        Parameters
        ----------
        path : of the file
        step, load : the moment, as of :meth:`at`; the end of the last step if not given

        Raises
        ------
        InputError
            If PyVista is not installed, the model is plane, nothing was solved, or the name ends otherwise.
        """
        write_view(self._pictured(VIEW, Look(), step, load), Path(path))

    def report(self, path: str | Path) -> None:
        """Write a report, one HTML file that needs nothing else: problem, results, certificate, curves, pictures.

        Raises
        ------
        InputError
            If the name does not end in ``.html``.
        """
        write_report(self, Path(path), self._fields)

    def plot_escape(self) -> Figure:
        """Draw the motion along which bodies run away, where no equilibrium was found because of it.

        Raises
        ------
        InputError
            If there is none.
        """
        return self.plot("escape")

    def animate(self, path: str | Path, *, contact: str | None = None, frames: int = 100) -> None:
        """Write a GIF of pressure, friction and slip of a contact along the whole history.

        Parameters
        ----------
        path : of the file, ``*.gif``
        contact : by name; the first where not given
        frames : pictures, equally many for every straight segment of the loads
        """
        with atomic_write(Path(path)) as aside:
            animate_path(self, aside, contact=contact, frames=frames)
