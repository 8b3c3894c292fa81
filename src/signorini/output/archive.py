# SPDX-License-Identifier: BSD-3-Clause
"""A whole history in one HDF5 file: model, every step, the state at its end; read back exactly."""

from __future__ import annotations

import hashlib
import json
from dataclasses import fields
from pathlib import Path

import numpy as np

from signorini._version import __version__
from signorini.errors import InputError
from signorini.output.plain import AnyArray, from_plain, to_plain
from signorini.output.replacing import replacing
from signorini.solution.history import History

_FORMAT = "signorini archive 2"
_FROM = 65536  # bytes: smaller arrays are not worth compressing


def write_archive(history: History, path: Path) -> None:
    """Write a history.

    Arrays lie under paths like ``/steps/0/displacement``, each once however often it occurs; the text dataset
    ``structure`` holds the rest as JSON.

    Parameters
    ----------
    path : of the file, usually ``*.h5``
    """
    import h5py

    with replacing(path) as aside, h5py.File(aside, "w") as file:
        known: dict[tuple[str, bytes], str] = {}

        def keep(name: str, array: AnyArray) -> str:
            key = (f"{array.dtype.str}{array.shape}", hashlib.blake2b(np.ascontiguousarray(array).tobytes()).digest())
            if key in known:
                return known[key]
            known[key] = name
            data = array.astype(h5py.string_dtype()) if array.dtype.kind == "U" else array
            small = array.nbytes < _FROM or array.dtype.kind == "U"
            file.create_dataset(name, data=data, **({} if small else {"compression": "gzip", "compression_opts": 1}))
            return name

        plain = {field.name: to_plain(getattr(history, field.name), field.name, keep) for field in fields(History)}
        file.attrs["format"], file.attrs["signorini"] = _FORMAT, __version__
        file.create_dataset("structure", data=json.dumps(plain))


def read_archive(path: Path) -> History:
    """Read a history that :func:`write_archive` has written.

    Raises
    ------
    InputError
        If there is no such file, or it holds something else.
    """
    import h5py

    if not path.is_file():
        raise InputError(f"there is no file '{path}'; expected an archive that a run has written")
    try:
        with h5py.File(path, "r") as file:
            if file.attrs.get("format") != _FORMAT:
                raise InputError(f"'{path}' is no archive of signorini; expected '{_FORMAT}'")

            def get(name: str) -> AnyArray:
                data = file[name]
                return data.asstr()[...] if h5py.check_string_dtype(data.dtype) else data[...]

            plain = json.loads(file["structure"].asstr()[()])
            return History(**{name: from_plain(part, get) for name, part in plain.items()})
    except InputError as error:
        raise InputError(f"'{path}': {error.message}") from error
    except (OSError, KeyError, TypeError, ValueError, AttributeError) as error:
        raise InputError(f"'{path}' is no archive that can be read: {error}") from error
