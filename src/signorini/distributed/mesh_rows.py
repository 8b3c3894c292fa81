# SPDX-License-Identifier: BSD-3-Clause
"""A mesh that ranks keep by rows once it was cut: the first one has its boundaries and names, and asks for the rest."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import MappingProxyType
from typing import Any

from signorini.arrays import IntArray, stored
from signorini.distributed.kept_rows import put_away
from signorini.distributed.ranks import several_ranks
from signorini.fem.space import Block, Space
from signorini.model.mesh import Mesh


class ArraysKept(Mapping[str, Any]):
    """Named arrays that ranks keep by rows; those that are small are here.

    Parameters
    ----------
    arrays : all of them, here
    """

    def __init__(self, arrays: Mapping[str, IntArray]) -> None:
        self._kept = {name: put_away(array) for name, array in arrays.items()}

    def whole(self) -> Mapping[str, IntArray]:
        """All of them, read-only; they are not kept here."""
        return MappingProxyType({name: getattr(kept, "whole", lambda kept=kept: kept)() for name, kept in self.items()})

    def __getitem__(self, name: str) -> Any:
        """An array as it is kept."""
        return self._kept[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._kept)

    def __len__(self) -> int:
        return len(self._kept)


_ALONE, _NAMED = ("points", "node_numbers", "cell_numbers"), ("cells", "bodies")


@contextmanager
def at_hand(mesh: Mesh, blocks: Sequence[Block] = ()) -> Iterator[None]:
    """All of a mesh on the first rank, where parts of it are sent: ranks that wait for theirs cannot be asked.

    Parameters
    ----------
    mesh, blocks : the mesh, and blocks of its space if they are asked for too
    """
    kept = {name: stored(mesh, name) for name in (*_ALONE, *_NAMED)}
    rows = [stored(block, "cells") for block in blocks]
    for name in kept:
        vars(mesh)[name] = getattr(mesh, name)
    for block in blocks:
        vars(block)["cells"] = mesh.cells[block.family]
    try:
        yield
    finally:
        vars(mesh).update(kept)
        for block, cells in zip(blocks, rows, strict=True):
            vars(block)["cells"] = cells


def let_go(space: Space) -> None:
    """Have the ranks keep the mesh of a space by rows, an even share each, if it was lent to them.

    Parameters
    ----------
    space : whose mesh was cut
    """
    team, mesh = several_ranks(), space.mesh
    if team is None or mesh not in team.lent:
        return
    team.lent.remove(mesh)
    assert mesh.extent.size  # it is asked for again and again, and known from now on
    for name in _ALONE:
        if stored(mesh, name) is not None:
            vars(mesh)[name] = put_away(stored(mesh, name))
    for name in _NAMED:
        vars(mesh)[name] = ArraysKept(stored(mesh, name))
    for block in space.blocks:
        vars(block)["cells"] = stored(mesh, "cells")[block.family]
