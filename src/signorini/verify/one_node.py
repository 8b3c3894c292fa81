# SPDX-License-Identifier: BSD-3-Clause
"""The one-node Coulomb problem: one solution, three, and a path that must jump."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.arrays import Array
from signorini.friction.history import Landing, PathState, Segment, follow, initial_state, land
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.verify.check import Check, checks_of

# unknowns (gap, slip): u_n of the catalogue is -gap there, so that the coupling changes sign
_IMAGE = np.linalg.inv(np.array([[2.0, -1.0], [-1.0, 2.0]]) + np.eye(2)).astype(np.float64)
"""The stiffness in the image form with D = 1."""


def one_node() -> Iterator[Check]:
    """K = [[2, 1], [1, 2]], pressed by 1: unique at mu = 1; at mu = 3 and f_t = 2.5 one of three solutions."""
    known = np.array([[0.0, 0.0], [0.0, 0.5], [1 / 6, 4 / 3]])
    distance = np.abs(known - _gap_and_slip(friction=3.0, push=2.5)).max(axis=1).min()
    yield from checks_of(
        "one-node Coulomb problem",
        # slip at mu = 1: 2 u_t = 1.5 - N with N = 1 - u_t
        ("slip, mu 1, f_t 1.5", _gap_and_slip(friction=1.0, push=1.5)[1], 0.5, 1e-10),
        ("distance to the nearest of 3 solutions, mu 3", distance, 0.0, 1e-10),
        source="enumeration of states, Klarbring (1990)",
    )


def one_node_path() -> Iterator[Check]:
    """A history of one node, pressed by 1 and pulled up to 4: events, and at mu = 3 the jump and its landing."""
    for friction in (1.0, 3.0):
        problem, pressed, path = pressed_and_pulled(friction=friction)
        end = path.end
        if path.jump is None:
            slips, opens = (4 * event.factor for event in path.events[:2])
            found = [("slips at f_t", slips, 1.0), ("opens at f_t", opens, 2.0)]
            found += [("gap at f_t = 4", end.h[0, 0], 2 / 3), ("u_t at f_t = 4", end.h[1, 0], 7 / 3)]
        else:
            landing = land(problem, pressed, path)
            end = landing.state if isinstance(landing, Landing) else end
            found = [("jumps at f_t", 4 * path.jump.factor, 3.0), ("gap where it lands", end.h[0, 0], 1 / 3)]
            found += [("u_t where it lands", end.h[1, 0], 5 / 3)]
        found.append(("dissipation", end.dissipation[0], 0.5 if path.jump is None else 1.5))
        yield from checks_of(
            "one-node Coulomb problem, exact path",
            *((f"{quantity}, mu {friction:g}", computed, exact, 1e-12) for quantity, computed, exact in found),
            source="by hand, Klarbring (1990)",
        )


def pressed_and_pulled(*, friction: float, limit: float | None = None) -> tuple[ContactProblem, PathState, Segment]:
    """The node pressed by 1, then pulled up to 4: the problem, the state it is pressed in, and the path from there."""
    bound = {} if limit is None else {"limit": np.array([limit])}
    problem = ContactProblem.of(
        W=_IMAGE, b=np.zeros(2), friction=np.array([friction]), motions=np.zeros((2, 0)), scale=4.0, **bound
    )
    pressed = follow(problem, initial_state(problem, np.zeros(2)), _IMAGE @ np.array([-1.0, 0.0])).end
    return problem, pressed, follow(problem, pressed, _IMAGE @ np.array([-1.0, 4.0]))


def one_node_path_in_space() -> Iterator[Check]:
    """The node of `one_node_path` at mu = 3, pulled along a corner, across an edge and on the circle: the same jump."""
    ways = (("corner of 8 facets", 8, 0.25 * np.pi), ("edge of 8", 8, 0.375 * np.pi), ("circle", 0, 0.3))
    for words, facets, angle in ways:
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
        W = turn @ np.linalg.inv(np.array([[3.0, -1.0, 0.0], [-1.0, 3.0, 0.0], [0.0, 0.0, 3.0]])) @ turn.T
        friction = 3.0 / np.cos(np.pi / 8) if words.startswith("edge") else 3.0
        problem = ContactProblem.of(
            W=W, b=np.zeros(3), friction=np.array([friction]), motions=np.zeros((3, 0)), scale=4.0, facets=facets
        )
        pressed = follow(problem, initial_state(problem, np.zeros(3)), W @ turn @ np.array([-1.0, 0.0, 0.0])).end
        path = follow(problem, pressed, W @ turn @ np.array([-1.0, 4.0, 0.0]))
        landing = land(problem, pressed, path)
        end = landing.state if isinstance(landing, Landing) else path.end
        gap, along, _ = turn.T @ end.h[:, 0]
        found = [("jumps at f_t", np.nan if path.jump is None else 4 * path.jump.factor, 3.0)]
        found += [("gap where it lands", gap, 1 / 3), ("u_t where it lands", along, 5 / 3)]
        found.append(("dissipation", end.dissipation[0], 1.5))
        yield from checks_of(
            f"one-node Coulomb problem in space, pulled along {words}",
            *((quantity, computed, exact, 1e-11) for quantity, computed, exact in found),
            source="by hand, Klarbring (1990)",
        )


def _gap_and_slip(*, friction: float, push: float) -> Array:
    """(2,) Gap and tangential displacement where the node is pressed by 1 and pushed."""
    b = _IMAGE @ np.array([-1.0, push])
    problem = ContactProblem.of(W=_IMAGE, b=b, friction=np.array([friction]), motions=np.zeros((2, 0)), scale=1.0)
    result = solve_contact(problem)
    return result.h[:, 0]
