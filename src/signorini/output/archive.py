# SPDX-License-Identifier: BSD-3-Clause
"""A whole history in one HDF5 file: model, every step, the state at its end; read back exactly."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from signorini._version import __version__
from signorini.arrays import ArrayElsewhere, stored
from signorini.errors import InputError, brief
from signorini.hdf5 import check_hdf5
from signorini.output.atomic_write import atomic_write
from signorini.output.dataclasses_json import AnyArray, from_plain, sealed, to_plain, tuple_of, unsealed
from signorini.solution.history import History

if TYPE_CHECKING:
    import h5py

_FORMAT, _OLDER = "signorini archive 7", ("signorini archive 6", "signorini archive 5", "signorini archive 4")
_STRUCTURE, _END = "structure", "end"  # the text, and what is another one after every step
_SEAL_SIZE = 512  # bytes: the smallest user block that HDF5 has
_AT_ONCE = 1 << 20  # bytes that are read for the digest, and held
_MIN_COMPRESSED = 65536  # bytes: smaller arrays are not worth compressing
_ASCII = 128  # letters, whose numbers are their bytes


def write_archive(history: History, path: Path, *, compress: bool = False) -> None:
    """Write a history.

    Arrays lie under paths like ``/steps/0/displacement``, each once however often it occurs; the text dataset
    ``structure`` holds the rest as JSON. The first 512 bytes, a user block to HDF5, hold a digest of all others.

    Parameters
    ----------
    history, path : what is written, and where
    compress : whether large arrays are
    """
    GrowingArchive(compress=compress).write(history, path)


class GrowingArchive:
    """A history that is written again after every step: what was there before is copied, not made anew.

    Parameters
    ----------
    compress : whether large arrays are
    """

    def __init__(self, *, compress: bool = False) -> None:
        self._compress = compress
        self._known: dict[str, str] = {}
        self._steps: list[Any] = []

    def write(self, history: History, path: Path, *, last: Path | None = None) -> None:
        """Write a history that begins with what was written before.

        Parameters
        ----------
        history : with further steps
        path : of the file, usually ``*.h5``
        last : where the file that was written before is now
        """
        import h5py

        with atomic_write(path) as aside:
            if last is not None:
                shutil.copyfile(last, aside)
            new: dict[str, Any] = {"mode": "w", "userblock_size": _SEAL_SIZE} if last is None else {"mode": "a"}
            with _closing(h5py.File(aside, **new)) as file:
                self._known = {key: name for key, name in self._known.items() if not name.startswith(f"{_END}/")}
                for old in (_END, _STRUCTURE):
                    if old in file:
                        del file[old]

                def keep(name: str, array: AnyArray | ArrayElsewhere, key: str) -> str:
                    if key not in self._known:
                        self._known[key] = name
                        _write(file, name, array, compress=self._compress)
                    return self._known[key]

                for i in range(len(self._steps), len(history.steps)):
                    self._steps.append(to_plain(history.steps[i], f"steps/{i}", keep))
                rest = [field.name for field in fields(History) if field.name != "steps"]
                plain = {name: to_plain(stored(history, name), name, keep) for name in rest}
                plain["steps"] = tuple_of(self._steps)
                file.attrs["format"], file.attrs["signorini"] = _FORMAT, __version__
                file.create_dataset(_STRUCTURE, data=sealed(plain))
            _put_seal(aside)


def _put_seal(path: Path) -> None:
    with path.open("r+b") as file:
        seal = _seal(file, _FORMAT)
        file.seek(0)
        file.write(seal.ljust(_SEAL_SIZE))


def _seal(file: IO[bytes], format_name: str) -> bytes:
    """A digest of the name of the format and of what follows the user block, in letters."""
    found = hashlib.blake2b(format_name.encode(), digest_size=32)
    file.seek(_SEAL_SIZE)
    for part in iter(lambda: file.read(_AT_ONCE), b""):
        found.update(part)
    return found.hexdigest().encode()


def _write(file: h5py.File, name: str, array: AnyArray | ArrayElsewhere, *, compress: bool) -> None:
    """Write an array, one that is elsewhere some rows at a time.

    What is here goes through h5py's lower layer, where a history has thousands: a quarter of the time of its upper one.
    """
    import h5py

    if not isinstance(array, np.ndarray):
        filters = {"compression": "gzip", "compression_opts": 1} if compress else {}
        text = array.dtype.kind == "U"
        kind = h5py.string_dtype("utf-8", array.dtype.itemsize) if text else array.dtype  # 4 bytes a letter at most
        placed = file.create_dataset(name, shape=array.shape, dtype=kind, **filters)
        for first, rows in array.blocks():
            placed[first : first + len(rows)] = _encoded(rows).astype(kind) if text else rows
        return
    if compress and array.nbytes >= _MIN_COMPRESSED and array.dtype.kind != "U":
        file.create_dataset(name, data=array, compression="gzip", compression_opts=1)
        return
    text = array.dtype.kind == "U"
    data = _encoded(array) if text else np.asarray(array, order="C")
    kind = h5py.h5t.py_create(h5py.string_dtype("utf-8", data.dtype.itemsize) if text else data.dtype, logical=True)
    links = h5py.h5p.create(h5py.h5p.LINK_CREATE)
    links.set_create_intermediate_group(True)
    placed = h5py.h5d.create(file.id, name.encode(), kind, h5py.h5s.create_simple(data.shape), None, links)
    placed.write(h5py.h5s.ALL, h5py.h5s.ALL, data, kind)


def _encoded(text: AnyArray) -> AnyArray:
    """Texts as bytes of UTF-8; those of ASCII alone, as states are, without a look at each."""
    codes = np.ascontiguousarray(text).reshape(-1).view(np.uint32)
    if not text.size or codes.max() >= _ASCII:
        return np.char.encode(text, "utf-8")
    return codes.astype(np.uint8).view(f"S{text.dtype.itemsize // codes.itemsize}").reshape(text.shape)


@contextmanager
def _closing(file: h5py.File) -> Iterator[h5py.File]:
    """A file whose last part cannot be written says so as others do."""
    try:
        with file:
            yield file
    except RuntimeError as error:  # what h5py makes of a system that refuses at the end
        raise OSError(str(error)) from error


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
    with path.open("rb") as sealed_file:  # damage can hang HDF5 itself, which must not see it
        seal = sealed_file.read(_SEAL_SIZE).rstrip()
        if seal != _seal(sealed_file, _FORMAT):
            for older in _OLDER:
                if seal == _seal(sealed_file, older):
                    raise InputError(f"'{path}' is '{older}'; expected '{_FORMAT}', by running the deck again")
            raise InputError(f"'{path}' is no archive, damaged, or of another version; expected '{_FORMAT}'")
    check_hdf5(path)
    try:
        with h5py.File(path, "r") as file:
            if file.attrs.get("format") != _FORMAT:
                raise InputError(f"'{path}' is no archive of signorini; expected '{_FORMAT}'")

            def get(name: str) -> AnyArray:
                data = file[name]
                return data.asstr()[...] if h5py.check_string_dtype(data.dtype) else data[...]

            plain = unsealed(file[_STRUCTURE].asstr()[()])
            return History(**{name: from_plain(part, get) for name, part in plain.items()})
    except InputError as error:
        raise InputError(f"'{path}': {error.message}") from error
    except (OSError, RuntimeError, LookupError, TypeError, ValueError, AttributeError) as error:
        raise InputError(f"'{path}' is no archive that can be read: {brief(error)}") from error
