# SPDX-License-Identifier: BSD-3-Clause
"""Thin and slender bodies: their displacements are millions of times those of compression, and digits are few."""

import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as spla

import signorini as sg
from signorini.engine import jump_watch
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared

STEEL = sg.Elastic(E=200e3, nu=0.3)


def cantilever(length: float, force: float) -> sg.Model:
    """A strip 1 high, held on the left, pulled down on the right."""
    mesh = sg.rectangle(x=np.linspace(0.0, length, 21).tolist(), y=[0.0, 0.5, 1.0], cells="quad8")
    return sg.Model(
        mesh,
        kind="plane stress",
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("left", u=(0, 0))],
        loads=[sg.Load("right", force=(0.0, -force))],
    )


@pytest.mark.parametrize("length", [200.0, 400.0])
def test_a_cantilever_hundreds_of_times_as_long_as_high(length):
    force = 0.01
    end = sg.solve(cantilever(length, force)).last
    assert end.certificate.passed
    assert end.displacement[:, 1].min() == pytest.approx(-4.0 * force * length**3 / STEEL.E, rel=1e-2)


@pytest.mark.parametrize("length", [4e3, 1e5])
def test_a_body_too_slender_for_the_digits_is_told_so(length):
    with pytest.raises(sg.InputError, match=r"body 'block' is too slender for double precision: what resists the mo"):
        prepare(cantilever(length, 1e-5))


@pytest.mark.skipif(np.finfo(np.longdouble).eps > 1e-18, reason="no numbers of more digits here")
def test_a_cantilever_keeps_the_digits_of_its_displacements():
    """Against the same stiffness solved with a factor and residuals in numbers of more digits."""
    prepared = prepare(cantilever(400.0, 0.01))
    T = prepared.constraints.transform
    K, f = sp.csc_array(T.T @ prepared.K @ T), T.T @ prepared.loads["right"]
    factor, long, u = spla.splu(K), K.astype(np.longdouble), np.zeros(len(f), dtype=np.longdouble)
    for _ in range(8):
        u += factor.solve(np.asarray(f - long @ u, dtype=np.float64))
    found = T.T @ solve_prepared(prepared).last.displacement.ravel()
    np.testing.assert_allclose(found, np.asarray(u, dtype=np.float64), rtol=0.0, atol=1e-7 * np.abs(found).max())


def leaf_springs(length: float, force: float, cells: str, formulation: str) -> sg.Model:
    """Two strips on one another, each 1 high, held on the left; the upper one is pulled down on the right."""
    along, leaves = np.linspace(0.0, length, 21).tolist(), {"a": [0.0, 0.5, 1.0], "b": [1.0, 1.5, 2.0]}
    return sg.Model(
        sg.join({name: sg.rectangle(x=along, y=up, cells=cells) for name, up in leaves.items()}),
        kind="plane stress",
        bodies=[sg.Body(name, STEEL, formulation=formulation) for name in leaves],
        supports=[sg.Support(f"{name}.left", u=(0, 0)) for name in leaves],
        loads=[sg.Load("b.right", force=(0.0, -force))],
        contacts=[sg.Contact("b.bottom", "a.top", friction=0.2)],
    )


@pytest.mark.parametrize("length", [70.0, 200.0, 400.0, 1000.0])
@pytest.mark.parametrize(("cells", "formulation"), [("quad8", "standard"), ("quad", "incompatible")])
def test_two_leaf_springs_share_a_load_at_the_tip(length, cells, formulation):
    """Each bends by half the load: friction between them is far below that of a common section.

    From 400 on rounding, which bends them, changes which pairs touch from one refinement to the next.
    """
    force = 100.0 / length**2
    end = sg.solve(leaf_springs(length, force, cells, formulation)).last
    assert end.certificate.passed
    assert end.displacement[:, 1].min() == pytest.approx(-2.0 * force * length**3 / STEEL.E, rel=1e-2)


@pytest.mark.slow
def test_leaf_springs_too_slender_for_the_digits_are_told_so():
    said = sg.solve(leaf_springs(4000.0, 6.25e-6, "quad", "incompatible"), raise_on_failure=False)
    assert said.status == "not_found"
    assert "bodies are too slender for double precision: rounding of their displacements" in said.message


def test_certificates_of_compact_bodies_refer_to_what_they_are_compressed_by():
    """A certificate that knows bending must not excuse what does not bend: the length of a cube is its compression."""
    model = sg.Model(
        sg.rectangle(width=1.0, height=1.0, nx=4, ny=4),
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("left", u=(0, None))],
        loads=[sg.Load("top", pressure=1.0)],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)))],
    )
    assert prepare(model).scale.length < 5.0 / STEEL.E


def shim(height: float, cells: str) -> sg.Model:
    """A thin plate between two cubes, all on planes of symmetry, under a uniform pressure."""
    along, up = [0.0, 0.25, 0.5, 0.75, 1.0], {"a": [-1.0, 0.0], "s": [0.0, height], "b": [height, 1.0 + height]}
    sides = {"left": (0, None, None), "front": (None, 0, None)}
    return sg.Model(
        sg.join({name: sg.box(x=along, y=along, z=z, cells=cells) for name, z in up.items()}),
        kind="3d",
        bodies=[sg.Body(name, STEEL) for name in up],
        supports=[
            sg.Support("a.bottom", u=(None, None, 0)),
            *(sg.Support(f"{name}.{side}", u=u) for name in up for side, u in sides.items()),
        ],
        loads=[sg.Load("b.top", pressure=100.0)],
        contacts=[
            sg.Contact("s.bottom", "a.top", friction=0.2, name="lower"),
            sg.Contact("s.top", "b.bottom", friction=0.2, name="upper"),
        ],
        steps=[sg.Step(increments=1)],
    )


@pytest.mark.parametrize("cells", ["hexahedron20", "tetra10"])
@pytest.mark.parametrize("height", [0.01])
def test_a_shim_passes_a_uniform_pressure_on(height, cells):
    for contact in sg.solve(shim(height, cells)).last.contacts:
        np.testing.assert_allclose(contact.pressure, 100.0, rtol=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("cells", ["hexahedron20", "tetra10"])
def test_where_the_condensed_interface_has_lost_its_digits_the_bodies_have_them(cells, monkeypatch):
    """Compliances of a shim 1000 times as wide as thick are 10^8 times those of the blocks.

    Friction holds it against all loads, so that no slide is looked for, increment by increment.
    """
    monkeypatch.setattr(jump_watch, "follow_to_events", lambda *_, **__: pytest.fail("a slide was looked for"))
    step = sg.solve(shim(0.001, cells)).last
    assert any("on the bodies as they are" in note for note in step.notes)
    for contact in step.contacts:
        np.testing.assert_allclose(contact.pressure, 100.0, rtol=1e-8)
