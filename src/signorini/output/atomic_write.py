# SPDX-License-Identifier: BSD-3-Clause
"""Files that are whole or not there: written aside, then moved to their final names."""

from __future__ import annotations

import csv
import os
import tempfile
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """Give a path beside ``path`` to write to; at the end of the block it replaces ``path``.

    If the block fails, nothing bears the final name and nothing is left aside.

    Examples
    --------
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with atomic_write(Path(folder, "a.txt")) as aside:
    ...         _ = aside.write_text("whole")
    ...     [(file.name, file.read_text()) for file in Path(folder).iterdir()]
    [('a.txt', 'whole')]
    """
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}.", suffix=path.suffix)
    os.close(handle)
    aside = Path(name)
    try:
        yield aside
        aside.chmod(0o666 & ~_umask())
        os.replace(aside, path)
    finally:
        aside.unlink(missing_ok=True)


def write_csv(columns: Collection[str], rows: Iterable[Mapping[str, Any]], path: Path) -> None:
    """Write rows by column to ``path``, below the names of the columns; numbers read back exactly."""
    with atomic_write(path) as aside, aside.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def _umask() -> int:
    """The process's mask for new files (``mkstemp`` makes private ones)."""
    mask = os.umask(0)
    os.umask(mask)
    return mask
