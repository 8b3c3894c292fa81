# SPDX-License-Identifier: BSD-3-Clause
"""How loops are compiled: what Python calls, what only compiled loops call; once, and without searches for garbage."""

from __future__ import annotations

import gc
import pickle
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numba import njit
from numba.core import event
from numba.core.caching import IndexDataCacheFile
from numba.core.registry import CPUDispatcher

from signorini.turn import Turn

UNREADABLE = (AttributeError, ImportError, EOFError, pickle.UnpicklingError)
"""What reading an index of compiled loops ends in, where it is of a version of the package whose classes are gone."""

PATIENCE = 1.0
"""Seconds of a process for which Python interprets a loop that most call a few times: to compile one takes 1 to 2."""
LITTLE_DATA = 50_000
"""Entries of the largest array over which it does: a loop over all of them takes some hundredths of a second."""

_Loop = TypeVar("_Loop", bound=Callable[..., Any])


def kernel(*, brief: bool = False, **options: Any) -> Callable[[_Loop], _Loop]:
    """Compile what Python calls; the first run leaves it on disk. A wrapper for callers in C would be for nobody.

    Divided by zero numbers become inf and nan, as NumPy's do: branches to an exception take a sixth longer to compile.

    Parameters
    ----------
    brief : most processes call it a few times, on little data: Python interprets it first
    options : further ones of Numba's
    """
    made = njit(cache=True, no_cfunc_wrapper=True, error_model="numpy", **options)  # type: ignore[call-overload]
    decorate: Callable[[_Loop], _Loop] = made

    def kept(loop: _Loop) -> _Loop:
        compiled = decorate(loop)
        index = getattr(getattr(compiled, "_cache", None), "_cache_file", None)
        if type(index) is IndexDataCacheFile:
            index.__class__ = _Index
            if brief:
                compiled.__class__ = _Brief  # type: ignore[assignment]
        return compiled

    return kept


class _Index(IndexDataCacheFile):
    """What of a loop is on disk: nothing, where it is of a version of the package whose classes are gone.

    Numba reads the index before it asks whether it is of this file, and an update of the package leaves it there. Of
    processes that need a loop at once one compiles it, and the others wait for what it leaves.
    """

    def _load_index(self) -> dict[Any, str]:
        try:
            found: dict[Any, str] = super()._load_index()  # type: ignore[no-untyped-call]
        except UNREADABLE:
            return {}
        return found

    def load(self, key: Any) -> Any:
        """What is on disk; None: it is this process's turn to compile.

        Parameters
        ----------
        key : Numba's, of the types and the machine
        """
        found = super().load(key)  # type: ignore[no-untyped-call]
        if found is None and self.turn.waited():
            found = super().load(key)  # type: ignore[no-untyped-call]
            if found is not None:
                self.turn.end()
        return found

    def has(self, key: Any) -> bool:
        """Whether a compiled loop is on disk.

        Parameters
        ----------
        key : Numba's
        """
        return super().load(key) is not None  # type: ignore[no-untyped-call]

    def save(self, key: Any, data: Any) -> None:
        """Leave a compiled loop on disk, for those that wait for it too.

        Parameters
        ----------
        key, data : Numba's
        """
        super().save(key, data)  # type: ignore[no-untyped-call]
        self.turn.end()

    @cached_property
    def turn(self) -> Turn:
        """Of processes that compile the loop."""
        return Turn(f"{self._index_path}.turn")


def compile_aside(loop: Any, types: tuple[Any, ...]) -> None:
    """Compile a loop for somebody else, unless another process is at it.

    Parameters
    ----------
    loop : a kernel
    types : of its arguments, Numba's
    """
    index = getattr(getattr(loop, "_cache", None), "_cache_file", None)
    if not isinstance(index, _Index) or index.turn.free():
        loop.compile(types)


def part(**options: Any) -> Callable[[_Loop], _Loop]:
    """Compile what kernels alone call, which hold a copy of it on disk: without any wrapper, otherwise as they are.

    Where Python calls it, it interprets it.

    Parameters
    ----------
    options : further ones of Numba's
    """
    wrappers = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    decorate: Callable[[_Loop], _Loop] = njit(error_model="numpy", **wrappers, **options)  # type: ignore[call-overload]

    def interpreted_by_python(loop: _Loop) -> _Loop:
        made: Any = decorate(loop)
        if type(made) is CPUDispatcher:  # and not the loop itself, where Numba is switched off
            made.__class__ = _Part
        part: _Loop = made
        return part

    return interpreted_by_python


class _Part(CPUDispatcher):
    """What kernels alone call; Python, which has no way into the compiled one, interprets it."""

    def __call__(self, *arguments: Any) -> Any:
        return self.py_func(*arguments)


class _Patient(CPUDispatcher):
    """A kernel that Python interprets as long as it is not compiled, with the same numbers to the last bit."""

    def __call__(self, *arguments: Any) -> Any:
        types = tuple(self.typeof_pyval(argument) for argument in arguments)
        if types in self.overloads or _on_disk(self, types):
            return super().__call__(*arguments)
        return self.interpret(arguments)

    def interpret(self, arguments: tuple[Any, ...]) -> Any:
        """What the loop returns, or leaves in its arguments, by Python."""
        with np.errstate(all="ignore"):  # as compiled loops do
            return self.py_func(*arguments)


class _Brief(_Patient):
    """One that Python interprets on little data, until that has taken about as long as to compile it."""

    spent = 0.0
    """Seconds so far."""

    def interpret(self, arguments: tuple[Any, ...]) -> Any:
        """By Python where that is quick, compiled from now on where it is not."""
        if self.spent > PATIENCE or any(_entries(argument) > LITTLE_DATA for argument in arguments):
            return CPUDispatcher.__call__(self, *arguments)
        begin = time.perf_counter()
        try:
            return super().interpret(arguments)
        finally:
            self.spent += time.perf_counter() - begin


def _entries(argument: Any) -> int:
    """How many entries the largest array of an argument has, a named tuple of arrays too."""
    if isinstance(argument, tuple):
        return max((_entries(part) for part in argument), default=0)
    return int(np.size(argument))


def _on_disk(loop: Any, types: tuple[Any, ...]) -> bool:
    """Whether a kernel for arguments of some types can be had without compiling it."""
    index = getattr(loop._cache, "_cache_file", None)
    return isinstance(index, _Index) and index.has(loop._cache._index_key(types, loop.targetctx.codegen()))


@contextmanager
def interpreted(loops: Sequence[Any]) -> Iterator[None]:
    """Have loops interpreted while the block runs and as long as nobody has compiled them.

    Parameters
    ----------
    loops : kernels
    """
    waiting = [(loop, type(loop)) for loop in loops if type(loop) in (CPUDispatcher, _Brief)]
    for loop, _ in waiting:
        loop.__class__ = _Patient
    try:
        yield
    finally:
        for loop, before in waiting:
            loop.__class__ = before


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
