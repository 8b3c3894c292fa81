"""Files of bodies that ranks have written, put together by the numbers of their nodes; and files of text compared."""

import re
from xml.etree import ElementTree

import meshio
import numpy as np

from signorini.model.prints import Prints, Table

_NUMBER = re.compile(r"-?\d\.\d+E[+-]\d\d")
_ENDS = re.compile(r"\n -3\n|\n\n")  # of tables


def all_prints(model, steps):
    """Prints of everything that there is at nodes and in cells, at the end of every step."""
    asked = {
        "nodes": (model.mesh.number_of_nodes, ("U", "RF")),
        "cells": (model.mesh.number_of_cells, ("S", "E")),
        "contacts": (len(model.contacts), ("CDIS", "CSTR")),
    }
    tables = (
        Table(step=k, of=of, place="all", members=np.arange(count)[::-1], quantities=what, totals="yes")
        for k in range(steps)
        for of, (count, what) in asked.items()
        if count
    )
    return Prints(tables=tuple(tables), times=tuple(range(1, steps + 1)))


def differing(one, other):
    """Tables in which two files of text differ by more than a digit and rounding of their largest number."""
    tables = [_ENDS.split(file.read_text()) for file in (one, other)]
    assert len(tables[0]) == len(tables[1]) > 2
    return [a.splitlines()[:4] for a, b in zip(*tables, strict=True) if a != b and not _alike(a, b)]


def _alike(*tables):
    """Whether two tables are the same but for rounding."""
    (one, others), texts = (_NUMBER.findall(table) for table in tables), [_NUMBER.sub("#", table) for table in tables]
    if texts[0].replace(" ", "") != texts[1].replace(" ", ""):  # of which the sign of a number takes one
        return False
    a, b = np.array(one, float), np.array(others, float)
    digit = 10.0 ** -len(one[0].partition(".")[2].partition("E")[0])
    return np.allclose(a, b, rtol=1.01 * digit, atol=1e-12 * np.abs(a).max())


def sources(index):
    """Files that an index lists."""
    return [index.parent / piece.get("Source") for piece in ElementTree.parse(index).iter("Piece")]


def by_place(grids):
    """Rows of points, sorted by body and number of their node, and those numbers; the same of cells of each type."""
    points, keys, cells = [], [], {}
    for grid in grids:
        node = grid.point_data["node"]
        data = {**grid.point_data, "points": grid.points}
        body = np.full(len(node), -1)
        for k, block in enumerate(grid.cells):
            rows = {name: np.asarray(values[k]) for name, values in grid.cell_data.items()}
            body[block.data] = rows["body"][:, None]
            cells.setdefault(block.type, []).append((node[block.data], rows))
        points.append(data)
        keys.append(np.stack([body, node], axis=1))
    found = {"points": _sorted(keys, points)}
    return found | {kind: _sorted(*zip(*parts, strict=True)) for kind, parts in cells.items()}


def _sorted(keys, parts):
    keys, order = np.unique(np.concatenate(keys), axis=0, return_inverse=True)
    order = order.ravel()
    assert all(part.keys() == parts[0].keys() for part in parts)
    rows = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    return keys, order, rows


def assert_whole(index, file, tolerance=1e-12):
    """Files of ranks are together the one that a process wrote, up to a part of the largest value of each array."""
    found, expected = by_place([meshio.read(part) for part in sources(index)]), by_place([meshio.read(file)])
    assert found.keys() == expected.keys()
    for kind, (keys, order, rows) in expected.items():
        np.testing.assert_array_equal(found[kind][0], keys)
        assert found[kind][2].keys() == rows.keys()
        assert kind == "points" or len(found[kind][1]) == len(order)  # a cell is in one file
        for name, values in rows.items():
            one = np.empty_like(values)
            one[order] = values
            size = np.abs(values[np.isfinite(values)]).max(initial=0.0)  # of fatigue much is not asked for
            np.testing.assert_allclose(
                found[kind][2][name], one[found[kind][1]], rtol=0, atol=tolerance * size, err_msg=name
            )
