# SPDX-License-Identifier: BSD-3-Clause
"""Every load and material in other units, of another thickness, seen from elsewhere."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from tests.helpers.changed_models import mapped, rescaled

FAMILIES = ("triangle", "quad", "triangle6", "quad8", "quad9")
PLANE = ("plane strain", "plane stress")
MODULI = {"E1": 12.0, "E2": 1.0, "E3": 0.6, "nu12": 0.4, "nu13": 0.45, "nu23": 0.3, "G12": 0.8}
WOOD = sg.Orthotropic(**MODULI, angle=25.0, density=0.3, expansion1=1e-3, expansion2=4e-3)


def loaded(cells, kind="plane strain", formulation="standard"):
    return sg.Model(
        sg.rectangle(width=2.0, nx=4, ny=2, origin=(1.0, 0.0), cells=cells),
        kind=kind,
        bodies=[sg.Body("block", WOOD, formulation)],
        foundations=[sg.Foundation("left", normal_stiffness=0.5, tangential_stiffness=0.2)],
        supports=[sg.Support("bottom", u=(0.0, 0.0))],
        loads=[
            sg.Load("top", pressure=0.02, name="press"),
            sg.Load("right", traction=(0.01, -0.03), name="pull"),
            sg.Load("block", body_force=(0.0, 0.01), name="bulk"),
            sg.Load("block", gravity=(0.0, -0.1), name="weight"),
            sg.Load("block", centrifugal=0.1, name="spin"),
            sg.Load("block", temperature=3.0, name="heat"),
        ],
    )


def solved(model):
    solution = sg.solve(model)
    assert solution.last.certificate.passed
    return solution.last.displacement, solution.stress("block").stress, solution.last.strain_energy


def in_other_units(model, *, length, modulus):
    """Also what :func:`rescaled` does not know: densities, springs, moduli along axes."""
    material = model.bodies[0].material
    moduli = {key: modulus * getattr(material, key) for key in ("E1", "E2", "E3", "G12")}
    material = replace(material, **moduli, density=modulus / length * material.density)
    springs = [
        replace(f, **{key: modulus / length * getattr(f, key) for key in ("normal_stiffness", "tangential_stiffness")})
        for f in model.foundations
    ]
    bare = replace(model, bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.0))], loads=(), foundations=())
    simple = [load for load in model.loads if load.kind in ("pressure", "traction", "body_force")]
    other = rescaled(replace(bare, loads=simple), length=length, modulus=modulus)
    loads = list(other.loads) + [
        # an acceleration times the density above is a force per volume in the new units; so is omega^2 r
        replace(load, centrifugal=load.centrifugal / np.sqrt(length)) if load.kind == "centrifugal" else load
        for load in model.loads[3:]
    ]
    return replace(other, bodies=[replace(model.bodies[0], material=material)], loads=loads, foundations=springs)


@pytest.mark.parametrize("kind", [*PLANE, "axisymmetric"])
@pytest.mark.parametrize("cells", FAMILIES)
def test_units(cells, kind):
    model = loaded(cells, kind)
    here = solved(model)
    there = solved(in_other_units(model, length=1e3, modulus=1e-4))
    volume = 1e9 if kind == "axisymmetric" else 1e6
    for mine, other, unit in zip(here, there, (1e3, 1e-4, 1e-4 * volume), strict=True):
        np.testing.assert_allclose(np.asarray(other) / unit, mine, atol=1e-9 * np.abs(mine).max())


@pytest.mark.parametrize("kind", PLANE)
def test_thickness(kind):
    model = loaded("quad8", kind)
    here, there = solved(model), solved(replace(model, thickness=7.0))
    for mine, other, factor in zip(here, there, (1.0, 1.0, 7.0), strict=True):
        np.testing.assert_allclose(np.asarray(other) / factor, mine, atol=1e-10 * np.abs(mine).max())


@pytest.mark.parametrize("kind", PLANE)
@pytest.mark.parametrize(
    ("cells", "formulation"), [(cells, "standard") for cells in FAMILIES] + [("quad", "incompatible")]
)
def test_rotation(cells, formulation, kind):
    """Axes of the material, gravity and the centre of rotation turn with the body."""
    model, angle = loaded(cells, kind, formulation), np.radians(33.0)
    Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned = mapped(replace(model, loads=model.loads[:3]), Q, (0.4, -2.0))
    weight, spin, heat = model.loads[3:]
    loads = [
        *turned.loads,
        replace(weight, gravity=tuple(Q @ weight.gravity)),
        replace(spin, centre=(0.4, -2.0)),
        heat,
    ]
    body = replace(model.bodies[0], material=replace(WOOD, angle=WOOD.angle + 33.0))
    (u, stress, energy), (v, other, same) = solved(model), solved(replace(turned, loads=loads, bodies=[body]))
    np.testing.assert_allclose(v, u @ Q.T, atol=1e-9 * np.abs(u).max())
    assert same == pytest.approx(energy, rel=1e-9)

    def tensor(s):
        return np.stack([s[:, [0, 3]], s[:, [3, 1]]], axis=1)

    np.testing.assert_allclose(tensor(other), Q @ tensor(stress) @ Q.T, atol=1e-9 * np.abs(stress).max())
    np.testing.assert_allclose(other[:, 2], stress[:, 2], atol=1e-9 * np.abs(stress).max())
