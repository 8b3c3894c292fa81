# SPDX-License-Identifier: BSD-3-Clause
"""States as files: a NumPy archive, written whole or not at all."""

from __future__ import annotations

import zipfile
import zlib
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.lib.format import dtype_to_descr, write_array, write_array_header_1_0

from signorini.arrays import ArrayElsewhere
from signorini.errors import InputError, brief
from signorini.output.atomic_write import atomic_write
from signorini.output.dataclasses_json import AnyArray, from_plain, sealed, to_plain, unsealed
from signorini.solution.checkpoint import Checkpoint

_FORMAT = "signorini state 6"

_UNREADABLE = (
    *(OSError, EOFError, ValueError, LookupError, TypeError, RuntimeError, MemoryError),
    *(NotImplementedError, zipfile.BadZipFile, zlib.error),
)
"""Errors of NumPy and the archive's reader on damaged files, and on files that claim more than there is."""


def write_checkpoint(checkpoint: Checkpoint, path: Path, *, compress: bool = False) -> None:
    """Write a state; every number is read back exactly as it is.

    Arrays are members of the archive under names like ``state/displacement``; ``structure`` holds the rest as JSON, and
    digests by which damage is found.

    Parameters
    ----------
    checkpoint, path : what is written, and where
    compress : whether it is to be half as large, which takes several times as long
    """
    arrays: dict[str, Any] = {}

    def keep(name: str, array: AnyArray, _: str) -> str:
        arrays[name] = array
        return name

    structure = sealed(to_plain(checkpoint, "end", keep))
    arrays |= {"format": np.array(_FORMAT), "structure": np.array(structure)}
    kind = zipfile.ZIP_DEFLATED if compress else zipfile.ZIP_STORED
    with atomic_write(path) as aside, zipfile.ZipFile(aside, "w", kind) as archive:
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                _write_array(member, array)


def _write_array(file: IO[bytes], array: AnyArray | ArrayElsewhere) -> None:
    """An array as NumPy's archives hold it; one that ranks keep some rows at a time, it is not made here."""
    if not isinstance(array, np.ndarray):
        header = {"descr": dtype_to_descr(array.dtype), "fortran_order": False, "shape": array.shape}
        write_array_header_1_0(file, header)
        for _, rows in array.blocks():
            file.write(rows.tobytes())
    else:
        write_array(file, array, allow_pickle=False)


def read_checkpoint(path: Path) -> Checkpoint:
    """Read a state that :func:`write_checkpoint` has written.

    Raises
    ------
    InputError
        If there is no such file, or it holds something else.
    """
    if not path.is_file():
        raise InputError(f"there is no file '{path}'; expected a state that a run has written")
    if not zipfile.is_zipfile(path):
        raise InputError(f"'{path}' is no state that a run has written")
    try:
        with np.load(path, allow_pickle=False) as file:
            if str(file["format"]) != _FORMAT:
                raise InputError(f"'{path}' is '{file['format']}'; expected '{_FORMAT}'")
            found = from_plain(unsealed(str(file["structure"])), file.__getitem__)
    except InputError as error:
        raise error if str(path) in error.message else InputError(f"'{path}': {error.message}") from error
    except _UNREADABLE as error:
        raise InputError(f"'{path}' is no state that a run has written: {brief(error)}") from error
    assert isinstance(found, Checkpoint)
    return found
