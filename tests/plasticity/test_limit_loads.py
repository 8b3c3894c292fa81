# SPDX-License-Identifier: BSD-3-Clause
"""A flat punch on every family of cells: one increment to just below the limit load, and that load by name."""

import re
from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.footings import footing
from signorini.gallery.large_bodies import with_seat
from signorini.gallery.yielding import PERFECT, SHEAR_STRENGTH
from signorini.meshing.solid import extruded
from signorini.meshing.tetrahedra import tetrahedra

STEEL = sg.Elastic(E=1000.0 * SHEAR_STRENGTH, nu=0.3, plastic=PERFECT)
RAISED = {
    "hexahedron": "quad",
    "hexahedron20": "quad8",
    "hexahedron27": "quad9",
    "tetra10": "quad9",
    "wedge15": "triangle6",
}


def punched(force, *, cells, kind, formulation=None, n=2):
    """A block 3 x 2, in space a layer of it that cannot move across, pressed over a length of 1 from the left.

    Parameters
    ----------
    force : on the punch
    cells, kind, formulation : of the model
    n : nodes of edges in a length of 1
    """
    flat, space = RAISED.get(cells, cells), kind == "3d"
    fine = 1 if flat == "quad" else 2
    x, y = np.linspace(0.0, 3.0, 3 * n // fine + 1), np.linspace(-2.0, 0.0, 2 * n // fine + 1)
    mesh = with_seat(sg.rectangle(x=x, y=y, cells=flat), "top", 1.0)
    across = ()
    if space:
        mesh = extruded(mesh, z=np.linspace(0.0, fine / n, fine + 1), ends=("back", "front"))
        mesh = tetrahedra(mesh) if cells == "tetra10" else mesh
        across = (None,)
    (name,) = mesh.bodies
    supports = [("left", (0.0, None)), ("right", (0.0, None)), ("bottom", (0.0, 0.0))]
    return sg.Model(
        mesh,
        kind=kind,
        bodies=[sg.Body(name, STEEL, "standard" if cells == "wedge15" else formulation)],
        supports=[sg.Support(on, u=(*u, *across)) for on, u in supports]
        + [sg.Support(on, u=(None, None, 0.0)) for on in ("back", "front") if space],
        loads=[sg.Load("seat", force=(None, -force, *across), spread="displacement")],
        steps=[sg.Step(increments=1)],
    )


def named(history):
    """The part of the step at which bodies flow at most."""
    return float(re.search(r"flow plastically at ([\d.]+)% of the step", history.message)[1]) / 100.0


PLANE = ["plane strain", "plane stress", "axisymmetric"]
FAMILIES = [(cells, kind, None) for cells in ("quad", "quad8", "quad9", "triangle6") for kind in PLANE]
FAMILIES += [(cells, "3d", None) for cells in RAISED]
# around an axis modes change volume a little: no limit load
FAMILIES += [("quad", kind, "incompatible") for kind in PLANE[:2]] + [("hexahedron", "3d", "incompatible")]


@pytest.mark.slow
@pytest.mark.parametrize(("cells", "kind", "formulation"), FAMILIES)
def test_one_increment_goes_from_nothing_to_just_below_the_limit(cells, kind, formulation):
    """Within few rounds; and what is carried is below the bound that is named, however far beyond it the load is."""
    punch = {"cells": cells, "kind": kind, "formulation": formulation}
    limit = 40.0 * named(sg.solve(punched(40.0, **punch), raise_on_failure=False))
    for part, most in ((0.98, 12), (0.998, 16)):
        below = sg.solve(punched(part * limit, **punch))
        (rounds,) = [run.iterations for run in below.steps[0].trace[-1] if run.method == "plastic flow"]
        assert rounds <= (3 * most if kind == "3d" else most)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cells", "formulation", "edge", "limit"),
    [("tetra10", None, 0.4, 5.1991), ("hexahedron", "incompatible", 0.2, 5.4730)],
)
def test_the_bound_named_is_the_same_from_a_little_and_from_far_beyond(cells, formulation, edge, limit):
    """A little beyond steps are long before they are the mechanism; far beyond bodies flow in a dearer one."""
    for beyond in (1.002, 1.03, 7.0):
        punch = footing(beyond * limit, edge=edge, cells=cells, formulation=formulation)
        found = beyond * limit * named(sg.solve(punch, raise_on_failure=False))
        assert found == pytest.approx(limit, rel=5e-5)


@pytest.mark.slow
def test_a_punch_that_is_driven_deep_in_one_increment_settles():
    """Cells with modes, small at its edge and ten times as large away from it: far on the flat part of the curve."""
    solution = sg.solve(footing(edge=0.05, cells="hexahedron", formulation="incompatible", depth=0.08))
    (rounds,) = [run.iterations for run in solution.last.trace[-1] if run.method == "plastic flow"]
    assert rounds <= 40


def test_what_is_carried_is_below_the_bound():
    """Motions that change volume a little are no mechanisms yet: pressure does work on them too."""
    model = punched(5.524, cells="quad", kind="plane strain", n=4)
    assert sg.solve(model).solved
    (load,) = model.loads
    beyond = replace(model, loads=[replace(load, force=(None, -5.8))])
    assert 5.8 * named(sg.solve(beyond, raise_on_failure=False)) > 5.524
