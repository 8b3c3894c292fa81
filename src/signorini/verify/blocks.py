# SPDX-License-Identifier: BSD-3-Clause
"""Patch tests on meshes that match or not, and the one-node Coulomb problem."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.arrays import Array
from signorini.engine.solve import solve
from signorini.fem.generators import Cells
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.friction.exact import follow, initial_state, land
from signorini.friction.problem import CoulombProblem
from signorini.friction.solve import solve_coulomb
from signorini.gallery.blocks import block_on_foundation, four_blocks, stacked_blocks
from signorini.model.model import Model
from signorini.solution.history import History
from signorini.verify.check import Check

PATCHES: tuple[tuple[Cells, tuple[int, int]], ...] = (
    ("quad", (4, 4)),
    ("triangle", (4, 4)),
    ("quad", (4, 7)),
    ("quad8", (5, 3)),
)
"""Cells, and how many of either side are along the interface."""


def patch_p1() -> Iterator[Check]:
    """P1: two blocks pressed together."""
    for cells, across in PATCHES:
        history = solve(stacked_blocks(friction=0.3, cells=cells, across=across))
        contact = history.contact("interface")
        case = f"P1 two blocks, {_say(cells, across)}"
        yield _farthest(case, "contact pressure", contact.pressure, 1e5, "exact")
        yield _farthest(case, "u_y on the interface", history.last.displacement[contact.node, 1], -0.05, "exact")


def patch_p2() -> Iterator[Check]:
    """P2: block on a foundation under one pressure."""
    for cells, across in PATCHES:
        history = solve(block_on_foundation(friction=0.3, cells=cells, across=across))
        case, source = f"P2 block on foundation, {_say(cells, across)}", "Taylor, Papadopoulos (1991)"
        yield _farthest(case, "contact pressure", history.contact("interface").pressure, 25.0, source)
        yield _farthest(case, "sigma_yy", _stress(history)[:, 1], -25.0, source)
        yield Check(
            case=case,
            quantity="largest gap",
            computed=float(np.abs(history.contact("interface").gap).max()),
            reference=0.0,
            tolerance=1e-12,
            source=source,
        )


def patch_p4() -> Iterator[Check]:
    """P4: four blocks under biaxial compression."""
    for case, across in (("P4 four blocks", (3, 3, 3, 3)), ("P4 four blocks, 2 : 3 : 4 : 5", (2, 3, 4, 5))):
        stress = _stress(solve(four_blocks(across=across)))
        for quantity, values, exact in (("sigma_xx", stress[:, 0], -10.0), ("sigma_yy", stress[:, 1], -20.0)):
            yield _farthest(case, quantity, values, exact, "exact")


def one_node() -> Iterator[Check]:
    """K = [[2, 1], [1, 2]], pressed by 1: unique at mu = 1; at mu = 3 and f_t = 2.5 one of three solutions."""
    case, source = "one-node Coulomb problem", "enumeration of states, Klarbring (1990)"
    slipping = _one_node(friction=1.0, push=1.5)
    # slip at mu = 1: 2 u_t = 1.5 - N with N = 1 - u_t
    yield Check(
        case=case, quantity="slip, mu 1, f_t 1.5", computed=slipping[1], reference=0.5, tolerance=1e-10, source=source
    )
    several = np.array(_one_node(friction=3.0, push=2.5))
    known = np.array([[0.0, 0.0], [0.0, 0.5], [1 / 6, 4 / 3]])
    yield Check(
        case=case,
        quantity="distance to the nearest of 3 solutions, mu 3",
        computed=float(np.abs(known - several).max(axis=1).min()),
        reference=0.0,
        tolerance=1e-10,
        source=source,
    )


def _say(cells: Cells, across: tuple[int, int]) -> str:
    return cells if across[0] == across[1] else f"{cells} {across[0]} : {across[1]}"


def one_node_path() -> Iterator[Check]:
    """The same node as a history, pressed by 1 and pulled up to 4: events, and at mu = 3 the jump and its landing."""
    case, source = "one-node Coulomb problem, exact path", "by hand, Klarbring (1990)"
    for friction, words in ((1.0, "mu 1"), (3.0, "mu 3")):
        W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]])).astype(np.float64)
        problem = CoulombProblem(W=W, b=np.zeros(2), friction=np.array([friction]), motions=np.zeros((2, 0)), scale=4.0)
        pressed = follow(problem, initial_state(problem, np.zeros(2)), W @ np.array([-1.0, 0.0])).end
        path = follow(problem, pressed, W @ np.array([-1.0, 4.0]))
        if path.jump is None:
            end, found = (
                path.end,
                [("slips at f_t", 4 * path.events[0].factor, 1.0), ("opens at f_t", 4 * path.events[1].factor, 2.0)],
            )
            found += [("gap at f_t = 4", end.h[0], 2 / 3), ("u_t at f_t = 4", end.h[1], 7 / 3)]
        else:
            landing = land(problem, pressed, path)
            end = path.end if landing is None else landing.state
            found = [("jumps at f_t", 4 * path.jump.factor, 3.0), ("gap where it lands", end.h[0], 1 / 3)]
            found += [("u_t where it lands", end.h[1], 5 / 3)]
        found.append(("dissipation", end.dissipation[0], 0.5 if path.jump is None else 1.5))
        for quantity, computed, reference in found:
            yield Check(
                case=case,
                quantity=f"{quantity}, {words}",
                computed=float(computed),
                reference=reference,
                tolerance=1e-12,
                source=source,
            )


def _one_node(*, friction: float, push: float) -> tuple[float, float]:
    """Gap and tangential displacement of the one-node problem, in the image form with D = 1."""
    # unknowns (gap, slip): u_n of the catalogue is -gap there, so that the coupling changes sign
    K = np.array([[2.0, -1.0], [-1.0, 2.0]])
    W = np.linalg.inv(K + np.eye(2)).astype(np.float64)
    result = solve_coulomb(
        CoulombProblem(
            W=W, b=W @ np.array([-1.0, push]), friction=np.array([friction]), motions=np.zeros((2, 0)), scale=1.0
        )
    )
    return float(result.gap[0]), float(result.slip[0])


def _stress(history: History) -> Array:
    model: Model = history.model
    return np.vstack([b.stress for b in body_stresses(make_space(model.mesh), model, history.last.displacement)])


def _farthest(case: str, quantity: str, values: Array, exact: float, source: str) -> Check:
    """The value that is farthest from what all should be."""
    worst = float(values[np.argmax(np.abs(values - exact))])
    return Check(case=case, quantity=quantity, computed=worst, reference=exact, tolerance=1e-10, source=source)
