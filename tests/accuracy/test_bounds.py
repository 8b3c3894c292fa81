"""What ends meshes that get finer: the memory that the next one is expected to take."""

import numpy as np
import pytest

import signorini as sg
from signorini.accuracy import bounds
from signorini.accuracy.estimate import Estimate
from signorini.gallery import coarse


def test_memory_grows_with_the_stiffness_where_nothing_is_factorised(monkeypatch):
    """From 1 to 2 GB, and ten times the nodes: 10^1.1 GB more, as a factor in space 10^1.4."""
    monkeypatch.setattr(bounds, "peak_memory", lambda: 1e9)
    asked = bounds.Bounds(sg.Accuracy(0.01, nodes=10**6, memory=1.3e10), 3)
    monkeypatch.setattr(bounds, "peak_memory", lambda: 2e9)
    told = [asked.end(10_000, 100_000, 3, iterated=iterated) for iterated in (True, False)]
    words = "the next mesh has 100000 nodes, with which {} GB of memory are expected, more than 13 GB"
    assert told == [words.format("13.6"), words.format("26.1")]


@pytest.mark.parametrize(("nodes", "total"), [(10**6, 10.0**0.5), (150, 0.9 * 150 / 57)])
def test_meshes_whose_facets_are_halved_afterwards_have_fewer_cells_to_begin_with(nodes, total):
    """Errors fall as nodes grow: to the tenth with ten times as many, on two meshes, or as there is room for."""
    model = coarse.cylinder()
    assert len(model.mesh.points) == 57
    one = np.ones(1)
    found = Estimate(
        pressure=0.0, traction=0.0, energy=0.0, squares=one, weights=one, effect=0.0, pairs=20, output=0.07
    )
    growth = bounds.Bounds(sg.Accuracy(0.01, of="peak pressure", nodes=nodes), 2).growth(found, model, [])
    assert bounds.MORE_NODES[2] * growth.most == pytest.approx(total)
