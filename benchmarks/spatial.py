# SPDX-License-Identifier: BSD-3-Clause
"""Contact in space: how the cone solver and the mortar coupling do; writes the tables of docs/three_dimensions.md.

python -m benchmarks.spatial
"""

from __future__ import annotations

import itertools
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.page import seconds, table, write
from benchmarks.spatial_problems import from_compliance, hard_random, natural_residual, punch
from signorini.arrays import Array
from signorini.fem.boundary import Boundary
from signorini.fem.facets import facet_nodes
from signorini.friction.history import PathSettings, PathState, follow, initial_state
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.interface.facing import near_pairs
from signorini.interface.mortar import mortar_coupling

PAGE = Path(__file__).parent.parent / "docs" / "three_dimensions.md"
FRICTIONS = (0.1, 0.3, 0.6, 1.0)


def punches() -> str:
    rows = []
    for side in (7, 10, 15, 20, 30):
        A, c = punch(side)
        steps, worst, spent = [], 0.0, []
        for mu in FRICTIONS:
            problem, root = from_compliance(A, c, np.full(side**2, mu))
            _ = problem.image.A
            start = time.process_time()
            result = solve_contact(problem)
            spent.append(time.process_time() - start)
            r = result.r.ravel() * root
            steps.append("/".join(str(a.iterations) for a in result.trace))
            worst = max(worst, natural_residual(A @ r + c, r, mu, root[: side**2] ** 2))
        closed = int((result.state > 0).sum())
        rows.append((side**2, closed, ", ".join(steps), f"{worst:.0e}", seconds(max(spent))))
    head = ("pairs", "closed (mu 1)", f"Newton systems at mu = {', '.join(map(str, FRICTIONS))}", "residual", "seconds")
    return table(head, rows)


def facets() -> str:
    A, c = punch(10)
    exact = {mu: solve_contact(from_compliance(A, c, np.full(100, mu))[0]) for mu in FRICTIONS}
    rows = []
    for count in (4, 8, 16, 32):
        nodal, resultant, bound = 0.0, 0.0, 2 * np.sin(np.pi / (2 * count))
        for mu, circle in exact.items():
            polygon = solve_contact(from_compliance(A, c, np.full(100, mu), facets=count)[0])
            error = polygon.tangential_force - circle.tangential_force
            nodal = max(nodal, np.linalg.norm(error, axis=0).max() / (mu * circle.normal_force.max()))
            total = np.linalg.norm(circle.tangential_force.sum(axis=1))
            resultant = max(resultant, np.linalg.norm(error.sum(axis=1)) / total)
        rows.append((count, f"{100 * nodal:.1f} %", f"{100 * resultant:.2f} %", f"{100 * bound:.0f} %"))
    return table(("facets", "largest nodal error / (mu p_max)", "resultant", "half a facet, 2 sin(pi / 2m)"), rows)


def hard() -> str:
    rows = []
    for gap in (1.0, 0.0):
        outcomes = {"newton": 0, "rounds": 0, "not found": 0}
        worst, most = 0.0, 0
        for _, mu, A, c in hard_random(gap):
            n = len(c) // 3
            problem, root = from_compliance(A, c, np.full(n, mu))
            result = solve_contact(problem)
            if not result.solved:
                outcomes["not found"] += 1
                continue
            outcomes["newton" if len(result.trace) == 1 else "rounds"] += 1
            most = max(most, sum(a.method == "proximal newton" for a in result.trace))
            r = result.r.ravel() * root
            worst = max(worst, natural_residual(A @ r + c, r, mu, root[:n] ** 2))
        rows.append((f"gaps {gap:g}", *outcomes.values(), most, f"{worst:.0e}"))
    return table(
        ("72 problems", "Newton alone", "with rounds", "not found", "most rounds", "residual of the solved"), rows
    )


