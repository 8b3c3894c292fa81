# SPDX-License-Identifier: BSD-3-Clause
"""The one-node Coulomb problem: one solution, three, and a path that must jump."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.friction.history.plane import follow, initial_state, land
from signorini.friction.problem import CoulombProblem
from signorini.friction.solve import solve_coulomb
from signorini.friction.spatial import SpatialProblem, at_rest, follow_stopping, land_spatial
from signorini.verify.check import Check


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


def one_node_path() -> Iterator[Check]:
    """The same node as a history, pressed by 1 and pulled up to 4: events, and at mu = 3 the jump and its landing."""
    case, source = "one-node Coulomb problem, exact path", "by hand, Klarbring (1990)"
    for friction, words in ((1.0, "mu 1"), (3.0, "mu 3")):
        W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]])).astype(np.float64)
        problem = CoulombProblem.of(
            W=W, b=np.zeros(2), friction=np.array([friction]), motions=np.zeros((2, 0)), scale=4.0
        )
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


def one_node_path_in_space() -> Iterator[Check]:
    """The node of `one_node_path` at mu = 3, pulled along a corner, across an edge and on the circle: the same jump."""
    source = "by hand, Klarbring (1990)"
    ways = (("corner of 8 facets", 8, 0.25 * np.pi), ("edge of 8", 8, 0.375 * np.pi), ("circle", 0, 0.3))
    for words, facets, angle in ways:
        case = f"one-node Coulomb problem in space, pulled along {words}"
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
        W = turn @ np.linalg.inv(np.array([[3.0, -1.0, 0.0], [-1.0, 3.0, 0.0], [0.0, 0.0, 3.0]])) @ turn.T
        friction = 3.0 / np.cos(np.pi / 8) if words.startswith("edge") else 3.0
        problem = SpatialProblem.of(
            W=W, b=np.zeros(3), friction=np.array([friction]), motions=np.zeros((3, 0)), scale=4.0, facets=facets
        )
        pressed = follow_stopping(problem, at_rest(problem, np.zeros(3)), W @ turn @ np.array([-1.0, 0.0, 0.0])).end
        path = follow_stopping(problem, pressed, W @ turn @ np.array([-1.0, 4.0, 0.0]))
        landing = land_spatial(problem, pressed, path)
        end = path.end if landing is None else landing.state
        gap, along, _ = turn.T @ end.h
        found = [("jumps at f_t", np.nan if path.jump is None else 4 * path.jump.factor, 3.0)]
        found += [("gap where it lands", gap, 1 / 3), ("u_t where it lands", along, 5 / 3)]
        found.append(("dissipation", end.dissipation[0], 1.5))
        for quantity, computed, reference in found:
            yield Check(
                case=case,
                quantity=quantity,
                computed=float(computed),
                reference=reference,
                tolerance=1e-11,
                source=source,
            )


def _one_node(*, friction: float, push: float) -> tuple[float, float]:
    """Gap and tangential displacement of the one-node problem, in the image form with D = 1."""
    # unknowns (gap, slip): u_n of the catalogue is -gap there, so that the coupling changes sign
    K = np.array([[2.0, -1.0], [-1.0, 2.0]])
    W = np.linalg.inv(K + np.eye(2)).astype(np.float64)
    result = solve_coulomb(
        CoulombProblem.of(
            W=W, b=W @ np.array([-1.0, push]), friction=np.array([friction]), motions=np.zeros((2, 0)), scale=1.0
        )
    )
    return float(result.gap[0]), float(result.slip[0])
