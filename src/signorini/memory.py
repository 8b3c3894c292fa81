# SPDX-License-Identifier: BSD-3-Clause
"""The memory that this process has held, and that there still is."""

from __future__ import annotations

import ctypes
import mmap
import os
import sys
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

import numpy as np

from signorini.arrays import Array
from signorini.errors import InputError, Where

try:
    import resource
except ImportError:  # Windows has no such module
    resource = None  # type: ignore[assignment]

_GROUP_FILES = {
    "": ("memory.max", "memory.current", "inactive_file"),
    "memory": ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
}
"""Limit and use of a control group, and in ``memory.stat`` what of it is cached files that give way."""

_NO_LIMIT = 1 << 62
"""Bytes from which a limit says that there is none, in groups of the first version, whose use need not be read."""

_MOST_READ = 1 << 16  # bytes of a file of the system, whose files have a few thousand
_ARENA_MAX = -8  # M_ARENA_MAX of glibc's malloc.h

_PAGES_FROM = 1_000_000
"""Numbers, 8 MB of them, from which memory is asked of the system: what is smaller the C library takes from what was
given back before, without a page fault for every 4 kB, which took up to a tenth of a factorisation."""

_WAYS_OUT = "expected a coarser mesh, more memory, or in space back end 'iterative'"


def peak_memory() -> int:
    """Bytes; 0 where the system does not tell.

    >>> peak_memory() > 1_000_000 or sys.platform == "win32"
    True
    """
    if resource is None:
        return 0
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return int(peak if sys.platform == "darwin" else 1024 * peak)  # macOS counts bytes, Linux kilobytes


def available_memory() -> int:
    """Bytes that this process can still take without swapping: of the machine, and under limits set for the process.

    Half of all memory where the system does not say.

    >>> available_memory() > 1_000_000
    True
    """
    return max(0, min([_of_the_machine(), *_under_limits(), *_in_groups()]))


def _of_the_machine() -> int:
    try:
        return 1024 * int(_read("/proc/meminfo").split(b"MemAvailable:", 1)[1].split(None, 1)[0])
    except (OSError, IndexError):
        pages = os.sysconf("SC_PHYS_PAGES") if hasattr(os, "sysconf") else 2**21
        return pages * 4096 // 2


def _read(path: str) -> bytes:
    """A file of the system, whose numbers are few: every solve asks, and a small one takes hundredths of a second."""
    file = os.open(path, os.O_RDONLY)
    try:
        return os.read(file, _MOST_READ)
    finally:
        os.close(file)


def _under_limits() -> Iterator[int]:
    """What ``ulimit -v`` and ``ulimit -d`` leave."""
    if resource is None:
        return
    for limit, place in ((resource.RLIMIT_AS, 0), (resource.RLIMIT_DATA, 5)):
        most = resource.getrlimit(limit)[0]
        if most != resource.RLIM_INFINITY:
            try:
                used = int(_read("/proc/self/statm").split()[place])
            except (OSError, ValueError, IndexError):
                return
            yield most - used * resource.getpagesize()


def _in_groups() -> Iterator[int]:
    """What the control groups of the process leave: those of containers and batch systems, of both versions."""
    for most, used, stat, idle in _groups():
        try:
            limit = int(_read(most))  # "max" where there is none
            if limit < _NO_LIMIT:
                files = (b"\n" + _read(stat)).split(b"\n%s " % idle.encode(), 1)
                yield limit - int(_read(used)) + (int(files[1].split(None, 1)[0]) if len(files) > 1 else 0)
        except (OSError, ValueError):  # none that is limited
            pass


@cache
def _groups() -> tuple[tuple[str, str, str, str], ...]:
    """Of the control groups that limit the memory of the process: files of limit, use and more, and what there is idle.

    They are found once.
    """
    try:
        lines = Path("/proc/self/cgroup").read_text().splitlines()
    except OSError:
        return ()
    found = []
    for _, kinds, path in (line.split(":", 2) for line in lines):
        if kinds in _GROUP_FILES:
            root = Path("/sys/fs/cgroup", kinds)
            here = root / path.lstrip("/")
            within = [folder for folder in (here, *here.parents) if folder.is_relative_to(root)]
            most, used, idle = _GROUP_FILES[kinds]
            there = [folder for folder in within if (folder / most).exists()]
            found += [(f"{own / most}", f"{own / used}", f"{own / 'memory.stat'}", idle) for own in there]
    return tuple(found)


def give_memory_back() -> None:
    """Let the system have memory that was freed and that the C library keeps; nothing where it keeps none for good.

    Between one large phase and the next a tenth of all that a process holds may be such memory.

    >>> give_memory_back()
    """
    with suppress(AttributeError, OSError, TypeError):  # of glibc alone
        ctypes.CDLL(None).malloc_trim(0)


def share_one_heap() -> None:
    """Have all threads of this process take memory from one heap; nothing where the C library is not glibc.

    From heaps of their own, of 64 MB each, what they free on top is never given back. For a process of our own, before
    it has threads.

    >>> share_one_heap()
    """
    with suppress(AttributeError, OSError, TypeError):
        ctypes.CDLL(None).mallopt(_ARENA_MAX, 1)


def apart(size: int) -> Array:
    """Numbers that are not set yet and whose memory the system has again as soon as nobody holds them.

    What threads free the C library keeps for them, up to 64 MB for each. Pages that nobody writes to take no memory.

    Parameters
    ----------
    size : how many; below 8 MB they come from the C library

    Raises
    ------
    MemoryError
        Where the system has no room for them.

    Examples
    --------
    >>> apart(3).shape, apart(1_200_000).shape
    ((3,), (1200000,))
    """
    if size < _PAGES_FROM:
        return np.empty(size)
    try:
        return np.frombuffer(mmap.mmap(-1, 8 * size), dtype=np.float64)
    except OSError as error:
        raise MemoryError(f"{8e-9 * size:.3g} GB at once") from error


def out_of_memory(error: MemoryError) -> str:
    """What did not fit, what was held, what is free, and ways out.

    >>> out_of_memory(MemoryError("an array"))  # doctest: +ELLIPSIS
    "out of memory (an array): ... GB were held, ... GB are free; expected a coarser mesh, ..."
    """
    held, free = (f"{size / 1e9:.3g} GB" for size in (peak_memory(), available_memory()))
    asked = f" ({error})" if str(error) else ""
    return f"out of memory{asked}: {held} were held, {free} are free; {_WAYS_OUT}"


def check_memory(size: float, what: str, where: Where = ()) -> None:
    """Refuse what takes a size of more bytes than there are, with where it stands.

    Raises
    ------
    InputError
        With both sizes.

    Examples
    --------
    >>> check_memory(1e18, "a mesh of 1e15 cells")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    signorini.errors.InputError: a mesh of 1e15 cells takes 1e+09 GB of memory; there are ...
    """
    free = available_memory()
    if size > free:
        raise InputError(f"{what} takes {size / 1e9:.3g} GB of memory; there are {free / 1e9:.3g} GB", where=where)
