# SPDX-License-Identifier: BSD-3-Clause
"""Grids that are not compressed are, byte by byte, what meshio writes."""

import meshio
import numpy as np
import pytest

from signorini.output import vtu
from signorini.output.vtu import write_uncompressed


@pytest.mark.parametrize("points", [8, 100_000], ids=["small", "in several parts"])
def test_the_file_is_that_of_meshio(tmp_path, points):
    rng = np.random.default_rng(3)
    cells = [("quad", rng.integers(0, points, (points // 4, 4))), ("triangle6", rng.integers(0, points, (5, 6)))]
    owners, means = ([make(len(block)) for _, block in cells] for make in (np.arange, lambda m: rng.random((m, 6))))
    grid = meshio.Mesh(
        rng.random((points, 3)),
        cells,
        point_data={"u": rng.random((points, 3)), "node": np.arange(points), "odd": rng.random((points, 6))[:, ::2]},
        cell_data={"body": owners, "s": means},
    )
    assert (24 * points > vtu._PART) == (points > 8)
    write_uncompressed(grid, tmp_path / "own.vtu")
    meshio.write(tmp_path / "theirs.vtu", grid, file_format="vtu", compression=None, header_type="UInt64")
    own, theirs = ((tmp_path / name).read_bytes().splitlines() for name in ("own.vtu", "theirs.vtu"))
    assert own == [line for line in theirs if b"created by meshio" not in line]


def test_names_are_escaped(tmp_path):
    grid = meshio.Mesh(np.eye(3), [("triangle", [[0, 1, 2]])], point_data={'"a" < b': np.arange(3.0)})
    write_uncompressed(grid, tmp_path / "own.vtu")
    assert meshio.read(tmp_path / "own.vtu").point_data['"a" < b'].tolist() == [0.0, 1.0, 2.0]
