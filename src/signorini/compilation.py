# SPDX-License-Identifier: BSD-3-Clause
"""How loops are compiled: what Python calls, what only compiled loops call, and without searches for garbage."""

from __future__ import annotations

import gc
import pickle
from collections.abc import Callable
from typing import Any, TypeVar

from numba import njit
from numba.core import event
from numba.core.caching import IndexDataCacheFile

_Loop = TypeVar("_Loop", bound=Callable[..., Any])


def kernel(**options: Any) -> Callable[[_Loop], _Loop]:
    """Compile what Python calls; the first run leaves it on disk. A wrapper for callers in C would be for nobody.

    Parameters
    ----------
    options : further ones of Numba's
    """
    decorate: Callable[[_Loop], _Loop] = njit(cache=True, no_cfunc_wrapper=True, **options)  # type: ignore[call-overload]

    def kept(loop: _Loop) -> _Loop:
        compiled = decorate(loop)
        index = getattr(getattr(compiled, "_cache", None), "_cache_file", None)
        if type(index) is IndexDataCacheFile:
            index.__class__ = _Index
        return compiled

    return kept


class _Index(IndexDataCacheFile):
    """What of a loop is on disk: nothing, where it is of a version of the package whose classes are gone.

    Numba reads the index before it asks whether it is of this file, and an update of the package leaves it there.
    """

    def _load_index(self) -> dict[Any, str]:
        try:
            found: dict[Any, str] = super()._load_index()  # type: ignore[no-untyped-call]
        except (AttributeError, ImportError, EOFError, pickle.UnpicklingError):
            return {}
        return found


def part(**options: Any) -> Callable[[_Loop], _Loop]:
    """Compile what kernels alone call, which hold a copy of it on disk: without any wrapper.

    Parameters
    ----------
    options : further ones of Numba's
    """
    decorate: Callable[[_Loop], _Loop] = njit(no_cpython_wrapper=True, no_cfunc_wrapper=True, **options)  # type: ignore[call-overload]
    return decorate


class _NoGarbage(event.Listener):
    """No search for garbage while Numba compiles: it makes millions of objects that stay, and searches look at all."""

    def __init__(self) -> None:
        self._depth = 0
        self._enabled = False

    def on_start(self, _: event.Event) -> None:
        """Compilation begins, maybe within another one."""
        if self._depth == 0:
            self._enabled = gc.isenabled()
            gc.disable()
        self._depth += 1

    def on_end(self, _: event.Event) -> None:
        """It ends, with or without a result."""
        self._depth -= 1
        if self._depth == 0 and self._enabled:
            gc.enable()


event.register("numba:compile", _NoGarbage())  # type: ignore[no-untyped-call]
