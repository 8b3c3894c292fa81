# SPDX-License-Identifier: BSD-3-Clause
"""The Python door: solve a model and get a solution that prints, writes and draws itself."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from signorini.clock import Clock
from signorini.errors import SolveFailed
from signorini.model.model import Model
from signorini.output.table import history_table
from signorini.output.vtu import write_vtu
from signorini.plot.contact import plot_contact
from signorini.solution.history import History
from signorini.solve import solve as solve_history

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False)
class Solution(History):
    """A solved load history; see :class:`signorini.solution.history.History` for its fields.

    Printing it gives the table of forces, pressures, states and the certificate.
    """

    def __str__(self) -> str:
        return history_table(self)

    def write(self, path: str | Path) -> None:
        """Write the last state as a VTU file with displacement, stress and von Mises stress."""
        write_vtu(self, Path(path))

    def plot(self) -> Figure:
        """Draw pressure and friction of every contact at the end of the last step."""
        return plot_contact(self)


def solve(
    model: Model, *, backend: str = "auto", raise_on_failure: bool = True, clock: Clock | None = None
) -> Solution:
    """Solve every step of a model and certify every increment.

    Parameters
    ----------
    model : the problem
    backend : of the sparse factorisation, "auto" or a name
    raise_on_failure : otherwise a solution whose ``status`` says why is returned, with the steps finished before
    clock : counts the seconds and tells progress

    Raises
    ------
    InputError
        If the model is wrong; a body that nothing holds is named with its free motion.
    SolveFailed
        If no certified solution was found; ``.solution`` is what was finished before.

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
    try:
        history = solve_history(model, backend=backend, raise_on_failure=raise_on_failure, clock=clock)
    except SolveFailed as failure:
        raise SolveFailed(str(failure), status=failure.status, solution=_dressed(failure.solution)) from failure
    return _dressed(history)


def _dressed(history: object) -> Solution:
    assert isinstance(history, History)
    return Solution(**{name: getattr(history, name) for name in History.__dataclass_fields__})
