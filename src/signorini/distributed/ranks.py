# SPDX-License-Identifier: BSD-3-Clause
"""Ranks that work together: the first one runs the program, the others serve it until it has ended."""

from __future__ import annotations

import itertools
import signal
import sys
import threading
import traceback
import weakref
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import cache
from types import FrameType
from typing import Any

from signorini.errors import InputError

PETSC = "petsc"
"""The name of this way among the back ends: contact is iterated on the bodies."""

MUMPS = "mumps"
"""The name of the other one: bodies are factorised by MUMPS, and contact is solved on the condensed interface."""

ON_RANKS = (PETSC, MUMPS)
"""Back ends whose bodies are on the ranks of MPI."""

_FAILED = 1  # exit code of a run of which a rank has failed
_ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Team:
    """All ranks of a run; see :func:`ranks`.

    Attributes
    ----------
    comm : the communicator of MPI
    rank, size : number of this one, 0 of the first; how many there are
    held : what this rank keeps for the first one, by number
    code : exit code that the first rank leaves with
    away : on the first rank: arrays that all of them keep, as long as somebody has them
    lent : on the first rank: meshes that nobody but the run has, so that ranks may keep them
    owners : on the first rank: (n,) rank of each node of every mesh that was cut, as long as somebody has the mesh
    """

    def __init__(self, comm: Any) -> None:
        self.comm = comm
        self.rank, self.size = int(comm.rank), int(comm.size)
        self.held: dict[int, Any] = {}
        self.code = 0
        self.owners: weakref.WeakKeyDictionary[Any, Any] = weakref.WeakKeyDictionary()
        self.away: weakref.WeakSet[Any] = weakref.WeakSet()
        self.lent: weakref.WeakSet[Any] = weakref.WeakSet()
        self.together = self.size == 1
        self._asking = False
        self._numbers = itertools.count()
        self._dropped: list[int] = []
        self._soon: list[tuple[Callable[..., Any], tuple[Any, ...]]] = []

    @property
    def first(self) -> bool:
        """Whether this rank runs the program."""
        return self.rank == 0

    def total(self, values: Any) -> Any:
        """A number or an array, summed over all ranks: in the order of the ranks, so that all have the same bits."""
        return self._of_all(values).sum(axis=0) if self.size > 1 else values

    def most(self, value: float) -> float:
        """The largest number of all ranks; not a number where that of any is none."""
        return float(self._of_all(value).max()) if self.size > 1 else value

    def _of_all(self, values: Any) -> Any:
        """Numbers of all ranks, by rank, in one message each."""
        import numpy as np  # heavy, and names of this module are asked for by all

        own = np.array(values, dtype=np.float64)
        found = np.empty((self.size, *own.shape))
        self.comm.Allgather(own, found)
        return found

    def kept(self, owner: Any) -> int:
        """A number under which every rank may keep something until an object of the first rank is gone.

        Parameters
        ----------
        owner : the object
        """
        number = next(self._numbers)
        weakref.finalize(owner, self._dropped.append, number)
        return number

    def soon(self, work: Callable[..., Any], *given: Any) -> None:
        """Have all ranks call ``work(team, *given)`` before whatever they are asked for next, in the same message.

        Parameters
        ----------
        work : a function of a module, of whose answer nobody asks anything
        given : what all of them are given
        """
        self._soon.append((work, given))

    def everywhere(self, work: Callable[..., Any], *given: Any, pieces: Iterable[Any] | None = None) -> list[Any]:
        """Have all ranks call ``work(team, *given)``, or ``work(team, piece, *given)``; from the first one alone.

        A signal that ends the program waits until they are done, so that no rank is left behind.

        Parameters
        ----------
        work : a function of a module
        given : what all of them are given
        pieces : one for each rank, made one after the other; what makes them asks the ranks nothing

        Returns
        -------
        What the function returns, by rank.

        Raises
        ------
        RuntimeError
            If pieces or the function ask the ranks something: they wait for what they are asked already. Of several
            ranks all end then.
        """
        if self._asking:
            raise RuntimeError(
                f"internal error: ranks are asked for '{work.__name__}' while they are asked something else; expected "
                "pieces that are made without them"
            )
        if not self.together:
            raise InputError(
                f"{self.size} processes run at once; expected the command line, or in Python what is asked of back end "
                f"'{PETSC}' inside 'with sg.ranks() as first:', by the first one alone"
            )
        dropped, self._dropped[:] = tuple(self._dropped), []
        before, self._soon[:] = tuple(self._soon), []
        with _signals_held_back(), self._asked():
            self.comm.bcast((before, work, given, pieces is not None, dropped))
            own: tuple[Any, ...] = ()
            with self._ending_all():
                for rank, piece in enumerate(pieces or ()):
                    if rank:
                        self.comm.send(piece, dest=rank)
                    else:
                        own = (piece,)
            return list(self._done(before, work, own, given, dropped) or ())

    @contextmanager
    def _asked(self) -> Iterator[None]:
        """Ranks are asked something in the block."""
        self._asking = True
        try:
            yield
        finally:
            self._asking = False

    def serve(self) -> None:
        """Do what the first rank asks for, until it says that it has ended."""
        from signorini.blas_threads import one_thread  # heavy as well

        for number in _ENDING_SIGNALS:
            signal.signal(number, signal.SIG_IGN)  # the first rank hears them too, and ends all
        with one_thread():
            while True:
                before, work, given, in_pieces, dropped = self.comm.bcast(None)
                if work is None:
                    (self.code,) = given
                    return
                self._done(before, work, (self.comm.recv(source=0),) if in_pieces else (), given, dropped)

    def dismiss(self) -> None:
        """Let the other ranks go, and have what they keep here."""
        for array in tuple(self.away):
            array.come_home()
        self.comm.bcast(((), None, (self.code,), False, ()))

    def _done(self, before: Any, work: Callable[..., Any], own: Any, given: tuple[Any, ...], dropped: Any) -> Any:
        """What all ranks return, on the first one.

        What was dropped may be asked for by what is done before.

        What the first one returns may be as large as its interface, and is not sent: MPI would copy it.
        """
        with self._ending_all():
            for sooner, its in before:
                sooner(self, *its)
            let_go = [self.held.pop(number, None) for number in dropped]
            if not all(_is_array(each) for each in let_go):
                del let_go
                _garbage_cleanup()
            result = work(self, *own, *given)
            found = self.comm.gather(None if self.first else result)
            return found and [result, *found[1:]]

    @contextmanager
    def _ending_all(self) -> Iterator[None]:
        """Where the block fails on one of several ranks all end, because the others would wait for ever."""
        try:
            yield
        except Exception as error:
            if self.size == 1:
                raise
            where = "".join(traceback.format_tb(error.__traceback__)[-1:]).strip()
            words = " ".join(str(error).split())
            print(f"signorini: rank {self.rank} failed: {type(error).__name__}: {words}; {where}", file=sys.stderr)
            sys.stderr.flush()
            self.comm.Abort(_FAILED)
            raise


