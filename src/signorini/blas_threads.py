# SPDX-License-Identifier: BSD-3-Clause
"""One thread of BLAS wherever numbers are made: with more, sums are formed in another order and last digits differ."""

from __future__ import annotations

import ctypes
import itertools
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from scipy.linalg import cython_blas

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
