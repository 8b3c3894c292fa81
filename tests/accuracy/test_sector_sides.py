"""Cyclic sectors on refined meshes: nodes of one side rotate onto those of the other, and sectors do as the whole."""

import numpy as np
import pytest

import signorini as sg
from signorini.accuracy.meshes import Growth, RefinedMeshes
from signorini.gallery.sectors import SECTORS, ring_on_pads
from signorini.meshing.twin_edges import twin_edges


def turned(points, parts):
    angle = 2.0 * np.pi / parts
    return points @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def test_what_is_halved_on_one_side_is_halved_on_the_other():
    """Only cells at one side are asked to be refined, again and again; middles of quadratic edges match, too."""
    model = ring_on_pads(whole=False)
    meshes = RefinedMeshes(model, sg.Accuracy(0.1))
    meshes.first()
    for _ in range(3):
        middle = meshes.simplices.points[meshes.simplices.cells].mean(axis=1)
        angle = np.arctan2(middle[:, 1], middle[:, 0])
        posed = meshes.next(np.exp(-20.0 * angle) * np.linalg.norm(middle, axis=1) ** 8, Growth(least=1.5, most=1.5))
    first, second = (posed.mesh.points[posed.mesh.nodes_of(name)] for name in ("ring.start", "ring.end"))
    assert len(first) == len(second) > 2 * len(model.mesh.nodes_of("ring.start"))
    order, other = (np.argsort(np.linalg.norm(part, axis=1)) for part in (first, second))
    np.testing.assert_allclose(turned(first[order], SECTORS), second[other], atol=1e-12)


@pytest.mark.slow
def test_a_sector_to_an_accuracy_is_the_whole():
    """Energies and forces of the pads, whose edges are sharp, beside those of the ring, asked for more."""
    fine = sg.solve(ring_on_pads(whole=True), accuracy=sg.Accuracy(0.06, of="energy"))
    part = sg.solve(ring_on_pads(whole=False), accuracy=sg.Accuracy(0.06, of="energy"))
    assert part.accuracy.met
    assert len(part.accuracy.levels) > 1
    assert SECTORS * part.last.strain_energy == pytest.approx(fine.last.strain_energy, rel=0.01)
    one, first = part.contact("pad0"), fine.contact("pad0")
    assert np.linalg.norm(one.normal_force) == pytest.approx(np.linalg.norm(first.normal_force), rel=0.01)


def test_corners_that_belong_together_twice():
    """A corner of the axis is on both sides: its edges have their images where the others of a side are."""
    cells = np.array([[0, 1, 2]])
    assert twin_edges(cells, np.array([[0, 0], [1, 2]])).tolist() == [[0, 1, 0, 2], [0, 2, 0, 1]]


def test_sectors_in_space_are_named():
    model = sg.Model(
        sg.box(x=[0.0, 1.0], y=[0.0, 1.0], z=[0.0, 1.0]),
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3))],
        cyclic_symmetries=[sg.CyclicSymmetry("left", "front", sectors=4)],
    )
    with pytest.raises(sg.InputError, match="accuracy: does not know cyclic symmetries in space"):
        sg.solve(model, accuracy=sg.Accuracy(0.1, of="energy"))
