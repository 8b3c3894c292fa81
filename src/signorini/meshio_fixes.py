# SPDX-License-Identifier: BSD-3-Clause
"""What meshio lacks: cells that this package has, and an end to files that end too early."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import numpy as np

from signorini.errors import InputError, brief

_SAVED_ALL = " (elements outside all physical groups? Save the groups alone, Mesh.SaveAll = 0)"
_TEXT = {".off": "off", ".bdf": "nastran", ".fem": "nastran", ".nas": "nastran", ".dat": "tecplot", ".tec": "tecplot"}
_BYTES = {".ply": "ply", ".mdpa": "mdpa"}
_PATIENCE = 1000  # empty lines read behind the end of a file by a reader that does not see it


def complete_meshio() -> None:
    """Tell meshio the dimension of the wedge with 15 nodes: version 5.3 reads and writes it, but does not know that."""
    import meshio

    meshio._mesh.topological_dimension.setdefault("wedge15", 3)


class _Ending:
    """Lines of a file that ends also for readers that do not look whether it does."""

    ends = 0

    def readline(self, size: int = -1, /) -> Any:
        line = super().readline(size)  # type: ignore[misc]
        self.ends = 0 if line else self.ends + 1
        if self.ends > _PATIENCE:
            raise EOFError("it ends too early")
        return line


class _Text(_Ending, io.TextIOWrapper):  # type: ignore[misc]
    """Lines of text."""


class _Bytes(_Ending, io.BufferedReader):  # type: ignore[misc]
    """Lines of bytes."""


def _opened(path: Path) -> contextlib.AbstractContextManager[tuple[IO[Any] | Path, str | None]]:
    """What meshio is given to read, and the format where it is not the file itself."""
    suffix = path.suffix.lower()

    @contextlib.contextmanager
    def opened() -> Iterator[tuple[IO[Any] | Path, str | None]]:
        if suffix in _TEXT:
            with _Text(path.open("rb")) as text:
                yield text, _TEXT[suffix]
        elif suffix in _BYTES:
            with _Bytes(io.FileIO(path)) as data:
                yield data, _BYTES[suffix]
        else:
            yield path, None

    return opened()


def read_meshio(path: Path) -> Any:
    """A ``meshio.Mesh``.

    Raises
    ------
    InputError
        If meshio cannot read the file, whatever it says or does then.
    """
    import meshio

    complete_meshio()
    # it prints warnings, multiplies what is no number and ends the process on some malformed files
    said = io.StringIO()
    try:
        with (
            contextlib.redirect_stdout(said),
            contextlib.redirect_stderr(said),
            np.errstate(all="ignore"),
            _opened(path) as (source, kind),
        ):
            return meshio.read(source, file_format=kind)
    except (Exception, SystemExit) as error:
        told = "" if isinstance(error, SystemExit) or not str(error) else brief(error)
        reason = told or " ".join(said.getvalue().split())[:500] or type(error).__name__
        if "gmsh:physical" in reason:
            reason += _SAVED_ALL
        raise InputError(f"meshio cannot read '{path}': {reason}") from error
