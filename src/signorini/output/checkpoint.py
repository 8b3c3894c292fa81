# SPDX-License-Identifier: BSD-3-Clause
"""States as files: a NumPy archive, written whole or not at all."""

from __future__ import annotations

import zipfile
from dataclasses import fields
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from signorini.errors import InputError
from signorini.output.replacing import replacing
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.state import LoadPoint, State

_FORMAT = "signorini state 2"
_ARRAYS = tuple(field.name for field in fields(State) if field.name not in ("point", "work", "released"))


def write_checkpoint(checkpoint: Checkpoint, path: Path) -> None:
    """Write a state; every number is read back exactly as it is.

    Parameters
    ----------
    checkpoint : of a history, see :class:`signorini.solution.history.History`
    path : of the file, usually ``*.npz``
    """
    state, point = checkpoint.state, checkpoint.state.point
    parts: dict[str, Any] = {name: getattr(state, name) for name in _ARRAYS}
    parts |= {"initial_gap": point.gap, "given": point.given, "work": state.work, "released": state.released}
    parts |= {"names": np.array(list(point.factors), dtype=str), "factors": np.array(list(point.factors.values()))}
    parts |= {"reaction": point.reaction, "offset": point.offset}
    parts |= {"inactive": np.array(sorted(checkpoint.inactive), dtype=str)}
    parts |= {"let_go": np.array(sorted(checkpoint.released), dtype=str)}
    parts |= {"contacts": np.array(checkpoint.contacts, dtype=str)}
    parts |= {"contact": checkpoint.contact, "node": checkpoint.node, "mesh": checkpoint.mesh, "format": _FORMAT}
    with replacing(path) as aside, aside.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **parts)


def read_checkpoint(path: Path) -> Checkpoint:
    """Read a state that :func:`write_checkpoint` has written.

    Raises
    ------
    InputError
        If there is no such file, or it holds something else.
    """
    if not path.is_file():
        raise InputError(f"there is no file '{path}'; expected a state that a run has written")
    try:
        with np.load(path, allow_pickle=False) as file:
            parts = {name: file[name] for name in file.files}
        if str(parts["format"]) != _FORMAT:
            raise InputError(f"'{path}' is '{parts['format']}'; expected '{_FORMAT}'")
        factors = {str(name): float(factor) for name, factor in zip(parts["names"], parts["factors"], strict=True)}
        point = LoadPoint(
            factors=MappingProxyType(factors),
            gap=parts["initial_gap"],
            given=parts["given"],
            reaction=parts["reaction"],
            offset=parts["offset"],
        )
        state = State(
            point=point,
            work=float(parts["work"]),
            released=float(parts["released"]),
            **{name: parts[name] for name in _ARRAYS},
        )
        return Checkpoint(
            state=state,
            inactive=frozenset(str(name) for name in parts["inactive"]),
            released=frozenset(str(name) for name in parts["let_go"]),
            contacts=tuple(str(name) for name in parts["contacts"]),
            contact=parts["contact"],
            node=parts["node"],
            mesh=str(parts["mesh"]),
        )
    except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"'{path}' is no state that a run has written: {error}") from error
