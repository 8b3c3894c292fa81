# SPDX-License-Identifier: BSD-3-Clause
"""Patch tests: uniform stress goes through contacts exactly, whatever the meshes, the cells and their direction."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.engine.solve import solve
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.gallery.blocks import block_on_foundation, curved_blocks, four_blocks, stacked_blocks
from signorini.meshing.plane import Cells
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.kind import Kind
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.step import Step
from signorini.solution.history import History
from signorini.verify.check import Check, Row, checks_of, farthest

_EXACT = 1e-9  # of the value: all of it is rounding
_MESHES: tuple[tuple[Cells, tuple[int, int]], ...] = (
    ("quad", (4, 4)),
    ("triangle", (4, 4)),
    ("quad", (4, 7)),
    ("triangle", (5, 3)),
    ("quad8", (5, 3)),
    ("quad9", (3, 4)),
    ("triangle6", (4, 7)),
)
"""Cells, and how many of either side are along the interface."""

_TURN, _TURNED = 30.0, ", turned by 30 degrees"  # degrees


def patch_p1() -> Iterator[Check]:
    """P1: two blocks pressed together, turned ones from both sides."""
    pressed = [Load(side, pressure=1e5) for side in ("upper.top", "lower.bottom")]
    corners = ((0.0, 0.0), (1.0, 0.0), (0.0, 2.0))
    for cells, across in _MESHES:
        straight = stacked_blocks(friction=0.3, cells=cells, across=across)
        history, case = solve(straight), f"P1 two blocks, {_say(cells, across)}"
        contact = history.contact("interface")
        sunk = farthest(history.last.displacement[contact.node, 1], -0.05)
        yield from checks_of(
            case,
            ("contact pressure", farthest(contact.pressure, 1e5), 1e5, _EXACT),
            ("u_y on the interface", sunk, -0.05, _EXACT),
            source="exact",
        )
        history = solve(_oblique(straight, (0.0, -0.05), pressed, corners))
        yield from checks_of(
            f"{case}{_TURNED}",
            ("contact pressure", farthest(history.contact("interface").pressure, 1e5), 1e5, _EXACT),
            _stress_error(history, (0.0, -1e5), _TURN),
            source="exact",
        )


def patch_p2() -> Iterator[Check]:
    """P2: block on a foundation under one pressure."""
    E, nu = 2000.0, 0.3
    pressed = [Load(side, pressure=25.0) for side in ("block.top", "foundation.free", "foundation.bottom")]
    strain = 25.0 * nu * (1.0 + nu) / E, -25.0 * (1.0 - nu**2) / E
    for cells, across in _MESHES:
        straight = block_on_foundation(friction=0.3, cells=cells, across=across)
        oblique = _oblique(straight, strain, pressed, ((0.0, 0.0), (3.0, 0.0), (1.0, 2.0)))
        for model, angle, words in ((straight, 0.0, ""), (oblique, _TURN, _TURNED)):
            history = solve(model)
            contact = history.contact("interface")
            yield from checks_of(
                f"P2, {_say(cells, across)}{words}",
                ("contact pressure", farthest(contact.pressure, 25.0), 25.0, _EXACT),
                _stress_error(history, (0.0, -25.0), angle),
                ("largest gap", farthest(contact.gap, 0.0), 0.0, _EXACT),
                source="Taylor, Papadopoulos (1991)",
            )


def patch_p4() -> Iterator[Check]:
    """P4: four blocks under biaxial compression."""
    E, nu = 1000.0, 0.3
    xx, yy = (((1.0 - nu**2) * s - nu * (1.0 + nu) * t) / E for s, t in ((-10.0, -20.0), (-20.0, -10.0)))
    meshes: tuple[tuple[Cells, tuple[int, int, int, int]], ...] = (
        ("quad", (3, 3, 3, 3)),
        ("quad", (2, 3, 4, 5)),
        ("quad8", (2, 3, 4, 5)),
        ("triangle6", (2, 3, 4, 5)),
    )
    for cells, across in meshes:
        straight = four_blocks(cells=cells, across=across)
        reactions = [Load(f"{name}.left", pressure=10.0) for name in ("southwest", "northwest")]
        reactions += [Load(f"{name}.bottom", pressure=20.0) for name in ("southwest", "southeast")]
        corners = ((0.0, 0.0), (1.0 / across[0], 0.0), (2.0, 0.0), (0.0, 2.0), (2.0, 2.0))
        oblique = _oblique(straight, (xx, yy), [*straight.loads, *reactions], corners)
        for model, angle, words in ((straight, 0.0, ""), (oblique, _TURN, _TURNED)):
            history, case = solve(model), f"P4 four blocks, {cells}, {' : '.join(map(str, across))}{words}"
            beside = [history.contact(name).pressure for name in ("southeast.left", "northeast.left")]
            yield from checks_of(
                case,
                ("contact pressure, 10", farthest(np.concatenate(beside), 10.0), 10.0, _EXACT),
                ("contact pressure, 20", farthest(history.contact("northwest.bottom").pressure, 20.0), 20.0, _EXACT),
                _stress_error(history, (-10.0, -20.0), angle),
                source="exact",
            )


def patch_p5() -> Iterator[Check]:
    """P5: curved quadratic sides that do not match, where nodes on facets are wrong and mortar is exact."""
    cases: tuple[tuple[Kind, Cells, tuple[int, int], float], ...] = (
        ("plane strain", "quad", (4, 4), 0.0),
        ("plane strain", "quad8", (5, 3), 0.0),
        ("plane strain", "quad9", (3, 4), _TURN),
        ("plane strain", "triangle6", (4, 7), _TURN),
        ("axisymmetric", "quad8", (3, 5), 0.0),
        ("axisymmetric", "triangle6", (5, 3), 0.0),
    )
    for kind, cells, across, angle in cases:
        model = curved_blocks(kind=kind, cells=cells, across=across, angle=angle, friction=0.3)
        case = f"P5 parabola, {kind}, {_say(cells, across)}{_TURNED if angle else ''}"
        history = solve(model)
        contact = history.contact("interface")
        yield from checks_of(
            case,
            ("contact pressure", farthest(contact.pressure, 10.0), 10.0, _EXACT),
            ("friction / p", farthest(contact.traction / 10.0, 0.0), 0.0, _EXACT),
            _stress_error(history, (-10.0, -10.0), angle),
            source="exact",
        )
        if cells == "quad8":
            simple = replace(model, contacts=[replace(model.contacts[0], coupling="node-to-segment")])
            wrong = np.abs(solve(simple).contact("interface").pressure / 10.0 - 1.0).max()
            row = ("error of the pressure, node to segment", wrong, 0.01, 0.0, "fails, as it should")
            yield from checks_of(case, row, least=True)


def patch_p6() -> Iterator[Check]:
    """P6: a block pushed by T on meshes that do not match: below mu N it sticks, above nothing can hold it."""
    friction, normal = 0.2, 25.0
    cases: tuple[tuple[Cells, float], ...] = (("quad", 0.0), ("quad8", 0.0), ("quad", _TURN), ("triangle6", _TURN))
    for cells, angle in cases:
        words, along = f"{_say(cells, (4, 3))}{_TURNED if angle else ''}", _rotation(angle)
        for share in (0.5, 0.99):
            contact = solve(_pushed(share * friction * normal, friction, cells, angle)).contact("interface")
            held, pressed = float(contact.tangential_force @ along[0]), float(contact.normal_force @ along[1])
            row = ("friction / N", -held / pressed, share * friction, _EXACT, "equilibrium")
            yield from checks_of(f"P6 pushed block, T = {share:g} mu N, {words}", row)
        history = solve(_pushed(1.01 * friction * normal, friction, cells, angle), raise_on_failure=False)
        row = ("1 if no equilibrium is proved", history.status == "no_equilibrium", 1.0, 0.0, "equilibrium")
        yield from checks_of(f"P6 pushed block, T = 1.01 mu N, {words}", row)


def _pushed(push: float, friction: float, cells: Cells, angle: float) -> Model:
    """P2 with its block held by friction alone, pressed and pushed in one increment."""
    model = block_on_foundation(friction=friction, cells=cells, across=(4, 3))
    Q = _rotation(angle)
    sideways = tuple(float(part) for part in push * Q[0])
    return replace(
        model,
        mesh=replace(model.mesh, points=model.mesh.points @ Q),
        supports=[Support("foundation.bottom", u=(0.0, 0.0))],
        loads=[*model.loads, Load("block.left", traction=sideways, name="push")],
        steps=[Step(increments=1)],
    )


def patch_discs() -> Iterator[Check]:
    """Axisymmetric: a disc pressed on another one."""
    for cells, across in _MESHES:
        history = solve(_discs(cells, across))
        contact = history.contact("interface")
        u, (r, z) = history.last.displacement, history.model.mesh.points.T
        wrong = np.abs(u - np.column_stack([0.003 * r, -0.01 * z])).max() / 0.02
        yield from checks_of(
            f"Axisymmetric discs, {_say(cells, across)}",
            ("contact pressure", farthest(contact.pressure, 10.0), 10.0, _EXACT),
            ("largest error of u / largest u", wrong, 0.0, _EXACT),
            source="exact",
        )


def _discs(cells: Cells, across: tuple[int, int]) -> Model:
    return replace(
        stacked_blocks(friction=0.3, cells=cells, across=across),
        kind="axisymmetric",
        bodies=[Body(name, Elastic(E=1000.0, nu=0.3)) for name in ("upper", "lower")],
        supports=[Support("lower.bottom", u=(None, 0.0))],
        loads=[Load("upper.top", pressure=10.0)],
    )


def _say(cells: Cells, across: tuple[int, int]) -> str:
    return f"{cells} {across[0]} : {across[1]}"


def _stress_error(history: History, stress: tuple[float, float], angle: float) -> Row:
    """How far any nodal stress in the plane is from two principal ones, turned, over the larger one."""
    model, Q = history.model, _rotation(angle)
    exact = Q.T @ np.diag(stress) @ Q
    space = make_space(model.mesh, kind=model.kind)
    found = np.vstack([b.stress for b in body_stresses(space, model, history.last.displacement)])[:, [0, 1, 3]]
    wrong = np.abs(found - [exact[0, 0], exact[1, 1], exact[0, 1]]).max() / np.abs(stress).max()
    return "largest error of the stress / its size", wrong, 0.0, _EXACT


def _rotation(angle: float) -> Array:
    """(2, 2) Rows are the turned axes; the angle in degrees. Points (n, 2) turn by multiplying from the left."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return np.array([[c, s], [-s, c]])


def _oblique(
    model: Model,
    strain: tuple[float, float],
    loads: Sequence[Load],
    corners: Sequence[tuple[float, float]],
) -> Model:
    """A model turned about the origin, pressed from all sides and kept in place by a few corners that bear nothing.

    Parameters
    ----------
    strain : along x and y of the model as it is given; its displacements are ``strain * (x, y)``
    loads : instead of the model's; those that were reactions included
    corners : nodes that move as the exact solution does, two of one body and one of every other, before the turn
    """
    Q = _rotation(_TURN)
    held = [
        Support(_pair(place @ Q), u=_pair((place * strain) @ Q)) for place in (np.array(corner) for corner in corners)
    ]
    mesh = replace(model.mesh, points=model.mesh.points @ Q)
    return replace(model, mesh=mesh, supports=held, loads=list(loads))


def _pair(vector: Array) -> tuple[float, float]:
    return float(vector[0]), float(vector[1])
