"""A mesh that ranks keep by rows is the same to whoever asks, and the first one has its boundaries and names alone."""

import json
from types import MappingProxyType

import numpy as np
import pytest

from signorini.arrays import stored
from signorini.distributed import kept_rows, mesh_rows, ranks
from signorini.distributed.kept_rows import RowsKept
from signorini.distributed.mesh_rows import at_hand, let_go
from signorini.distributed.ranks import MUMPS, ON_RANKS, lend
from signorini.fem.space import make_space
from signorini.gallery.cubes import cubes
from signorini.model.mesh import Mesh
from signorini.output.dataclasses_json import digest, to_plain
from tests.distributed.test_on_ranks import on_ranks, with_ranks
from tests.helpers.fake_ranks import RanksInTurn
from tests.helpers.first_rank import FACTORISED, MODELS


@pytest.fixture
def team(monkeypatch):
    found = RanksInTurn(3)
    for module in (kept_rows, mesh_rows, ranks):
        monkeypatch.setattr(module, "several_ranks", lambda: found)
    monkeypatch.setattr(kept_rows, "_WORTH", 1)
    return found


def numbered():
    """Two cubes whose nodes and cells have numbers of their own, backwards."""
    mesh = cubes(4).mesh
    numbers = {"node_numbers": np.arange(250)[::-1] + 5, "cell_numbers": np.arange(128)[::-1] + 9}
    parts = {name: getattr(mesh, name) for name in ("points", "cells", "bodies", "boundaries")}
    return Mesh(**parts, **numbers)


def plain(mesh):
    """What a file would hold of a mesh: the text, and digests of its arrays."""
    return to_plain(mesh, "mesh", lambda path, _, key: f"{path} {key}")


def test_a_mesh_that_is_lent_is_with_the_ranks_and_the_same(team):
    mesh, same = numbered(), numbered()
    space = make_space(mesh)
    let_go(space)
    assert isinstance(stored(mesh, "points"), np.ndarray)  # of a user, who has it as well
    lend(mesh)
    let_go(space)
    here = [stored(mesh, name) for name in ("points", "node_numbers", "cell_numbers")]
    here += [*stored(mesh, "cells").values(), *stored(mesh, "bodies").values(), stored(space.blocks[0], "cells")]
    assert all(isinstance(each, RowsKept) for each in here)
    assert sum(len(own[here[0]._number]) for own in team.kept_by_rank) == 250
    assert plain(mesh) == plain(same)
    assert (mesh.number_of_nodes, mesh.number_of_cells, mesh.dimension) == (250, 128, 3)
    assert isinstance(mesh.cells, MappingProxyType)
    assert repr(mesh) == repr(same)
    nodes = np.array([249, 0, 17, 0])
    np.testing.assert_array_equal(mesh.places_of(nodes), same.points[nodes])
    np.testing.assert_array_equal(space.blocks[0].cells, same.cells["hexahedron"])
    np.testing.assert_array_equal(mesh.extent, same.extent)
    with at_hand(mesh, space.blocks):
        assert all(isinstance(stored(each, "cells"), np.ndarray) for each in space.blocks)
        assert digest(stored(mesh, "points")) == digest(same.points)
    assert stored(mesh, "points") is here[0]
    assert stored(space.blocks[0], "cells") is here[-1]
    for each in tuple(team.away):
        each.come_home()
    team.kept_by_rank.clear()
    assert digest(mesh.points) == digest(same.points)
    np.testing.assert_array_equal(mesh.places_of(nodes), same.points[nodes])


def test_without_ranks_nothing_is_lent():
    mesh = cubes(2).mesh
    lend(mesh)
    let_go(make_space(mesh))
    assert isinstance(stored(mesh, "points"), np.ndarray)


@with_ranks
@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "backend"), [(name, way) for name in MODELS for way in ON_RANKS if way == MUMPS or name not in FACTORISED]
)
def test_the_first_rank_holds_nothing_as_large_as_the_mesh(name, backend):
    """Once it was cut: of mesh, supports, loads, displacements and forces; in no function, up to the files."""
    done = on_ranks(4, "-m", "tests.helpers.first_rank", backend, name)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    steps = 0 if name == "pulled away" else len(MODELS[name]().steps)
    assert len(found) == 3 + steps  # "files of text", "watched" and "end" beside them
    assert not any(found.values()), found
