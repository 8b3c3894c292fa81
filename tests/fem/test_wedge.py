# SPDX-License-Identifier: BSD-3-Clause
"""The wedge with 15 nodes: its functions, its faces in keyword decks, files; rotation about any axis in space."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import signorini as sg
from signorini.fem.space import make_space, shape_functions
from signorini.fem.stress import body_stresses
from signorini.fem.wedge import QuadraticWedge
from signorini.meshing.plane import rectangle
from signorini.meshing.read import read_mesh
from signorini.meshing.solid import extruded
from signorini.meshing.write import write_mesh

STEEL = sg.Elastic(E=1000.0, nu=0.3, density=2.0)


def wedges():
    plane = rectangle(width=1.0, height=1.0, nx=2, ny=1, cells="triangle6")
    return extruded(plane, z=[0, 0.5, 1.2], ends=("low", "high"))


def test_functions_hold_all_quadratics_and_have_their_slopes():
    rng = np.random.default_rng(0)
    X, nodes = rng.uniform(0.0, 0.5, (3, 20)), QuadraticWedge.doflocs.T
    values, gradients = shape_functions("wedge15", X)
    at_nodes, _ = shape_functions("wedge15", nodes)
    np.testing.assert_allclose(at_nodes, np.eye(15), atol=1e-15)
    for i in range(3):
        for j in range(3):
            np.testing.assert_allclose(values @ (nodes[i] * nodes[j]), X[i] * X[j], atol=1e-14)
    step = 1e-6
    for i in range(3):
        shift = step * np.eye(3)[:, [i]]
        ahead, behind = (shape_functions("wedge15", X + way * shift)[0] for way in (1.0, -1.0))
        np.testing.assert_allclose(gradients[:, :, i], (ahead - behind) / (2 * step), atol=1e-8)


def test_pressure_on_all_faces_of_an_element_is_hydrostatic(tmp_path: Path) -> None:
    """P1 to P5, each with its six or eight nodes."""
    corners = np.array([[0, 0, 0], [1, 0.1, 0], [0.2, 1, 0.1], [0.1, 0, 1], [1.1, 0.1, 1], [0.3, 1, 1.1]])
    pairs = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
    points = np.vstack([corners, [(corners[a] + corners[b]) / 2 for a, b in pairs]])
    nodes = "".join(f"{i},{x},{y},{z}\n" for i, (x, y, z) in enumerate(points, start=1))
    pressure = "".join(f"1, P{face}, 5.\n" for face in range(1, 6))
    deck = tmp_path / "deck.inp"
    deck.write_text(
        f"*NODE\n{nodes}*ELEMENT, TYPE=C3D15, ELSET=E\n1,1,2,3,4,5,6,7,8,9,10,\n11,12,13,14,15\n"
        "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n"
        f"*BOUNDARY\n1,1,3\n2,2,3\n3,3,3\n*STEP\n*STATIC\n*DLOAD\n{pressure}*END STEP\n"
    )
    model = sg.read(deck)
    step = sg.solve(model).last
    (found,) = body_stresses(make_space(model.mesh), model, step.displacement)
    np.testing.assert_allclose(found.stress, np.tile([-5.0, -5.0, -5.0, 0.0, 0.0, 0.0], (15, 1)), atol=1e-9)
    assert max(abs(force).max() for force in step.reactions.values()) < 1e-10


def test_files_keep_them(tmp_path: Path) -> None:
    mesh = wedges()
    write_mesh(mesh, tmp_path / "mesh.vtu")
    again = read_mesh(tmp_path / "mesh.vtu")
    np.testing.assert_array_equal(again.cells["wedge15"], mesh.cells["wedge15"])
    np.testing.assert_array_equal(again.points, mesh.points)


def test_rotation_about_any_axis_in_space():
    """A force of mass times the square of the velocity times the arm of the middle; turned with everything else."""
    mesh, centre, axis = wedges(), np.array([0.2, -0.3, 0.4]), np.array([1.0, 2.0, -0.5])
    held = [sg.Support("low", u=(0, 0, 0))]
    spun = sg.Load("block", centrifugal=3.0, centre=tuple(centre), axis=tuple(axis))
    model = sg.Model(mesh, bodies=[sg.Body("block", STEEL)], supports=held, loads=[spun])
    step = sg.solve(model).last
    arm = np.array([0.5, 0.5, 0.6]) - centre
    unit = axis / np.linalg.norm(axis)
    np.testing.assert_allclose(step.reactions["low"], -2.0 * 1.2 * 9.0 * (arm - (arm @ unit) * unit), rtol=1e-10)
    turn = Rotation.from_rotvec([0.4, -0.2, 0.9]).as_matrix()
    turned = replace(
        model,
        mesh=replace(mesh, points=mesh.points @ turn.T),
        loads=[replace(spun, centre=tuple(turn @ centre), axis=tuple(turn @ axis))],
    )
    np.testing.assert_allclose(sg.solve(turned).last.displacement, step.displacement @ turn.T, atol=1e-12)
    with pytest.raises(sg.InputError, match="axis: is zero"):
        replace(spun, axis=(0, 0, 0))
