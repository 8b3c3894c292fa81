# SPDX-License-Identifier: BSD-3-Clause
"""Numbers by name, found when they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any


class ByName(Mapping[str, Any]):
    """Numbers by name, each found when it is asked for.

    Parameters
    ----------
    names : what there is
    find : the number of a name
    """

    def __init__(self, names: Sequence[str], find: Callable[[str], Any]) -> None:
        self._names, self._find = list(names), find
        self._found: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._found:
            self._found[name] = self._find(name)
        return self._found[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return repr(dict(self))