def histories() -> str:
    """The punch from where it just touches to its full motion: pairs drift and turn before they touch."""
    A, c = punch(11, push=(0.15, 0.0), turn=0.15)
    n, mu = len(c) // 3, 0.3
    touching = np.concatenate([c[:n] - c[:n].min(), np.zeros(2 * n)])

    def ends(count: int) -> tuple[ContactProblem, PathState]:
        problem, root = from_compliance(A, c, np.full(n, mu), facets=count)
        begin = from_compliance(A, touching, np.full(n, mu))[0].b
        return problem, initial_state(problem, begin, motion=problem.by_pair(root * touching))

    def equal(problem: ContactProblem, state: PathState, number: int) -> tuple[Array, int, int]:
        h, y = state.h, None
        for k in range(1, number + 1):
            origin = np.concatenate([np.zeros((1, n)), h[1:]])
            b = state.b + k / number * (problem.b - state.b) + problem.W @ origin.ravel() - origin.ravel()
            result = solve_contact(replace(problem, b=b), y)
            h, y = result.h + origin, result.y
        return result.r, number, number

    def stopping(problem: ContactProblem, state: PathState, **settings: float) -> tuple[Array, int, int]:
        segment = follow(problem, state, problem.b, settings=PathSettings(**settings))
        return segment.end.r, len(segment.pieces) - 1, segment.pivots

    circle = ends(0)
    exact = stopping(*circle, turn=0.003)[0]
    rows = []
    ways = [(f"{k} equal ones", circle, partial(equal, number=k)) for k in (16, 64, 256, 1024)]
    for k in (1, 4, 16, 64, 256):
        ways.append((f"to events, N = {k}", circle, partial(stopping, shortest=1 / k, turn=0.04 / k**0.5)))
    ways.append(("to every event, turning 0.03", circle, partial(stopping, turn=0.03)))
    ways += [(f"exact path, {k} facets", ends(k), stopping) for k in (8, 16, 32)]
    for words, (problem, state), way in ways:
        start = time.process_time()
        r, number, solved = way(problem, state)
        spent = time.process_time() - start
        error = np.linalg.norm((r - exact)[1:], axis=0).max() / (mu * exact[0].max())
        rows.append((words, number, solved, f"{100 * error:.2f} %", seconds(spent)))
    return table(("increments", "number", "solved", "largest nodal error / (mu p_max)", "seconds"), rows)


def plane_side(n: int, kind: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A unit square of n^2 cells, inner nodes moved at random, straight edges: nodes (k, 2) and faces."""
    line = np.linspace(0, 1, n + 1)
    x = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1)
    x[1:-1, 1:-1] += np.random.default_rng(seed).uniform(-0.3, 0.3, x[1:-1, 1:-1].shape) / n
    number = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    corners = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]) if kind in (3, 6) else quads
    a, b = facet_nodes(3, kind).T
    weights = np.column_stack([1 - a - b, a, b])
    if corners.shape[1] == 4:
        weights = np.column_stack([(1 - a) * (1 - b), (1 + a) * (1 - b), (1 + a) * (1 + b), (1 - a) * (1 + b)]) / 4
    every = np.einsum("ka,mad->mkd", weights, x.reshape(-1, 2)[corners])
    flat, index = np.unique(np.round(every.reshape(-1, 2), 12), axis=0, return_inverse=True)
    return flat, index.reshape(len(corners), kind)


def two_sides(n: int, kind: int, m: int, other: int):
    """An upper side looking down and a lower one looking up."""
    (above, upper), (below, lower) = plane_side(n, kind, 1), plane_side(m, other, 2)
    flat = np.concatenate([above, below])
    points = np.column_stack([flat, np.zeros(len(flat))])
    reverse = {3: [0, 2, 1], 4: [0, 3, 2, 1], 6: [0, 2, 1, 5, 4, 3], 8: [0, 3, 2, 1, 7, 6, 5, 4]}
    reverse[9] = [*reverse[8], 8]
    return points, Boundary.of(points, upper[:, reverse[kind]]), Boundary.of(points, lower + len(above))


def mortar() -> str:
    worst = 0.0
    for kind, other in itertools.product((3, 4, 6, 8, 9), repeat=2):
        points, one, two = two_sides(3, kind, 5, other)
        coupling = mortar_coupling(one, two)
        worst = max(worst, float(np.abs(coupling.relative @ points).max()))
    rows = []
    for n in (10, 20, 40, 80):
        _, one, two = two_sides(n, 4, 3 * n // 2, 4)
        start = time.process_time()
        mortar_coupling(one, two)
        spent = time.process_time() - start
        pieces = [side.blocks[0].plane_pieces for side in (one, two)]
        tested = len(near_pairs(*pieces, search=0.5)[0])
        rows.append((n**2, (3 * n // 2) ** 2, f"{tested / n**2:.1f}", seconds(spent), f"{1e3 * spent / n**2:.2f}"))
    head = ("nonmortar faces", "mortar faces", "pairs tested a face", "seconds", "ms a face")
    words = f"Linear fields on all 25 pairs of kinds of faces, no parallelograms: largest error {worst:.0e}."
    return f"{table(head, rows)}\n\n{words}"


def main() -> None:
    mortar_coupling(*two_sides(2, 4, 3, 4)[1:])  # compiles
    for name, measured in (
        ("punches", punches),
        ("facets", facets),
        ("hard", hard),
        ("histories", histories),
        ("mortar", mortar),
    ):
        text = measured()
        print(text, "\n")
        write(name, text, PAGE)


if __name__ == "__main__":
    main()
