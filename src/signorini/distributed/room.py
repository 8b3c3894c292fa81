# SPDX-License-Identifier: BSD-3-Clause
"""Whether what ranks will hold fits into the memory of their machines, asked before it is taken."""

from __future__ import annotations

from typing import NamedTuple

from signorini.distributed.ranks import Team
from signorini.errors import InputError
from signorini.memory import available_memory


class Room(NamedTuple):
    """The machine that has least left, or lacks most.

    Attributes
    ----------
    asked, free : what its ranks will take together, and what there is, bytes
    ranks : how many ranks it has
    """

    asked: float
    free: float
    ranks: int

    def refuse(self, what: str) -> None:
        """Refuse what does not fit.

        Parameters
        ----------
        what : takes this

        Raises
        ------
        InputError
            With both sizes, and ways out.

        Examples
        --------
        >>> Room(2e9, 3e9, 4).refuse("a solve")
        >>> Room(4e9, 3e9, 4).refuse("a solve")
        Traceback (most recent call last):
        signorini.errors.InputError: a solve takes about 4 GB on a machine with 4 ranks, and 3 GB of memory are free
        there; expected a coarser mesh, more memory, or ranks on more machines
        """
        if self.asked > self.free:
            raise InputError(
                f"{what} takes about {self.asked / 1e9:.3g} GB on a machine with {self.ranks} "
                f"rank{'s' * (self.ranks > 1)}, and {self.free / 1e9:.3g} GB of memory are free there; expected a "
                "coarser mesh, more memory, or ranks on more machines"
            )


def room_for(team: Team, size: float) -> Room:
    """How much ranks of a machine will take and how much it has, of all machines the one where that fits least.

    Parameters
    ----------
    team : the ranks, which ask together
    size : what this one will take, bytes
    """
    from mpi4py import MPI

    machine = team.comm.Split_type(MPI.COMM_TYPE_SHARED)
    asked, free = machine.allreduce(float(size)), machine.allreduce(float(available_memory()), op=MPI.MIN)
    found = Room(asked, free, int(machine.size))
    machine.Free()
    return Room(*min(team.comm.allgather(found), key=lambda room: room.free - room.asked))
