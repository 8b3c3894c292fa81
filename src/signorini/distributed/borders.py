# SPDX-License-Identifier: BSD-3-Clause
"""What a rank needs of others for the forces in its piece: displacements of the nodes around its own."""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc

from signorini.arrays import Array, IntArray
from signorini.distributed.ranks import Team


class Border:
    """Displacements of the nodes of a piece, those of other ranks fetched by messages.

    Parameters
    ----------
    team : the ranks
    place : (m,) of the nodes of the piece among all, which are in the order of the ranks
    own : how many of them are this rank's own
    d : displacements of a node
    """

    def __init__(self, team: Team, place: IntArray, own: int, d: int) -> None:
        self._own = PETSc.Vec().createMPI((d * own, None), bsize=d, comm=team.comm)
        self._piece = PETSc.Vec().createSeq(d * len(place), bsize=d)
        nodes = PETSc.IS().createBlock(d, place.astype(PETSc.IntType), comm=PETSc.COMM_SELF)
        self._fetch = PETSc.Scatter().create(self._own, nodes, self._piece, None)

    def with_others(self, u: Array) -> Array:
        """Displacements of the piece; u: those of this rank's own nodes, and maybe others behind them."""
        self._own.array[:] = u[: self._own.getLocalSize()]
        self._fetch.scatter(self._own, self._piece)
        return np.array(self._piece.array)


def hold_border(team: Team, place: IntArray, d: int, stiffness: int, number: int) -> None:
    """Keep what a piece needs of others.

    Parameters
    ----------
    team, place, d : as of `Border`
    stiffness, number : under which the piece is held, and its border will be
    """
    team.held[number] = Border(team, place, int(team.held[stiffness].own.sum()) // d, d)
