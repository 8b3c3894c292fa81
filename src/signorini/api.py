# SPDX-License-Identifier: BSD-3-Clause
"""The Python door: solve a model and get a solution that prints, writes and draws itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from signorini.clock import Clock
from signorini.engine.prepare import Prepared
from signorini.engine.prepare import prepare as prepare_model
from signorini.engine.solve import raise_failure, solve_prepared
from signorini.engine.solve import solve as solve_history
from signorini.errors import InputError, one_of
from signorini.fem.path import PathResult, along
from signorini.fem.stress import BodyStress
from signorini.model.model import Model
from signorini.output.archive import write_archive
from signorini.output.atomic_write import atomic_write
from signorini.output.checkpoint import read_checkpoint, write_checkpoint
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
from signorini.settings import SolverSettings
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.history import History

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Solution(History):
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
            ".vtu": lambda: write_bodies(self._fields.at(self.last), path),
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
        return along(
            fields.space, self.model, last.displacement, given, body=body, factors=last.factors, plastic=plastic
        )

    @cached_property
    def _fields(self) -> Fields:
        return Fields(self.model)

    def plot(self) -> Figure:
        """Draw pressure and friction of every contact at the end of the last step."""
        return literal(draw_contacts(PictureData(self, self._fields)))

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
    clock: Clock | None = None,
    after_step: Callable[[History], None] | None = None,
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
    clock : counts the seconds and tells progress
    after_step : is given what is finished after every step but the last, to keep it

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
    history = solve_history(
        model,
        start=_checkpoint(start),
        backend=backend,
        settings=settings,
        raise_on_failure=False,
        wellposed=wellposed,
        clock=clock,
        after_step=after_step,
    )
    return _dressed(history, raise_on_failure)


def _checkpoint(start: Start | None) -> Checkpoint | None:
    if isinstance(start, History):
        if start.end is None:
            raise InputError("has finished no step; expected one to go on from", where=("start",))
        return start.end
    return read_checkpoint(Path(start)) if isinstance(start, str | Path) else start


class PreparedModel:
    """A model factorised once, for many loads, friction coefficients and interferences; see :func:`prepare`."""

    def __init__(self, prepared: Prepared) -> None:
        self._prepared = prepared

    def solve(
        self,
        *,
        friction: float | Mapping[str, float] | None = None,
        interference: float | Mapping[str, float] | None = None,
        loads: Mapping[str, float] | None = None,
        raise_on_failure: bool = True,
    ) -> Solution:
        """Solve the load history, with another law or load where given.

        Nothing is factorised again that was for any of the last few histories: other supports, or loads that reach
        more than twice as far, are factorised once.

        Parameters
        ----------
        friction, interference : one number for every contact, or contact to number
        loads : load or moving support to what its value is multiplied by
        raise_on_failure : see :func:`solve`

        Raises
        ------
        InputError, SolveFailed
            As :func:`solve`.
        """
        changed = self._prepared.changed(
            friction=self._by_contact(friction), interference=self._by_contact(interference), loads=loads
        )
        return _dressed(solve_prepared(changed, raise_on_failure=False), raise_on_failure)

    def _by_contact(self, value: float | Mapping[str, float] | None) -> Mapping[str, float] | None:
        if value is None or isinstance(value, Mapping):
            return value
        return {contact.label: value for contact in self._prepared.model.contacts}


def prepare(
    model: Model, *, backend: str = "auto", settings: SolverSettings | None = None, clock: Clock | None = None
) -> PreparedModel:
    """Assemble and condense a model once, to solve it many times.

    Parameters
    ----------
    model : the problem
    backend : of the sparse factorisation, "auto" or a name
    settings : limits of the methods that solve contact
    clock : counts the seconds and tells progress

    Raises
    ------
    InputError
        If the model is wrong; a body that nothing holds is named with its free motion.

    Examples
    --------
    >>> from signorini.gallery.cylinder import zhu_cylinder
    >>> prepared = prepare(zhu_cylinder())
    >>> for mu in (0.0, 0.4):
    ...     print(mu, prepared.solve(friction=mu).contact("foundation").pressure[0].round(2))
    0.0 36.15
    0.4 38.02
    >>> light = prepared.solve(friction=0.0, loads={"cut": 0.25})
    >>> print(light.contact("foundation").normal_force[1].round(9))
    19.5
    """
    return PreparedModel(prepare_model(model, backend=backend, settings=settings, clock=clock).keeping())


def load(path: str | Path) -> Solution:
    """Read a solution that was written as ``.h5``, by :meth:`Solution.write` or ``signorini run``.

    The path may be that of the result folder that holds it. Every number is the same. Another history can go on from
    it: ``solve(model, start=load(path).end)``.

    Raises
    ------
    InputError
        If there is none, or it was written by a version with other data.
    """
    return _dressed(read_results(Path(path)), raise_on_failure=False)


def _dressed(history: History, raise_on_failure: bool) -> Solution:
    solution = Solution(**{name: getattr(history, name) for name in History.__dataclass_fields__})
    if raise_on_failure:
        raise_failure(solution)
    return solution
