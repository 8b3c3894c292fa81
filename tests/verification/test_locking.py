# SPDX-License-Identifier: BSD-3-Clause
"""Where standard cells are too stiff: bending of a cantilever, nearly incompressible vessels; and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.engine.examine import examine
from signorini.engine.solve import solve
from signorini.fem.locking import stiffened_bodies, thin_bodies
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.gallery.hertz import LINE_FORCE, RADIUS, hertz_contact
from signorini.reference.hertz import HertzLine, contact_modulus
from signorini.reference.lame import hollow_sphere, thick_cylinder
from tests.helpers.walls import WALL, sphere, tube


def cantilever(cells, *, formulation="standard", kind="plane stress", nu=0.3, nx=8, ny=1):
    """Tip deflection over that of Timoshenko's beam, and the largest error of the bending stress on top."""
    L, E = 8.0, 1000.0
    model = sg.Model(
        sg.rectangle(width=L, nx=nx, ny=ny, origin=(0.0, -0.5), cells=cells),
        kind=kind,
        bodies=[sg.Body("block", sg.Elastic(E=E, nu=nu), formulation)],
        supports=[sg.Support("left", u=(0, None)), sg.Support((0.0, -0.5), u=(None, 0))],
        loads=[sg.Load("right", traction=(0, 1.0))],
    )
    u = solve(model).last.displacement
    if kind == "plane strain":
        E, nu = E / (1 - nu**2), nu / (1 - nu)
    exact = 4 * L**3 / E + 1.2 * L * 2 * (1 + nu) / E
    (stress,) = body_stresses(make_space(model.mesh), model, u)
    x, y = model.mesh.points.T
    top = (y == y.max()) & (x > 1.0) & (x < 7.0)
    return u[np.argmax(x - y), 1] / exact, np.abs(stress.stress[top, 0] + 6 * (L - x[top])).max() / (6 * L)


def test_bending():
    assert cantilever("quad")[0] < 0.7
    for kind, nu in (("plane stress", 0.3), ("plane strain", 0.3), ("plane strain", 0.4999)):
        deflection, stress = cantilever("quad", formulation="incompatible", kind=kind, nu=nu)
        assert deflection == pytest.approx(1.0, abs=0.01)
        assert stress < 0.01
    for cells in ("quad8", "quad9", "triangle6"):
        deflection, stress = cantilever(cells)
        assert deflection == pytest.approx(1.0, abs=0.01)


def bent(mesh, by=0.4):
    """Nodes inside a wall from 1 to 2 moved along the radius, so that no cell is a sector any more."""
    x, y = mesh.points.T
    r, angle = np.hypot(x, y), np.arctan2(y, x)
    return replace(
        mesh, points=mesh.points * (1 + by / 8 * np.sin(np.pi * (r - 1)) * np.sin(5 * r + 6 * angle) / r)[:, None]
    )


@pytest.mark.parametrize("cells", ["quad", "triangle6", "quad8", "quad9"])
@pytest.mark.parametrize("nu", [0.3, 0.49999])
@pytest.mark.parametrize(("make", "reference"), [(tube, thick_cylinder), (sphere, hollow_sphere)])
def test_a_mean_dilatation_is_as_good_for_rubber_as_for_steel(make, reference, nu, cells):
    model = make(16 if cells == "quad" else 8, cells)
    mesh = bent(model.mesh) if make is sphere else model.mesh
    rubber = sg.Body(model.bodies[0].name, sg.Elastic(E=200.0, nu=nu), "mean dilatation")
    model = replace(model, mesh=mesh, bodies=[rubber])
    u, points = solve(model).last.displacement, model.mesh.points
    r = points[:, 0] if make is tube else np.linalg.norm(points, axis=1)
    moved = u[:, 0] if make is tube else np.sum(u * points, axis=1) / r
    exact, _, hoop = reference(r, **(WALL | {"nu": nu}))
    (found,) = body_stresses(make_space(model.mesh, kind="axisymmetric"), model, u)
    inside = (r > 1.2) & (r < 1.8)
    np.testing.assert_allclose(moved, exact, rtol=0.004)
    np.testing.assert_allclose(found.stress[inside, 2], hoop[inside], atol=0.02 * WALL["pressure"])


