"""Stresses recovered from patches: exact where they are as smooth as the polynomials, close to the error elsewhere."""

import numpy as np
import pytest

import signorini as sg
from signorini import cores
from signorini.accuracy import recovery
from signorini.accuracy.recovery import StressRecovery
from signorini.fem import kinematics
from signorini.fem.space import make_space
from signorini.fem.stress import DeformedBodies, space_of
from signorini.gallery.cubes import cubes
from signorini.meshing.solid import box

STEEL = sg.Elastic(E=200.0, nu=0.3)
PLANE = {
    (cells, order): lambda cells=cells, order=order: sg.rectangle(width=2.0, nx=4, ny=3, cells=cells, order=order)
    for cells in ("triangle", "quad")
    for order in (1, 2)
}
SOLID = {
    family: lambda family=family: box(x=[0, 1, 2], y=[0, 1, 2], z=[0, 1, 2], cells=family)
    for family in ("hexahedron", "hexahedron27")
}
MESHES = PLANE | SOLID


def found(mesh, displacement, kind=""):
    model = sg.Model(mesh, bodies=[sg.Body(name, STEEL) for name in mesh.bodies], kind=kind)
    space = make_space(model.mesh, kind=model.kind)
    return StressRecovery(space, model).error(DeformedBodies.of(space, model, displacement(mesh.points)))


@pytest.mark.parametrize("name", MESHES, ids=str)
def test_constant_stress_lacks_nothing(name):
    mesh = MESHES[name]()
    slope = np.arange(1.0, 1.0 + mesh.points.shape[1] ** 2).reshape(mesh.points.shape[1], -1)
    error = found(mesh, lambda x: x @ slope)
    assert error.relative < 1e-8  # what keeps patches regular is 1e-12 of their size


@pytest.mark.parametrize("name", [("triangle", 2), ("quad", 2), "hexahedron27"], ids=str)
def test_linear_stress_of_quadratic_cells_lacks_nothing(name):
    mesh = MESHES[name]()
    error = found(mesh, lambda x: np.stack([x[:, 0] * x[:, 1], *(x[:, i] ** 2 for i in range(1, x.shape[1]))], axis=1))
    assert error.relative < 1e-8  # what keeps patches regular is 1e-12 of their size


def test_recovered_stresses_are_those_of_the_corners():
    """Under u = (x y, y^2): sxy = G x, at the corners exactly."""
    mesh = PLANE["triangle", 2]()
    ((nodes, stress),) = found(mesh, lambda x: np.stack([x[:, 0] * x[:, 1], x[:, 1] ** 2], axis=1)).nodal
    assert stress[:, 3] == pytest.approx(200.0 / 2.6 * mesh.points[nodes, 0], abs=1e-6)


@pytest.mark.parametrize(("order", "rate"), [(1, 1.0), (2, 2.0)])
def test_estimates_are_the_errors_of_smooth_fields(order, rate):
    """Of interpolated sines: asymptotically exact, with the rate of the cells."""
    effects, sizes = [], (8, 16)
    for n in sizes:
        mesh = sg.rectangle(nx=n, ny=n, cells="triangle", order=order)
        error = found(mesh, lambda x: np.stack([np.sin(2 * x[:, 0] + x[:, 1]), np.cos(x[:, 0] - 2 * x[:, 1])], axis=1))
        effects.append(error.relative)
    assert np.log2(effects[0] / effects[1]) == pytest.approx(rate, abs=0.15)


def test_bodies_do_not_smooth_each_other():
    """Two of different constant stress, side by side."""
    left = sg.rectangle(nx=2, ny=2)
    mesh = sg.join({"left": left, "right": sg.Mesh(**{**vars(left), "points": left.points + [1.0, 0.0]})})
    share = np.repeat([[1.0], [2.0]], len(left.points), axis=0)
    assert found(mesh, lambda x: share * x).relative < 1e-8


def test_every_number_of_threads_gives_the_same_bits(monkeypatch):
    monkeypatch.setattr(kinematics, "CELLS_AT_ONCE", 16)
    monkeypatch.setattr(recovery, "_SHARED_CORNERS", 0)
    model = cubes(4, 3)
    space = space_of(model)
    deformed = DeformedBodies.of(space, model, np.random.default_rng(4).standard_normal(model.mesh.points.shape))
    found = []
    for number in (1, 2, 3):
        with cores.threads(number):
            error = StressRecovery(space, model).error(deformed)
        found.append([error.squares, error.norm_square, *(values for _, values in error.nodal)])
    for other in found[1:]:
        assert all(np.array_equal(one, two) for one, two in zip(found[0], other, strict=True))
