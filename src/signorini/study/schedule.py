# SPDX-License-Identifier: BSD-3-Clause
"""Which row is solved where and when: rows that share what is prepared go to the same process, as far as that pays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from signorini.study.lanes import Lanes
from signorini.study.parameters import Parameter
from signorini.study.row import StudyRow
from signorini.study.values import Value


class Queue:
    """Rows that are left, in groups that share what is prepared.

    Parameters
    ----------
    rows : number of a row to its values
    parameters : of the study

    Examples
    --------
    >>> nx, mu = Parameter(key="nx", values=(1, 2)), Parameter(key="mu", values=(0.1, 0.2), kind="friction")
    >>> rows = {k: {"nx": 1 + k // 2, "mu": 0.1 + 0.1 * (k % 2)} for k in range(4)}
    >>> queue = Queue(rows, [nx, mu])
    >>> [queue.take(lane)[0] for lane in (0, 1, 0, 1)], len(queue)
    ([0, 2, 1, 3], 0)
    """

    def __init__(self, rows: Mapping[int, Mapping[str, Value]], parameters: Sequence[Parameter]) -> None:
        self._rows = dict(rows)
        self._groups: dict[tuple[Value, ...], list[int]] = {}
        for number, values in rows.items():
            fixed = tuple(values[parameter.key] for parameter in parameters if not parameter.shares)
            self._groups.setdefault(fixed, []).append(number)
        self._at: dict[int, tuple[Value, ...]] = {}

    def __len__(self) -> int:
        """Rows that are left."""
        return sum(len(group) for group in self._groups.values())

    def take(self, lane: int) -> tuple[int, Mapping[str, Value]]:
        """The next row for a lane: of the group that it has prepared, else of the one with the most rows for each."""
        group = self._at.get(lane)
        if group is None or not self._groups[group]:
            group = max(self._groups, key=self._waiting)
            self._at[lane] = group
        number = self._groups[group].pop(0)
        return number, self._rows[number]

    def _waiting(self, group: tuple[Value, ...]) -> float:
        """Rows of a group for each lane that would be at it."""
        return len(self._groups[group]) / (1 + list(self._at.values()).count(group))


def solved_rows(queue: Queue, lanes: Lanes) -> Iterator[tuple[int, StudyRow]]:
    """Rows with their numbers, each as soon as it is solved, until none is left or nobody asks for more.

    Parameters
    ----------
    queue : of rows
    lanes : that solve them
    """
    running = 0
    for lane in range(min(lanes.count, len(queue))):
        lanes.begin(lane, *queue.take(lane))
        running += 1
    while running:
        lane, number, row = lanes.finished()
        yield number, row
        if len(queue):
            lanes.begin(lane, *queue.take(lane))
        else:
            running -= 1