@pytest.mark.parametrize("cells", ["quad", "triangle", "quad8", "triangle6"])
def test_a_locked_answer_is_refused(cells):
    block = {"supports": [sg.Support("bottom", u=(0, 0))], "loads": [sg.Load("top", pressure=1.0)]}
    rubber = sg.Body("block", sg.Elastic(E=1.0, nu=0.4999))
    mesh = sg.rectangle(nx=2, ny=2, cells=cells)
    with pytest.raises(sg.InputError, match=r"body\[0\].formulation: 'block' is nearly incompressible .* would lock"):
        solve(sg.Model(mesh, bodies=[rubber], **block))
    solve(sg.Model(mesh, kind="plane stress", bodies=[rubber], **block))
    other = {"incompatible": cells == "quad", "mean dilatation": cells != "triangle"}
    for formulation, allowed in other.items():
        model = sg.Model(mesh, bodies=[replace(rubber, formulation=formulation)], **block)
        if allowed:
            assert solve(model).solved
        else:
            with pytest.raises(sg.InputError, match=r"has no 'quad' or 'hex|triangle cells, which lock all the same"):
                solve(model)


def test_formulations_that_do_not_fit_are_refused():
    """Internal modes with a hoop strain, and a mean dilatation of wood, help nothing."""
    parts = {"supports": [sg.Support("bottom", u=(0, 0))], "loads": [sg.Load("top", pressure=1.0)]}
    rubber = sg.Body("block", sg.Elastic(E=1.0, nu=0.4999), "incompatible")
    with pytest.raises(sg.InputError, match=r"Expected .* with formulation = 'mean dilatation'"):
        solve(sg.Model(sg.rectangle(nx=2, ny=2), kind="axisymmetric", bodies=[rubber], **parts))
    wood = sg.Orthotropic(E1=10.0, E2=1.0, E3=1.0, nu12=0.3, nu13=0.3, nu23=0.3, G12=1.0)
    with pytest.raises(sg.InputError, match="the material of 'block' is not isotropic"):
        solve(sg.Model(sg.rectangle(), bodies=[sg.Body("block", wood, "mean dilatation")], **parts))


def test_bodies_that_begin_to_lock_are_named():
    def names(nu, cells="quad", formulation="standard", kind="plane strain"):
        bodies = [sg.Body("block", sg.Elastic(E=1.0, nu=nu), formulation)]
        return stiffened_bodies(sg.Model(sg.rectangle(cells=cells), kind=kind, bodies=bodies))

    assert names(0.47) == names(0.47, "triangle6") == ("block",)
    assert names(0.4) == names(0.47, "quad8") == names(0.47, formulation="mean dilatation") == ()
    assert names(0.47, kind="plane stress") == ()


@pytest.mark.parametrize("cells", ["quad", "triangle6", "quad8"])
def test_rubber_in_hertz_contact_has_a_smooth_pressure(cells):
    """Between two rubbers of one kind: no shear on the interface, and no zigzag in the pressure."""
    rubber = sg.Elastic(E=100.0, nu=0.499)
    across = 26 if cells == "quad" else 13
    model = hertz_contact(across=(across, across), cells=cells)
    model = replace(model, bodies=[sg.Body(body.name, rubber, "mean dilatation") for body in model.bodies])
    hertz = HertzLine(force=LINE_FORCE, radius=RADIUS, modulus=contact_modulus((100.0, 0.499), (100.0, 0.499)))
    contact = solve(model).contact("contact")
    order = np.argsort(contact.points[:, 0])
    x = contact.points[order, 0]
    defect = ((contact.pressure[order] - hertz.pressure(x)) / hertz.peak_pressure)[x < 0.85 * hertz.half_width]
    assert np.abs(defect).max() < 0.02
    assert np.abs(defect[1:-1] - 0.5 * (defect[2:] + defect[:-2])).max() < 0.005


def test_thin_bodies_are_named():
    def names(ny, formulation="standard", cells="quad"):
        model = sg.Model(
            sg.rectangle(width=8.0, nx=8, ny=ny, cells=cells),
            bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3), formulation)],
            supports=[sg.Support("left", u=(0, 0))],
        )
        return thin_bodies(examine(model).space, model)

    assert names(1) == names(2) == ("block",)
    assert names(3) == names(1, "incompatible") == names(1, cells="quad8") == names(1, cells="triangle") == ()
