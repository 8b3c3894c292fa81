# SPDX-License-Identifier: BSD-3-Clause
"""The Python door: solve a model and get a solution that prints, writes and draws itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from signorini.accuracy.refine import accurate, refuse_one_mesh
from signorini.arrays import Array
from signorini.clock import Clock
from signorini.derivative.differentiable import DifferentiableHistory, tape_of
from signorini.engine.fatigue import assess_fatigue
from signorini.engine.fatigue_places import probe_of
from signorini.engine.solve import raise_failure
from signorini.engine.solve import solve as solve_history
from signorini.engine.stress_history import stress_history
from signorini.engine.tape import Tape
from signorini.errors import InputError, one_of
from signorini.fatigue.criteria import FatigueCriterion
from signorini.fem.path import PathResult, along
from signorini.fem.stress import BodyStress
from signorini.model.accuracy import Asked
from signorini.model.fatigue import Fatigue
from signorini.model.model import Model
from signorini.output.archive import write_archive
from signorini.output.atomic_write import atomic_write
from signorini.output.checkpoint import read_checkpoint, write_checkpoint
from signorini.output.fatigue_csv import fatigue_fields
from signorini.output.fields import Fields
from signorini.output.folder import read_results
from signorini.output.frd import write_frd
from signorini.output.series import write_pvd
from signorini.output.table import history_table
from signorini.output.vtu import write_bodies
from signorini.plasticity.fields import PlasticFields
from signorini.plot.animation import animate_path
from signorini.plot.contact import draw_contacts
from signorini.plot.escape import plot_escape
from signorini.plot.picture_data import PictureData
from signorini.plot.style import literal
from signorini.plot.view import write_view
from signorini.report.page import write_report
from signorini.settings import SolverSettings
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.fatigue_result import FatigueResult
from signorini.solution.history import History
from signorini.solution.stress_history import StressHistory

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Solution(DifferentiableHistory):
    """A solved load history; see :class:`signorini.solution.history.History` for its fields.

    Printing it gives the table of forces, pressures, states and the certificate.
    """

    def __str__(self) -> str:
        return history_table(self)

    def write(self, path: str | Path) -> None:
        """Write the last state, or everything, as the file's name says.

        Parameters
        ----------
        path : ``.vtu``: the last state with displacement, stress and von Mises stress; ``.pvd``: a series of these for
            ParaView, at the ends of steps and at times asked for; ``.h5``: everything, to be read again with
            :func:`load`; ``.frd``: all steps, as CalculiX writes them

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
        }
        if path.suffix.lower() not in writers:
            raise InputError(f"is '{path}'; expected a name that ends in {', '.join(writers)}", where=("path",))
        writers[path.suffix.lower()]()

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

    def stress(self, body: str) -> BodyStress:
        """Stress of a body at its nodes at the end of the last step, not averaged with other bodies.

        Raises
        ------
        InputError
            If there is no such body.
        """
        return self._fields.stresses(self.last)[self._number_of(body)]

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
        number, found = self._number_of(body), self._fields.plastic(self.last)
        if not found:
            raise InputError("no body of the model yields; there is no plastic strain")
        return found[number]

    def _number_of(self, body: str) -> int:
        """Which body of the model has a name."""
        names = [part.name for part in self.model.bodies]
        if body not in names:
            raise InputError(one_of(body, names, "body"))
        return names.index(body)

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
        last, fields = self.last, self._fields
        given, plastic = np.asarray(points, float), fields.plastic_strains(last)
        return along(*fields.on(last), last.displacement, given, body=body, factors=last.factors, plastic=plastic)

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
        number = 0 if points is None else self._number_of(body)
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
    def _fields(self) -> Fields:
        return Fields(self.model)

    @property
    def _fatigue_fields(self) -> dict[str, Array]:
        """Point arrays of the criteria that the model asks for."""
        results = self.fatigue_results
        return fatigue_fields(results, self._fields.stresses(self.last)) if results else {}

    def plot(self) -> Figure:
        """Draw pressure and friction of every contact at the end of the last step."""
        data = PictureData(self, self._fields)
        return literal(draw_contacts(data), data.units)

    def view(self, path: str | Path) -> None:
        """Write a picture of a model in space after the last step, ``*.png``, rendered off-screen.

        Stress of the deformed bodies, pressure and friction of the contact that presses most. Needs PyVista, the extra
        ``signorini[view]``.

        Raises
        ------
        InputError
            If PyVista is not installed, the model is plane, nothing was solved, or the name ends otherwise.
        """
        write_view(PictureData(self, self._fields), Path(path))

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
        return literal(plot_escape(self))

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


