# SPDX-License-Identifier: BSD-3-Clause
"""A solved load history that prints, writes and draws itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from signorini.errors import InputError
from signorini.history_fields import HistoryFields
from signorini.output.archive import write_archive
from signorini.output.atomic_write import atomic_write
from signorini.output.checkpoint import write_checkpoint
from signorini.output.folder import write_folder
from signorini.output.frd import write_frd
from signorini.output.series import with_ranks, write_pvd
from signorini.output.table import history_table
from signorini.output.vtu import write_bodies
from signorini.plot.animation import animate_path
from signorini.plot.look import Look
from signorini.plot.picture_data import PictureData
from signorini.plot.pictures import VIEW, check_picture, picture
from signorini.plot.view import write_view
from signorini.report.page import write_report

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Solution(HistoryFields):
    """A solved load history; see :class:`signorini.solution.history.History` for its fields.

    Printing it gives the table of forces, pressures, states and the certificate; `at` gives any moment of it.
    """

    def __str__(self) -> str:
        return history_table(self)

    def write(self, path: str | Path, *, compress: bool = False) -> None:
        """Write the last state, or everything, as the file's name says.

        Parameters
        ----------
        path : ``.vtu``: the last state with displacement, stress and von Mises stress; ``.pvd``: a series of these for
            ParaView, at the ends of steps and at times asked for; ``.h5``: everything, to be read again with
            :func:`load`; ``.frd``: all steps, as CalculiX writes them; ``.csv``: `contact_table`
        compress : whether ``.vtu`` and ``.h5`` are to be half as large, which takes several times as long

        Raises
        ------
        InputError
            For any other name, or if nothing was solved.
        """
        path = Path(path)
        writers: dict[str, Callable[[], object]] = {
            ".vtu": lambda: write_bodies(self._last_fields(), path, compress=compress),
            ".pvd": lambda: write_pvd(self, self._fields, path, compress=compress),
            ".h5": lambda: write_archive(self, path, compress=compress),
            ".frd": lambda: write_frd(self, with_ranks(self) or self._fields, path),
            ".csv": lambda: self.contact_table().write(path),
        }
        if path.suffix.lower() not in writers:
            words = f"a name that ends in {', '.join(writers)}, or 'save_results' for a folder"
            raise InputError(f"is '{path}'; expected {words}", where=("path",))
        writers[path.suffix.lower()]()

    def save_results(self, folder: str | Path, *, compress: bool = False) -> list[Path]:
        """Write the files that ``signorini run`` writes into a folder, which is made if need be; they are returned.

        What an earlier call left there is replaced. ``signorini plot`` and ``signorini report`` read the folder, and
        :func:`load`. Compressed, large files are half as large and take several times as long.

        Raises
        ------
        InputError
            If the folder cannot be written to, or holds the results of a deck.
        """
        return write_folder(self, Path(folder), compress=compress)

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

        With sensitivities where these were asked for before.

        Raises
        ------
        InputError
            If the name does not end in ``.html``.
        """
        write_report(self, Path(path), self._fields, self.known_sensitivities)

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
