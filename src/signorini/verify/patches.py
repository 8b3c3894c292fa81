# SPDX-License-Identifier: BSD-3-Clause
"""Patch tests: uniform stress goes through contacts exactly, whatever the meshes, the cells and their direction."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.engine.solve import solve
from signorini.fem.generators import Cells, rectangle
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.gallery.blocks import block_on_foundation, four_blocks, stacked_blocks
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.step import Step
from signorini.solution.history import History
from signorini.verify.check import Check

_EXACT = 1e-9
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


def patch_p1() -> Iterator[Check]:
    """P1: two blocks pressed together."""
    for cells, across in _MESHES:
        history = solve(stacked_blocks(friction=0.3, cells=cells, across=across))
        contact = history.contact("interface")
        case = f"P1 two blocks, {_say(cells, across)}"
        yield _farthest(case, "contact pressure", contact.pressure, 1e5, "exact")
        yield _farthest(case, "u_y on the interface", history.last.displacement[contact.node, 1], -0.05, "exact")


def patch_p2() -> Iterator[Check]:
    """P2: block on a foundation under one pressure."""
    for cells, across in _MESHES:
        yield from _p2(block_on_foundation(friction=0.3, cells=cells, across=across), f"P2, {_say(cells, across)}")


def _p2(model: Model, case: str) -> Iterator[Check]:
    history, source = solve(model), "Taylor, Papadopoulos (1991)"
    contact = history.contact("interface")
    yield _farthest(case, "contact pressure", contact.pressure, 25.0, source)
    yield _farthest(case, "sigma_yy", _stress(history)[:, 1], -25.0, source)
    yield _farthest(case, "largest gap", contact.gap, 0.0, source)


def patch_turned() -> Iterator[Check]:
    """Two blocks turned by 30 degrees, pressed between their far sides: the stress turns with them."""
    pressure, angle = 10.0, np.radians(30.0)
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    xx, yy, xy = -pressure * np.array([across[0] ** 2, across[1] ** 2, across[0] * across[1]])
    for cells, numbers in _MESHES[2:]:
        history = solve(_turned(pressure, along, across, cells, numbers))
        case = f"Two blocks turned by 30 degrees, {_say(cells, numbers)}"
        yield _farthest(case, "contact pressure", history.contact("interface").pressure, pressure, "exact")
        wrong = np.abs(_stress(history)[:, [0, 1, 3]] - [xx, yy, xy]).max() / pressure
        yield _farthest(case, "largest error of the stress / p", np.array([wrong]), 0.0, "exact")


def _turned(pressure: float, along: Array, across: Array, cells: Cells, numbers: tuple[int, int]) -> Model:
    """Unit blocks, one on the other; what keeps them from turning moves as the stretch along the contact does."""
    E, nu = 1000.0, 0.3
    straight = join(
        {
            "upper": rectangle(nx=numbers[0], ny=3, origin=(0.0, 1.0), cells=cells),
            "lower": rectangle(nx=numbers[1], ny=2, cells=cells),
        }
    )
    mesh = replace(straight, points=straight.points @ np.array([along, across]))
    stretch = pressure * nu * (1.0 + nu) / E
    end = tuple(float(x) for x in mesh.points[np.linalg.norm(straight.points - [1.0, 0.0], axis=1).argmin()])
    return Model(
        mesh,
        bodies=[Body("upper", Elastic(E=E, nu=nu)), Body("lower", Elastic(E=E, nu=nu))],
        supports=[Support((0.0, 0.0), u=(0.0, 0.0)), Support(end, u=(float(stretch * along[0]), None))],
        loads=[Load("upper.top", pressure=pressure), Load("lower.bottom", pressure=pressure)],
        contacts=[Contact("upper.bottom", "lower.top", friction=0.3, name="interface")],
    )


def patch_p4() -> Iterator[Check]:
    """P4: four blocks under biaxial compression."""
    for cells, across in (("quad", (3, 3, 3, 3)), ("quad", (2, 3, 4, 5)), ("quad8", (2, 3, 4, 5))):
        stress = _stress(solve(four_blocks(cells="quad8" if cells == "quad8" else "quad", across=across)))
        case = f"P4 four blocks, {cells}, {' : '.join(map(str, across))}"
        for quantity, values, exact in (("sigma_xx", stress[:, 0], -10.0), ("sigma_yy", stress[:, 1], -20.0)):
            yield _farthest(case, quantity, values, exact, "exact")


def patch_p5() -> Iterator[Check]:
    """P5: on quadratic sides that do not match nodes on facets are wrong where mortar is exact: the test can fail."""
    for cells, across in (_MESHES[4], _MESHES[6]):
        model = stacked_blocks(friction=0.3, cells=cells, across=across)
        simple = replace(model, contacts=[replace(model.contacts[0], coupling="node-to-segment")])
        wrong = np.abs(solve(simple).contact("interface").pressure / 1e5 - 1.0).max()
        case = f"P5 quadratic sides, {_say(cells, across)}"
        yield _farthest(case, "pressure, mortar", solve(model).contact("interface").pressure, 1e5, "exact")
        yield Check(
            case=case,
            quantity="error of the pressure, node to segment",
            computed=float(wrong),
            reference=0.01,
            tolerance=0.0,
            source="fails, as it should",
            least=True,
        )


def patch_p6() -> Iterator[Check]:
    """P6: a block pushed by T on meshes that do not match: below mu N it sticks, above nothing can hold it."""
    friction, normal = 0.2, 25.0
    for share in (0.5, 0.99):
        history = solve(_pushed(share * friction * normal, friction))
        contact = history.contact("interface")
        yield Check(
            case=f"P6 pushed block, T = {share:g} mu N, quad 4 : 3",
            quantity="friction / N",
            computed=float(-contact.tangential_force[0] / contact.normal_force[1]),
            reference=share * friction,
            tolerance=_EXACT,
            source="equilibrium",
        )
    history = solve(_pushed(1.01 * friction * normal, friction), raise_on_failure=False)
    yield Check(
        case="P6 pushed block, T = 1.01 mu N, quad 4 : 3",
        quantity="1 if no equilibrium is proved",
        computed=float(history.status == "no_equilibrium"),
        reference=1.0,
        tolerance=0.0,
        source="equilibrium",
    )


def _pushed(push: float, friction: float) -> Model:
    """P2 with its block held by friction alone, pressed and pushed in one increment."""
    model = block_on_foundation(friction=friction, across=(4, 3))
    held = [support for support in model.supports if support.on != (1.0, 2.0)]
    return replace(
        model,
        supports=[*held, Support("foundation.left", u=(0.0, None))],
        loads=[*model.loads, Load("block.left", traction=(push, 0.0), name="push")],
        steps=[Step(increments=1)],
    )


def patch_discs() -> Iterator[Check]:
    """Axisymmetric: a disc pressed on another one."""
    for cells, across in _MESHES:
        history = solve(_discs(cells, across))
        contact = history.contact("interface")
        case = f"Axisymmetric discs, {_say(cells, across)}"
        yield _farthest(case, "contact pressure", contact.pressure, 10.0, "exact")
        u, (r, z) = history.last.displacement, history.model.mesh.points.T
        wrong = np.abs(u - np.column_stack([0.003 * r, -0.01 * z])).max() / 0.015
        yield _farthest(case, "largest error of u / largest u", np.array([wrong]), 0.0, "exact")


def _discs(cells: Cells, across: tuple[int, int]) -> Model:
    mesh = join(
        {
            "upper": rectangle(height=0.5, nx=across[0], ny=2, origin=(0.0, 1.0), cells=cells),
            "lower": rectangle(nx=across[1], ny=2, cells=cells),
        }
    )
    elastic = Elastic(E=1000.0, nu=0.3)
    return Model(
        mesh,
        kind="axisymmetric",
        bodies=[Body("upper", elastic), Body("lower", elastic)],
        supports=[Support("lower.bottom", u=(None, 0.0))],
        loads=[Load("upper.top", pressure=10.0)],
        contacts=[Contact("upper.bottom", "lower.top", friction=0.3, name="interface")],
    )


def _say(cells: Cells, across: tuple[int, int]) -> str:
    return f"{cells} {across[0]} : {across[1]}"


def _stress(history: History) -> Array:
    model: Model = history.model
    return np.vstack([b.stress for b in body_stresses(make_space(model.mesh), model, history.last.displacement)])


def _farthest(case: str, quantity: str, values: Array, exact: float, source: str) -> Check:
    """The value that is farthest from what all should be."""
    worst = float(values[np.argmax(np.abs(values - exact))])
    return Check(case=case, quantity=quantity, computed=worst, reference=exact, tolerance=_EXACT, source=source)
