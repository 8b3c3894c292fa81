# SPDX-License-Identifier: BSD-3-Clause
"""The Python door: solve a model, or read what was solved."""

from __future__ import annotations

import sys
from functools import cache, partial
from multiprocessing import parent_process
from pathlib import Path

from signorini.clock import Clock
from signorini.derivative.differentiable import tape_of
from signorini.engine.first_run import FIRST_SOLVE, compiled
from signorini.engine.solve import raise_failure
from signorini.engine.solve import solve as solve_history
from signorini.engine.tape import Tape
from signorini.errors import InputError
from signorini.model.accuracy import Asked
from signorini.model.model import Model
from signorini.output.checkpoint import read_checkpoint
from signorini.output.folder import read_results
from signorini.settings import SolverSettings
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.history import History
from signorini.solved import Solution

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
    backend : of the sparse factorisation, "auto" or a name; or "iterative", on the bodies as they are, or on several
        ranks, see :func:`ranks`, "petsc" as they are and "mumps" factorised
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
    tell_first_solve()
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
    if accuracy is None:
        return dressed(follow(model), raise_on_failure, kept)
    from signorini.accuracy.refine import accurate, refuse_one_mesh  # not before an accuracy is asked for

    refuse_one_mesh(accuracy, start=start is not None, tape=tape)
    return dressed(accurate(model, accuracy, follow), raise_on_failure, kept)


@cache
def tell_first_solve() -> None:
    """Say where somebody reads it, on a terminal or in a notebook, that the first solve on a machine compiles; once."""
    read = sys.stderr.isatty() or "ipykernel" in sys.modules
    if read and parent_process() is None and not compiled():  # one of several processes would write into a bar
        print(FIRST_SOLVE, file=sys.stderr)


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
