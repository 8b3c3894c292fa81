# SPDX-License-Identifier: BSD-3-Clause
"""How loops are compiled: what Python calls, what only compiled loops call, and without searches for garbage."""

from __future__ import annotations

import gc
from collections.abc import Callable
from typing import Any, TypeVar

from numba import njit
from numba.core import event

_Loop = TypeVar("_Loop", bound=Callable[..., Any])


def kernel(**options: Any) -> Callable[[_Loop], _Loop]:
    """Compile what Python calls; the first run leaves it on disk. A wrapper for callers in C would be for nobody.

    Parameters
    ----------
    options : further ones of Numba's
    """
    decorate: Callable[[_Loop], _Loop] = njit(cache=True, no_cfunc_wrapper=True, **options)  # type: ignore[call-overload]
    return decorate


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
