# SPDX-License-Identifier: BSD-3-Clause
"""Where standard cells are too stiff: bending of a cantilever, nearly incompressible vessels; and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from test_axisymmetric import WALL, sphere, tube

import signorini as sg
from signorini.engine.prepare import examine
from signorini.engine.solve import solve
from signorini.fem.locking import thin_bodies
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.reference.lame import hollow_sphere, thick_cylinder


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


@pytest.mark.parametrize(("make", "reference"), [(tube, thick_cylinder), (sphere, hollow_sphere)])
def test_nearly_incompressible_vessels(make, reference):
    model = make(16, "quad")
    rubber = sg.Body(model.bodies[0].name, sg.Elastic(E=200.0, nu=0.49999), "incompatible")
    model = replace(model, bodies=[rubber])
    u, points = solve(model).last.displacement, model.mesh.points
    r = points[:, 0] if make is tube else np.linalg.norm(points, axis=1)
    moved = u[:, 0] if make is tube else np.sum(u * points, axis=1) / r
    exact, _, hoop = reference(r, **(WALL | {"nu": 0.49999}))
    (found,) = body_stresses(make_space(model.mesh, axisymmetric=True), model, u)
    inside = (r > 1.2) & (r < 1.8)
    np.testing.assert_allclose(moved, exact, rtol=0.004)
    np.testing.assert_allclose(found.stress[inside, 2], hoop[inside], atol=0.01 * WALL["pressure"])


@pytest.mark.parametrize("cells", ["quad", "triangle", "quad8", "triangle6"])
def test_a_locked_answer_is_refused(cells):
    block = {"supports": [sg.Support("bottom", u=(0, 0))], "loads": [sg.Load("top", pressure=1.0)]}
    rubber = sg.Body("block", sg.Elastic(E=1.0, nu=0.4999))
    mesh = sg.rectangle(nx=2, ny=2, cells=cells)
    with pytest.raises(sg.InputError, match=r"body\[0\].formulation: 'block' is nearly incompressible .* would lock"):
        solve(sg.Model(mesh, bodies=[rubber], **block))
    solve(sg.Model(mesh, kind="plane stress", bodies=[rubber], **block))
    if cells != "quad":
        with pytest.raises(sg.InputError, match=f"has no 'quad' or 'hexahedron' cells; it has {cells}"):
            solve(sg.Model(mesh, bodies=[replace(rubber, formulation="incompatible")], **block))


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
