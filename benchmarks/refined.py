# SPDX-License-Identifier: BSD-3-Clause
"""CalculiX decks with every element cut into smaller ones, and with smaller loads: does what both differ by vanish?

    python -m benchmarks.refined FOLDER [--write docs/inp.md]

FOLDER holds the decks, such as the folder ``test`` of the CalculiX repository; nothing is fetched. Needs ``ccx``. Each
hexahedron is cut into n x n x n, whose nodes lie where its shape functions put them, so that the bodies stay what they
are; sets, surfaces and pressures go with them. Both programs solve the same texts, without large displacements and with
full integration, and also with a hundredth of the load: what goes with it does so because CalculiX's contact follows
the displaced sides even without ``NLGEOM``.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterable, Iterator
from itertools import product
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

import signorini as sg
from benchmarks import command, page
from benchmarks.deck_text import data_lines, keyword_line, scaled_lines
from benchmarks.decks import by_calculix, plain
from signorini.deck.inp.card import Card
from signorini.deck.inp.syntax import read_cards

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
_CASES = (
    *(("friction1", n, share) for n in (1, 2) for share in (1.0, 0.01)),
    *(("cubespring", n, share) for n in (1, 2) for share in (1.0, 0.01)),
    *(("beamcontact", n, 1.0) for n in (1, 2, 3)),
)
_CORNERS = np.array(
    [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
)
_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
_PLACES = np.vstack([_CORNERS, [(_CORNERS[i] + _CORNERS[j]) / 2 for i, j in _EDGES]])
_FACES = {"1": (2, -1), "2": (2, 1), "3": (1, -1), "4": (0, 1), "5": (1, 1), "6": (0, -1)}  # axis and end
_SAME = 1e-7  # of the size of the mesh: nodes that are nearer are one


def shapes(at: Floats, count: int) -> Floats:
    """Shape functions of the hexahedron of 8 or 20 nodes at points (..., 3): (..., count)."""
    along = 1.0 + at[..., None, :] * _PLACES[:count]
    corner = along[..., :8, :].prod(axis=-1) / 8.0
    if count == 8:
        return corner
    corner *= along[..., :8, :].sum(axis=-1) - 5.0
    bubble = np.where(_PLACES[8:] == 0.0, 1.0 - at[..., None, :] ** 2, along[..., 8:, :])
    return np.concatenate([corner, bubble.prod(axis=-1) / 4.0], axis=-1)


class Cut:
    """A deck of hexahedra cut into n x n x n each."""

    def __init__(self, deck: Path, n: int) -> None:
        self.cards, self.n = read_cards(deck), n
        nodes = [row for card in self.cards if card.keyword == "NODE" for row in card.rows()]
        self.numbers = np.array([row.whole(0, "a number") for row in nodes])
        self.points = np.array([[row.number(i, "a coordinate") for i in (1, 2, 3)] for row in nodes])
        self.elements = {card: list(_records(card)) for card in self.cards if card.keyword == "ELEMENT"}
        self.first = {}
        for record in (record for records in self.elements.values() for record in records):
            self.first[record[0]] = 1 + n**3 * len(self.first)  # the number of its first piece
        self.pieces = list(product(range(n), repeat=3))
        self._cut()

    def _cut(self) -> None:
        """Nodes of all pieces: those of one body that lie at one place are one; old ones keep their numbers."""
        row_of = {number: i for i, number in enumerate(self.numbers.tolist())}
        wholes = [[row_of[i] for i in record[1:]] for records in self.elements.values() for record in records]
        body = self._bodies(wholes)
        used = np.unique(np.concatenate(wholes))
        at, parts, self.weights = [self.points[used]], [body[used]], []
        for whole in wholes:
            count = len(whole)
            places = -1.0 + (2.0 * np.array(self.pieces)[:, None] + 1.0 + _PLACES[:count]) / self.n
            weights = shapes(places, count)
            self.weights.append((np.array(whole), weights))
            at.append((weights @ self.points[whole]).reshape(-1, 3))
            parts.append(np.full(len(at[-1]), body[whole[0]]))
        size = _SAME * np.ptp(self.points, axis=0).max()
        keys = np.column_stack([np.concatenate(parts), np.rint(np.vstack(at) / size)]).astype(np.int64)
        _, first, which = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        new = first >= len(used)
        self.number_of = np.empty(len(first), np.int64)
        self.number_of[~new] = self.numbers[used[first[~new]]]
        self.number_of[new] = self.numbers.max() + 1 + np.arange(new.sum())
        self.places = np.vstack(at)[first]
        self.which = np.split(which.ravel()[len(used) :], np.cumsum([len(more) for more in at[1:-1]]))

    def _bodies(self, wholes: list[list[int]]) -> Ints:
        pairs = np.vstack([[(whole[0], i) for i in whole] for whole in wholes])
        graph = sp.coo_array((np.ones(len(pairs)), pairs.T), shape=(len(self.points),) * 2)
        return np.asarray(connected_components(graph, directed=False)[1], np.int64)

    def text(self, share: float) -> str:
        """The deck with a share of its loads."""
        lines: list[str] = []
        for card in self.cards:
            lines.append(keyword_line(card))
            match card.keyword:
                case "NODE":
                    lines += self._nodes()
                case "ELEMENT":
                    lines += self._elements(card)
                case "NSET":
                    lines += self._set(card)
                case "SURFACE":
                    lines += self._faces(data_lines(card))
                case "DLOAD":
                    lines += self._faces(scaled_lines(card, share))
                case _:
                    lines += scaled_lines(card, share)
        return "\n".join([*lines, ""])

    def _nodes(self) -> Iterator[str]:
        for number, point in zip(self.number_of.tolist(), self.places.tolist(), strict=True):
            yield f"{number}, {', '.join(f'{x:.15g}' for x in point)}"

    def _elements(self, card: Card) -> Iterator[str]:
        skipped = 0
        for other, records in self.elements.items():
            if other is card:
                break
            skipped += len(records)
        for record, which in zip(self.elements[card], self.which[skipped:], strict=False):
            for piece, nodes in enumerate(self.number_of[which].reshape(len(self.pieces), -1).tolist()):
                words = [str(word) for word in (self.first[record[0]] + piece, *nodes)]
                yield from (
                    ", ".join(words[i : i + 11]) + ("," if i + 11 < len(words) else "") for i in (0, 11) if words[i:]
                )

    def _set(self, card: Card) -> Iterator[str]:
        """A new node belongs to it if all old nodes do on which its place depends."""
        members = np.isin(self.numbers, [int(word) for row in card.rows() for word in row.fields])
        inside = np.zeros(len(self.number_of), bool)
        for (whole, weights), which in zip(self.weights, self.which, strict=True):
            away = (abs(weights) > 1e-9) @ ~members[whole]
            inside[which] |= ~away.ravel()
        return map(str, self.number_of[inside].tolist())

    def _faces(self, lines: Iterable[str]) -> Iterator[str]:
        """Element and face, and what else stands behind them, for every piece that has a part of the face."""
        for line in lines:
            element, face, *rest = (word.strip() for word in line.split(","))
            axis, end = _FACES[face[1:]]
            for piece, place in enumerate(self.pieces):
                if place[axis] == (0 if end < 0 else self.n - 1):
                    yield ", ".join([str(self.first[int(element)] + piece), face, *rest])


def _records(card: Card) -> Iterator[list[int]]:
    """Number and nodes of every element, which may go on in the next line."""
    size, found = 1 + int(card.value("TYPE")[3:].rstrip("R")), []
    for row in card.rows():
        found += [int(word) for word in row.fields]
        if len(found) >= size:
            yield found
            found = []


def compared(deck: Path, n: int, share: float, folder: Path) -> str:
    """A row of the table."""
    own = folder / deck.name
    own.write_text(plain(deck.read_text(errors="replace")))
    text = Cut(own, n).text(share)
    own.write_text(text)
    theirs = by_calculix(text, folder)
    model = sg.read(own)
    step = sg.solve(model).last
    printed = np.array([theirs[number] for number in model.mesh.labels.tolist()])
    sizes = [float(np.abs(values).max()) for values in (step.displacement, printed)]
    apart = float(np.abs(step.displacement - printed).max()) / sizes[1]
    return f"| {deck.stem} | {n} | {len(printed)} | {share:g} | {apart:.1e} | {sizes[0]:.5e} | {sizes[1]:.5e} |"


def main() -> None:
    parser = command.parser(__doc__, write=True)
    parser.add_argument("folder", type=Path)
    options = parser.parse_args()
    if not shutil.which("ccx"):
        parser.error("there is no ccx; expected CalculiX on the path")
    rows = ["| deck | cut into | nodes | load | difference | signorini | CalculiX |", "|---|---|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        for name, n, share in _CASES:
            rows.append(compared(options.folder / f"{name}.inp", n, share, Path(folder)))
            print(rows[-1], flush=True)
    if options.write:
        page.write("refined decks", "\n".join(rows), options.write)


if __name__ == "__main__":
    main()