@contextmanager
def ranks() -> Iterator[bool]:
    """Work together inside: True on the first rank, which runs the program, False on the others, once it has ended.

    Examples
    --------
    A script that ``mpiexec -n 4 python script.py`` runs; without ``mpiexec`` it is the same on one rank::

        with sg.ranks() as first:
            if first:
                sg.solve(model, backend="petsc").write("out.vtu")

    Raises
    ------
    InputError
        If petsc4py or mpi4py cannot be imported.
    """
    with whole_team() as team:
        yield team.first


@contextmanager
def whole_team() -> Iterator[Team]:
    """The team of :func:`ranks`; what the first one sets as its ``code`` the others have when they come out."""
    team = the_team()
    if not team.first:
        team.serve()
        yield team
        return
    before, team.together = team.together, True
    try:
        yield team
    finally:
        if team.size > 1:
            team.dismiss()
        team.together = before


@cache
def the_team() -> Team:
    """All ranks of this run, PETSc initialised.

    Raises
    ------
    InputError
        If petsc4py or mpi4py cannot be imported.
    """
    try:
        import petsc4py

        # arguments are ours; those of PETSc are in PETSC_OPTIONS
        petsc4py.init(["signorini", "-no_signal_handler"])
        from mpi4py import MPI
    except ImportError as error:
        raise InputError(
            f"back ends '{PETSC}' and '{MUMPS}' need petsc4py and mpi4py ({error}); docs/distributed.md says how they "
            "are installed"
        ) from error
    return Team(MPI.COMM_WORLD)


def several_ranks() -> Team | None:
    """All ranks of this run where there are several and they work together; otherwise None, and nothing is imported."""
    team = the_team() if the_team.cache_info().currsize else None
    return team if team is not None and team.together and team.size > 1 else None


def ranks_with(mesh: Any) -> tuple[Team, Any] | None:
    """The ranks among which bodies on a mesh were cut, and (n,) which of them has every node; None where none have.

    Parameters
    ----------
    mesh : of the bodies
    """
    team = several_ranks()
    owner = None if team is None else team.owners.get(mesh)
    return None if team is None or owner is None else (team, owner)


def lend(mesh: Any) -> None:
    """Let ranks have a mesh of which nobody but this run asks anything, once it was cut.

    Parameters
    ----------
    mesh : of a deck that is run
    """
    team = several_ranks()
    if team is not None:
        team.lent.add(mesh)


def _is_array(value: Any) -> bool:
    """Whether something holds nothing of PETSc, on this rank and so on all."""
    import numpy as np

    return isinstance(value, np.ndarray)


def _garbage_cleanup() -> None:
    """Free what all ranks have let go: PETSc frees together what was made together."""
    from petsc4py import PETSc

    PETSc.garbage_cleanup()


@contextmanager
def _signals_held_back() -> Iterator[None]:
    """Raise KeyboardInterrupt after the block if a signal to end came in it; handlers are of the main thread alone."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard: list[int] = []

    def hear(number: int, _: FrameType | None) -> None:
        heard.append(number)

    before = {number: signal.signal(number, hear) for number in _ENDING_SIGNALS}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler or signal.SIG_DFL)  # None: one that was not set by Python
    if heard:
        raise KeyboardInterrupt
