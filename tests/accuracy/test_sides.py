"""What pressures lack along a side: exact where they are a root of the distance from the end, or off by a line."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

import signorini as sg
from signorini.accuracy.contacts import trace_errors
from signorini.accuracy.recovery import StressRecovery
from signorini.accuracy.sides import side_errors
from signorini.fem.boundary import boundary
from signorini.fem.space import make_space
from signorini.fem.stress import DeformedBodies
from signorini.gallery import coarse

LINES = np.array([0.0, 1.0, 1.7, 2.9, 3.4, 5.0])


@pytest.fixture(scope="module")
def contact():
    """A block on a plane, with nodes at the lines; its side, and what a contact on it is like."""
    model = sg.Model(
        sg.rectangle(x=LINES, y=np.array([0.0, 1.0]), cells="triangle"),
        bodies=[sg.Body("block", coarse.SOFT)],
        supports=[sg.Support("top", u=(0.0, -0.01))],
        contacts=[sg.Contact("bottom", sg.Plane((0.0, 0.0), (0.0, 1.0)), friction=0.3, name="seat")],
    )
    result = sg.solve(model).contact("seat")
    order = np.argsort(result.points[:, 0])
    assert result.points[order, 0] == pytest.approx(LINES)
    return boundary(make_space(model.mesh), "bottom", ("contact",)), result, order


def with_pressures(contact, values):
    """Along the lines, sticking where they are not 0."""
    _, result, order = contact
    pressure, status = np.zeros(len(values)), np.full(len(values), "open", dtype="<U5")
    pressure[order] = values
    status[pressure > 0.0] = "stick"
    return replace(result, pressure=pressure, traction=0.0 * pressure, status=status)


def lacks(contact, result, difference=0.0, linear=False):
    side, _, order = contact
    pressure = result.pressure.copy()
    pressure[order] += difference
    errors = side_errors(side, result, (pressure, result.shear), linear=linear)
    return errors.pressure.sum(), errors


def squares(true, values, end, facets):
    """Integral over facets of the square of what lines between values lack of a function with a root at the end."""
    return sum(
        quad(
            lambda x: (true(x) - np.interp(x, LINES, values)) ** 2,
            *LINES[i : i + 2],
            points=[end] if LINES[i] < end < LINES[i + 1] else None,
            epsabs=1e-13,
        )[0]
        for i in facets
    )


@pytest.mark.parametrize(
    ("end", "facets"), [(2.95, (2, 3)), (3.2, (2, 3)), (3.4, (2, 3)), (1.05, (1, 2)), (1.6, (1, 2))]
)
def test_a_root_of_the_distance_from_the_end_is_told_from_its_chords(contact, end, facets):
    """On the last two facets; before them it is away from them, too, and is not looked at."""
    sign = 1.0 if facets[0] == 2 else -1.0
    true = lambda x: np.sqrt(np.maximum(sign * (end - x), 0.0))  # noqa: E731
    values = true(LINES)
    expected = squares(true, values, end, facets)
    assert lacks(contact, with_pressures(contact, values))[0] == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("end", [2.95, 3.2, 3.4])
def test_what_nodes_lack_at_the_end_is_told_with_the_root(contact, end):
    """Pressures that are wrong at the last two nodes, and stresses that know the root: all that is lacking there."""
    true = lambda x: np.sqrt(np.maximum(end - x, 0.0))  # noqa: E731
    wrong = np.where(end > LINES, true(LINES) + np.array([0.0, 0.0, -0.1, 0.15, 0.0, 0.0]), 0.0)
    result = with_pressures(contact, wrong)
    expected = squares(true, wrong, end, (2, 3) if end > 2.9 else (1, 2))
    found, _ = lacks(contact, result, true(LINES) - wrong)
    before = (LINES[2] - LINES[1]) * 0.1**2 / 3.0  # between the nodes at 1 and 1.7, of which the second is wrong
    assert found == pytest.approx(expected + before, rel=1e-6)


def test_open_pairs_lack_nothing(contact):
    """Whatever stresses are recovered there, but on the facet at which the contact ends."""
    result = with_pressures(contact, np.array([1.0, 1.0, 0.0, 0.0, 0.0, 0.0]))
    far, near = (np.where(np.arange(6) == i, 5.0, 0.0) for i in (4, 2))
    assert lacks(contact, result, far)[0] == lacks(contact, result)[0]
    assert lacks(contact, result, near)[0] == lacks(contact, result)[0]


def test_a_difference_that_varies_linearly(contact):
    """Of pairs that all touch: no end; ``int (0.1 + 0.2 x)^2 dx``, and nothing of a constant on linear cells."""
    result = with_pressures(contact, np.ones(len(LINES)))
    found, errors = lacks(contact, result, 0.1 + 0.2 * LINES)
    assert found == pytest.approx(((0.1 + 0.2 * 5.0) ** 3 - 0.1**3) / 0.6)
    assert errors.scale.sum() == pytest.approx(5.0)
    assert errors.friction.sum() == 0.0
    assert errors.at_nodes(len(result.node)).sum() == pytest.approx(found)
    assert lacks(contact, result, 0.1, linear=True)[0] == pytest.approx(0.0, abs=1e-15)


def test_stresses_of_both_bodies_press_alike():
    """Two cylinders whose sides are tilted against each other by 15 degrees at the ends: tilts are no errors."""
    model = coarse.two_cylinders()
    mesh = sg.solve(model, accuracy=sg.Accuracy(0.02, nodes=12_000)).model
    solution = sg.solve(mesh)
    deformed = DeformedBodies.of(make_space(mesh.mesh, kind=mesh.kind), mesh, solution.last.displacement)
    found = trace_errors(deformed, solution.last.contacts, StressRecovery(deformed.space, mesh).error(deformed), {})
    assert np.sqrt(found.pressure / found.scale) < 0.02
    for name in ("upper.arc", "lower.arc"):
        own = boundary(deformed.space, name, ("contact",)).corner_nodes
        assert found.nodes[own].sum() > 0.3 * found.nodes.sum()


def test_areas_opposite_grow_across_a_gap():
    """A ring in another that is a fifth larger: forces balance, so tractions of the outer one are a sixth smaller."""
    rings = {
        name: sg.annulus(
            inner=inner, outer=inner + 0.3, n_radial=6, n_angular=24, angle=90.0, cells="triangle", order=2
        )
        for name, inner in (("core", 0.7), ("shell", 1.2))
    }
    cuts = {"start": (None, 0.0), "end": (0.0, None)}
    model = sg.Model(
        sg.join(rings),
        bodies=[sg.Body(name, coarse.SOFT) for name in rings],
        supports=[sg.Support(f"{name}.{cut}", u=u) for name in rings for cut, u in cuts.items()],
        loads=[sg.Load("core.inner", pressure=40.0)],
        contacts=[sg.Contact("core.outer", "shell.inner", name="seat")],
    )
    solution = sg.solve(model)
    deformed = DeformedBodies.of(make_space(model.mesh, kind=model.kind), model, solution.last.displacement)
    found = trace_errors(deformed, solution.last.contacts, StressRecovery(deformed.space, model).error(deformed), {})
    assert np.sqrt(found.pressure / found.scale) < 0.02
