# SPDX-License-Identifier: BSD-3-Clause
"""Materials: an orthotropic one with isotropic constants, turned ones, and what has no energy."""

import numpy as np
import pytest

import signorini as sg
from signorini.engine.solve import solve
from signorini.fem.elasticity import elasticity, isotropic
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses

KINDS = ("plane strain", "plane stress", "axisymmetric")
WOOD = {"E1": 12.0, "E2": 1.0, "E3": 0.6, "nu12": 0.4, "nu13": 0.45, "nu23": 0.3, "G12": 0.8}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("angle", [0.0, 37.0, -120.0])
def test_isotropic_constants_in_any_direction(kind, angle):
    shear = 2.0 / (2 * 1.3)
    same = sg.Orthotropic(E1=2.0, E2=2.0, E3=2.0, nu12=0.3, nu13=0.3, nu23=0.3, G12=shear, angle=angle)
    plain = sg.Elastic(E=2.0, nu=0.3)
    np.testing.assert_allclose(elasticity(same, kind), elasticity(plain, kind), atol=1e-14)
    assert same.bulk_modulus == pytest.approx(plain.bulk_modulus)
    np.testing.assert_allclose(isotropic(0.4, 0.7)[3:, 3:], 0.7 * np.eye(3))


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0])
@pytest.mark.parametrize("cells", ["quad", "triangle6"])
def test_tension_across_the_grain(angle, cells):
    """``1/E_x = c^4/E1 + (1/G - 2 nu/E1) s^2 c^2 + s^4/E2`` (Lekhnitskii), and the shear that comes with it."""
    model = sg.Model(
        sg.rectangle(width=2.0, nx=4, ny=2, cells=cells),
        kind="plane stress",
        bodies=[sg.Body("block", sg.Orthotropic(**WOOD, angle=angle))],
        supports=[sg.Support((0.0, 0.0), u=(0, 0)), sg.Support((2.0, 0.0), u=(None, 0))],
        loads=[sg.Load("left", traction=(-0.5, 0)), sg.Load("right", traction=(0.5, 0))],
    )
    u = solve(model).last.displacement
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    E1, E2, nu, G = (WOOD[key] for key in ("E1", "E2", "nu12", "G12"))
    strain = 0.5 * (c**4 / E1 + (1 / G - 2 * nu / E1) * s**2 * c**2 + s**4 / E2)
    # with the base held level all of the shear strain leans the sides
    shear = 0.5 * 2 * c * s * (c**2 / E1 * (1 + nu) - s**2 * (1 / E2 + nu / E1) - (c**2 - s**2) / (2 * G))
    x, y = model.mesh.points.T
    np.testing.assert_allclose(u[:, 0], strain * x + shear * y, atol=1e-12)
    (found,) = body_stresses(make_space(model.mesh), model, u)
    np.testing.assert_allclose(found.stress, np.tile([0.5, 0, 0, 0, 0, 0], (len(u), 1)), atol=1e-12)


def test_a_hoop_wound_tube():
    """Thin: ``u_r = p r^2 / (E_hoop t)`` up to the thickness over the radius."""
    wound = sg.Orthotropic(E1=1.0, E2=1.0, E3=50.0, nu12=0.0, nu13=0.0, nu23=0.0, G12=0.5)
    model = sg.Model(
        sg.rectangle(width=0.01, height=0.02, nx=2, ny=1, origin=(1.0, 0.0), cells="quad8"),
        kind="axisymmetric",
        bodies=[sg.Body("block", wound)],
        supports=[sg.Support("bottom", u=(None, 0))],
        loads=[sg.Load("left", pressure=0.01)],
    )
    u = solve(model).last.displacement
    np.testing.assert_allclose(u[:, 0], 0.01 / (50.0 * 0.01), rtol=0.02)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"nu12": 3.5}, r"nu12: is 3.5; expected a size below sqrt\(E1 / E2\) = 3.4641"),
        ({"nu23": -1.3}, r"nu23: is -1.3; expected a size below"),
        ({"nu12": 2.0, "nu13": 2.0, "nu23": 0.9}, "together leave a stress without positive energy"),
        ({"G12": 0.0}, "G12: is 0.0; expected a number > 0"),
        ({"density": -1.0}, "density: is -1.0; expected a number >= 0"),
    ],
)
def test_no_energy(change, message):
    with pytest.raises(sg.InputError, match=message):
        sg.Orthotropic(**(WOOD | change))
