"""Files of bodies that ranks have written, put together by the numbers of their nodes."""

from xml.etree import ElementTree

import meshio
import numpy as np


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
            size = np.abs(values).max()
            np.testing.assert_allclose(
                found[kind][2][name], one[found[kind][1]], rtol=0, atol=tolerance * size, err_msg=name
            )
