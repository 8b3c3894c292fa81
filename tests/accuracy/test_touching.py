"""Facets that touch, halved."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.accuracy.meshes import Growth, RefinedMeshes, halved
from signorini.accuracy.touching import touching_cells
from signorini.gallery import coarse
from signorini.meshing.simplices import Simplices
from signorini.model.varying import NodeValues

ASKED = sg.Accuracy(0.01)


def lengths(simplices):
    """Of the edges of all simplices, (m, k)."""
    corners = simplices.points[simplices.cells]
    first, second = np.triu_indices(simplices.cells.shape[1], 1)
    return np.linalg.norm(corners[:, first] - corners[:, second], axis=2)


@pytest.mark.parametrize("model", [coarse.hertz_line(), coarse.ball()], ids=["plane", "space"])
def test_all_edges_of_cells_are_halved(model):
    """And origins are cells of the simplices to begin with: volumes add up."""
    simplices = Simplices.of(model.mesh)
    cells = np.arange(len(simplices.cells)) % 7 == 0
    finer = halved(simplices, cells, {})
    own = cells[finer.origin]
    # of a tetrahedron bisected three times one edge may stay, beside others that are longer
    assert (lengths(finer)[own].max(axis=1) <= 0.87 * lengths(simplices)[finer.origin[own]].max(axis=1)).all()
    assert (np.bincount(finer.origin, minlength=len(cells))[cells] >= 2**model.dimension).all()
    assert len(finer.parents) == len(finer.points)


def test_what_is_halved_is_refined_on_from_there():
    """Values go with it node by node, and what the mesh before had is carried over both at once."""
    model = coarse.hertz_line()
    x = model.mesh.points[:, 0]
    model = replace(model, loads=[replace(model.loads[0], force=None, pressure=NodeValues(1.0 + x))])
    meshes = RefinedMeshes(model, ASKED)
    first = meshes.simplices
    grown = meshes.next(np.ones(len(first.cells)), Growth(least=2.0, most=2.0))
    finer = meshes.halved(np.arange(len(meshes.simplices.cells)) < 5)
    assert len(finer.mesh.points) > len(grown.mesh.points)
    assert finer.loads[0].pressure.values == pytest.approx(1.0 + finer.mesh.points[:, 0])
    assert meshes.simplices.carried(first.points) == pytest.approx(meshes.simplices.points)
    middles = meshes.simplices.points[meshes.simplices.cells].mean(axis=1)
    corners = first.points[first.cells[meshes.simplices.origin]]
    assert ((middles >= corners.min(axis=1)) & (middles <= corners.max(axis=1))).all()


def test_cells_of_both_sides_that_touch_at_the_end_of_some_step():
    """A cylinder that is pressed and lifted has touched; of another the cells around the nodes that touch."""
    model = coarse.two_cylinders()
    pressed = sg.solve(RefinedMeshes(model, ASKED).first())
    simplices = Simplices.of(pressed.model.mesh)
    found = touching_cells(pressed, simplices.cells)
    middles = simplices.points[simplices.cells].mean(axis=1)
    assert {"upper", "lower"} == {name for name, own in simplices.bodies.items() if found[own].any()}
    assert np.abs(middles[found, 1]).max() < 3.0
    up = replace(model.supports[1], u=(0.0, 1.0))
    assert up.on == model.supports[1].on
    steps = [sg.Step(name="down"), sg.Step(name="up", scale={up.label: -1.0})]
    lifted = sg.solve(replace(pressed.model, steps=steps))
    assert not lifted.contact("seat").closed.any()
    assert (touching_cells(lifted, simplices.cells) == found).all()
