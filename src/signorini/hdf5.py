# SPDX-License-Identifier: BSD-3-Clause
"""HDF5 files of others: nothing in them may lead to another file, or claim more than there is memory for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from signorini.errors import InputError, brief
from signorini.memory import check_memory


def check_hdf5(path: Path) -> None:
    """Refuse a file that leads out of itself (external and virtual data, external links), or claims too much.

    Raises
    ------
    InputError
        Says which of its members; also for what is no HDF5 file.
    """
    import h5py

    found: list[tuple[str, Any]] = []
    try:
        with h5py.File(path, "r") as file:
            file.visititems_links(lambda name, link: found.append((name, link)))
            for name, link in found:
                if isinstance(link, h5py.ExternalLink):
                    raise InputError(f"'{path}' links '{name}' to another file; expected all in one")
            members = [(name, file[name]) for name, link in found if isinstance(link, h5py.HardLink)]
            data = [(name, item) for name, item in members if isinstance(item, h5py.Dataset)]
            for name, item in data:
                if item.external or item.is_virtual:
                    raise InputError(f"'{path}' has data of another file in '{name}'; expected all in one")
            check_memory(sum(item.nbytes for _, item in data), f"'{path}'")
    except (OSError, RuntimeError, ValueError, KeyError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"'{path}' is no HDF5 file that can be read: {brief(error)}") from error
