# SPDX-License-Identifier: BSD-3-Clause
"""Threads: one of BLAS wherever numbers are made, several for parts of large models that do not need each other.

With several threads BLAS forms sums in another order, and last digits differ.
"""

from __future__ import annotations

import ctypes
import itertools
import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from pathlib import Path
from typing import Any

from scipy.linalg import cython_blas

from signorini.errors import InputError

_NUMPY = ("numpy._core._multiarray_umath", "numpy.core._multiarray_umath")  # NumPy 2 and 1


def thread_functions(library: str) -> tuple[Any, Callable[[], int]] | None:
    """What sets and gives the number of threads of the OpenBLAS that a library is linked to.

    None for another BLAS, or on a system whose loader does not look into the libraries of a library.

    Parameters
    ----------
    library : file name of an extension module
    """
    loaded = ctypes.CDLL(library)
    for prefix, suffix in itertools.product(("scipy_openblas", "openblas"), ("", "64_")):
        setter = getattr(loaded, f"{prefix}_set_num_threads{suffix}", None)
        getter = getattr(loaded, f"{prefix}_get_num_threads{suffix}", None)
        if setter and getter:
            return setter, getter
    return None


def _libraries() -> list[tuple[Any, Callable[[], int]]]:
    """Functions of SciPy and NumPy, which bring a BLAS each."""
    modules = [cython_blas, *(sys.modules[name] for name in _NUMPY if name in sys.modules)]
    found = (thread_functions(str(module.__file__)) for module in modules)
    return [functions for functions in found if functions is not None]


_found = _libraries()
_lock = threading.Lock()
_outside: list[int] = []
_depth = 0
_asked: ContextVar[int | None] = ContextVar("threads", default=None)


@contextmanager
def one_thread() -> Iterator[None]:
    """Hold the BLAS of SciPy and NumPy to one thread inside.

    Blocks may lie within each other, and in several threads: the last one to end lets go.

    >>> with one_thread(), one_thread():
    ...     print([get() for _, get in _found] in ([], [1], [1, 1]))
    True
    """
    global _depth
    with _lock:
        if _depth == 0:
            _outside[:] = [get() for _, get in _found]
            for set_number, _ in _found:
                set_number(1)
        _depth += 1
    try:
        yield
    finally:
        with _lock:
            _depth -= 1
            if _depth == 0:
                for (set_number, _), number in zip(_found, _outside, strict=True):
                    set_number(number)


@contextmanager
def threads(number: int | None) -> Iterator[None]:
    """Let large models share a number of threads inside; None leaves it at what it is.

    Without it they share as many as the environment variable ``OMP_NUM_THREADS`` says, or as there are physical cores.
    Results are the same to the last bit.

    Raises
    ------
    InputError
        For fewer than one.

    Examples
    --------
    >>> with threads(3):
    ...     print(number_of_threads())
    3
    """
    if number is None:
        yield
        return
    if isinstance(number, bool) or not isinstance(number, int) or number < 1:
        raise InputError(f"threads = {number!r}; expected a whole number, at least 1")
    token = _asked.set(number)
    try:
        yield
    finally:
        _asked.reset(token)


def number_of_threads() -> int:
    """How many threads large models share; see `threads`."""
    asked = _asked.get()
    if asked is not None:
        return asked
    first = os.environ.get("OMP_NUM_THREADS", "").split(",")[0].strip()
    return int(first) if first.isdecimal() and int(first) > 0 else physical_cores()


@cache
def physical_cores() -> int:
    """Cores that this process may use, each counted once though it may run several threads.

    >>> physical_cores() >= 1
    True
    """
    mine = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set(range(os.cpu_count() or 1))
    cores = set()
    for cpu in mine:
        try:  # Linux; elsewhere every processor counts
            cores.add(Path(f"/sys/devices/system/cpu/cpu{cpu}/topology/thread_siblings_list").read_text())
        except OSError:
            cores.add(str(cpu))
    return len(cores)