Start = Checkpoint | History | str | Path


def solve(
    model: Model,
    *,
    start: Start | None = None,
    backend: str = "auto",
    settings: SolverSettings | None = None,
    raise_on_failure: bool = True,
    wellposed: bool = False,
    accuracy: Asked | None = None,
    tape: bool = False,
    clock: Clock | None = None,
) -> Solution:
    """Solve every step of a model and certify every increment.

    Parameters
    ----------
    model : the problem
    start : a solution, or the file of its :meth:`Solution.save_state`, from whose end this history goes on as if it
        were one with that before: load factors, slips and all that steps have set stay. The model must say the same of
        mesh, bodies, supports, loads and contacts
    backend : of the sparse factorisation, "auto" or a name
    settings : limits of the methods that solve contact
    raise_on_failure : otherwise a solution whose ``status`` says why is returned, with what was solved before
    wellposed : whether to ask if the solution is the only one: ``solution.wellposedness``
    accuracy : relative error of the pressures that is asked for, 0.01 say, or an :class:`Accuracy`: the mesh is refined
        until it is met; "estimate": of the mesh as it is. What is known of it is ``solution.accuracy``
    tape : whether to keep the history as it was followed, in memory, for `Solution.derivative`; with ``start`` that of
        a solution with a tape, too
    clock : counts the seconds and tells progress

    Raises
    ------
    InputError
        If the model is wrong; a body that nothing holds is named with its free motion.
    SolveFailed
        If no certified solution was found; ``.solution`` is what was solved before.
    Interrupted
        A KeyboardInterrupt, on Ctrl-C; ``.solution`` is what was solved before.

    Examples
    --------
    >>> import signorini as sg
    >>> block = sg.rectangle(width=2.0, height=1.0, nx=2, ny=1)
    >>> model = sg.Model(block, bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
    ...                  supports=[sg.Support("left", u=(0, None))], loads=[sg.Load("top", pressure=3.0)],
    ...                  contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)))])
    >>> sg.solve(model).contact("bottom").pressure.round(12)
    array([3., 3., 3.])
    """
    refuse_one_mesh(accuracy, start=start is not None, tape=tape)
    kept = tape_of(start) if tape else None
    follow = partial(
        solve_history,
        start=_checkpoint(start),
        backend=backend,
        settings=settings,
        raise_on_failure=False,
        wellposed=wellposed,
        clock=clock,
        tape=kept,
    )
    history = follow(model) if accuracy is None else accurate(model, accuracy, follow)
    return dressed(history, raise_on_failure, kept)


def _checkpoint(start: Start | None) -> Checkpoint | None:
    if isinstance(start, History):
        if start.end is None:
            raise InputError("has finished no step; expected one to go on from", where=("start",))
        return start.end
    return read_checkpoint(Path(start)) if isinstance(start, str | Path) else start


def load(path: str | Path) -> Solution:
    """Read a solution that was written as ``.h5``, by :meth:`Solution.write` or ``signorini run``.

    The path may be that of the result folder that holds it. Every number is the same. Another history can go on from
    it: ``solve(model, start=load(path).end)``.

    Raises
    ------
    InputError
        If there is none, or it was written by a version with other data.
    """
    return dressed(read_results(Path(path)), raise_on_failure=False)


def dressed(history: History, raise_on_failure: bool, tape: Tape | None = None) -> Solution:
    """A history that prints, writes and draws itself.

    Parameters
    ----------
    history : what was solved
    raise_on_failure : whether to raise what ended it before its end
    tape : of it, where it was asked for
    """
    solution = Solution(**{name: getattr(history, name) for name in History.__dataclass_fields__}, tape=tape)
    if raise_on_failure:
        raise_failure(solution)
    return solution
