# SPDX-License-Identifier: BSD-3-Clause
"""The hard set: random problems of Coulomb friction that defeat Newton and Lemke.

Real finite elements from stored seeds: blocks, skew blocks, two blocks, wedges and pegs between walls, corners, rough
and rounded punches; clamped and moved, on rollers, or floating; gaps and interferences; pressed, dragged, tilted,
pulled; friction 0 to 8; histories of up to five steps.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu
from skfem import Basis, ElementQuad1, ElementVector, MeshQuad
from skfem.models.elasticity import lame_parameters, linear_elasticity

from signorini.arrays import Array, IntArray, frozen
from signorini.friction.problem import ContactProblem

PROBLEMS = 650
"""Of the set: 400 random ones, 150 of up to 6 pairs, 100 held with friction 1.5 to 8, interleaved."""

_FAMILIES = ("block", "two blocks", "skew block", "wedge", "peg", "corner", "punch")
_FRICTION = (0.0, 0.1, 0.3, 0.6, 1.0, 1.5, 2.0, 3.0)
_SEED = 1993  # any number: the set is the same ever after
_KINDS = ("any",) * 8 + ("small",) * 3 + ("critical",) * 2  # in turn: 400, 150 and 100 of 650


@dataclass(frozen=True, kw_only=True)
class HardProblem:
    """A history of loads on one interface, in the scaled units of `ContactProblem`.

    Attributes
    ----------
    name : family, support, load, gap, pairs, friction
    first : the first step
    gap : (n,) initial gap
    loads : motion of the pairs (2n) under the loads of each step
    """

    name: str
    first: ContactProblem
    gap: Array
    loads: tuple[Array, ...]

    def step(self, k: int, slipped: Array) -> ContactProblem:
        """The problem of step k, given the tangential displacement (n,) reached before."""
        start = np.concatenate([self.gap, -slipped])
        load = self.loads[k]
        return ContactProblem(
            image=self.first.image,
            b=load + start - self.first.W @ start,
            friction=self.first.friction,
            scale=float(max(np.abs(load).max(), np.abs(start).max())),
        )


def hard_problem(number: int) -> HardProblem:
    """One of the set, by its number from 0."""
    return _problem(np.random.default_rng([_SEED, number]), _KINDS[number % len(_KINDS)])


@dataclass(frozen=True, kw_only=True)
class _Draw:
    """The random choices of one problem."""

    rng: np.random.Generator
    family: str
    friction: float
    small: bool
    support: str
    load: str
    gap: str
    steps: int


def _problem(rng: np.random.Generator, kind: str) -> HardProblem:
    while True:
        draw = _draw(rng, kind)
        made = _assemble(draw)
        if made is not None and (kind != "small" or made.first.pairs <= 6):
            return made


def _draw(rng: np.random.Generator, kind: str) -> _Draw:
    critical = kind == "critical"
    support = (
        "floating"
        if rng.random() < 0.5 and not critical
        else str(rng.choice(["clamped", "roller and pin", "roller"], p=[0.7, 0.15, 0.15]))
    )
    return _Draw(
        rng=rng,
        family=str(rng.choice(_FAMILIES[:3] if critical else _FAMILIES)),
        friction=float(rng.uniform(1.5, 8.0) if critical else rng.choice(_FRICTION)),
        small=kind == "small" or (critical and rng.random() < 0.5),
        support=support,
        load=str(rng.choice(["press", "drag", "tilt", "pull", "mixed"], p=[0.25, 0.25, 0.2, 0.15, 0.15])),
        gap=str(rng.choice(["none", "gap", "fit", "rough", "parabola"], p=[0.25, 0.15, 0.25, 0.2, 0.15])),
        steps=1 if rng.random() < 0.5 else int(rng.integers(2, 6)),
    )


@dataclass(frozen=True, kw_only=True)
class _Block:
    """Stiffness, nodes (2, N), nodes of each side in order, and dofs (2, N) of a meshed quadrilateral."""

    K: sparse.csr_matrix
    x: Array
    sides: Mapping[str, IntArray]
    dofs: IntArray


def _block(nx: int, ny: int, corners: Array, E: float, nu: float) -> _Block:
    """nx times ny bilinear quadrilaterals; corners (4, 2): lower left, lower right, upper right, upper left."""
    square = MeshQuad.init_tensor(np.linspace(0, 1, nx + 1), np.linspace(0, 1, ny + 1))
    s, t = square.p
    x = corners.T @ np.stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
    basis = Basis(MeshQuad(x, square.t), ElementVector(ElementQuad1()))
    edges = {"bottom": t, "top": 1 - t, "left": s, "right": 1 - s}
    on = {name: np.flatnonzero(far < 1e-9) for name, far in edges.items()}
    sides = {name: nodes[np.argsort((s + t)[nodes])] for name, nodes in on.items()}
    K = linear_elasticity(*lame_parameters(E, nu)).assemble(basis).tocsr()
    return _Block(K=K, x=x, sides=sides, dofs=basis.nodal_dofs)


def _assemble(draw: _Draw) -> HardProblem | None:
    """Mesh, supports, pairs, condensation, loads; None where every pair would sit on a support."""
    body, slope = _body(draw)
    top, N = body.sides["top"], body.x.shape[1]
    held = {
        "floating": np.zeros(0, dtype=np.int64),
        "clamped": body.dofs[:, top].ravel(),
        "roller": body.dofs[1, top],
        "roller and pin": np.append(body.dofs[1, top], body.dofs[0, top[0]]),
    }[draw.support]
    nodes, normals, weight = _pairs(draw, body, held, slope)
    n = len(nodes)
    if n == 0:
        return None
    B = _jumps(body.dofs[:, nodes], normals, 2 * N)
    rigid = B @ _rigid_motions(body, held)
    K, fixed = body.K, held
    if draw.family == "two blocks":
        E, corners = 10.0 ** draw.rng.uniform(-3, 3), _corners_below(body.x[:, nodes], draw.rng)
        other = _block(max(1, n - 1), int(draw.rng.integers(1, 6)), corners, E, 0.3)
        lower = _jumps(other.dofs[:, other.sides["top"][:n]], normals, other.K.shape[0])
        K = sparse.csr_matrix(sparse.block_diag([K, other.K]))
        B = sparse.csr_matrix(sparse.hstack([B, -lower]))
        fixed = np.concatenate([held, 2 * N + other.dofs[:, other.sides["bottom"]].ravel()])
    root = np.tile(np.sqrt(weight * np.sqrt(n)), 2)
    free = np.setdiff1d(np.arange(K.shape[0]), fixed)
    Bs = sparse.csr_matrix(sparse.diags(root) @ B)
    lu = splu((K + Bs.T @ Bs).tocsc()[free][:, free], permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01)
    W = Bs[:, free] @ lu.solve(Bs[:, free].T.toarray())
    size = float(10.0 ** draw.rng.uniform(-3, -1))
    rest = (0, K.shape[0] - 2 * N)
    sides = [(np.pad(f, rest) - K @ np.pad(u, rest))[free] for f, u in _history(draw, body, size)]
    loads = tuple(frozen(Bs[:, free] @ lu.solve(side)) for side in sides)
    return HardProblem(
        name=f"{draw.family}, {draw.support}, {draw.load}, {draw.gap}, {n} pairs, friction {draw.friction:.3g}",
        first=ContactProblem.of(
            W=(W + W.T) / 2,
            b=loads[0],
            friction=np.full(n, draw.friction),
            motions=root[:, None] * rigid,
            scale=size,
        ),
        gap=frozen(root[:n] * _gap(draw, n, size)),
        loads=loads,
    )


def _body(draw: _Draw) -> tuple[_Block, float]:
    """The upper body, and the slope of its left and right sides."""
    rng = draw.rng
    nx = int(rng.integers(1, 4)) if draw.small else int(np.exp(rng.uniform(np.log(4), np.log(149))))
    ny = int(rng.integers(1, 3)) if draw.small else int(rng.integers(2, 9))
    height = float(np.exp(rng.uniform(np.log(0.3), np.log(2.0))))
    slope, lean = 0.0, 0.0
    if draw.family in ("wedge", "peg"):
        nx, ny = (nx, ny) if draw.small else (ny, max(2, nx // 2))
        slope = np.tan(np.deg2rad(rng.choice([2, 5, 10, 20, 35, 50]))) if draw.family == "wedge" else 0.0
    if draw.family == "skew block":
        lean = rng.choice([-1.5, -0.7, 0.7, 1.5, 2.5]) * height
    flare = slope * height
    corners = np.array([(0, 0), (1, 0), (1 + lean + flare, height), (lean - flare, height)], dtype=np.float64)
    return _block(nx, ny, corners, 1.0, float(rng.choice([0.0, 0.2, 0.3, 0.45]))), slope


def _pairs(draw: _Draw, body: _Block, held: IntArray, slope: float) -> tuple[IntArray, Array, Array]:
    """Nodes with a pair, normals (n, 2) into the body, tributary lengths; one pair a node, none on a support."""
    where = {"wedge": ["left", "right"], "peg": ["left", "right"], "corner": ["bottom", "left"]}.get(
        draw.family, ["bottom"]
    )
    if draw.family == "peg" and draw.rng.random() < 0.3:
        where.append("bottom")
    direction = {"bottom": (0.0, 1.0), "left": (1.0, slope), "right": (-1.0, slope)}
    used = np.isin(body.dofs[0], held) | np.isin(body.dofs[1], held)
    nodes, normals, weight = [], [], []
    for side in where:
        length = np.linalg.norm(np.diff(body.x[:, body.sides[side]]), axis=0) / 2
        share = np.append(length, 0.0) + np.append(0.0, length)
        new = ~used[body.sides[side]]
        nodes.append(body.sides[side][new])
        weight.append(share[new])
        normals.append(np.tile(np.array(direction[side]) / np.hypot(*direction[side]), (int(new.sum()), 1)))
        used[nodes[-1]] = True
    return np.concatenate(nodes), np.concatenate(normals), np.concatenate(weight)


def _jumps(dofs: IntArray, normals: Array, size: int) -> sparse.csr_matrix:
    """(2n, size) normal, then tangential displacements of nodes with dofs (2, n)."""
    n = len(normals)
    tangents = np.stack([normals[:, 1], -normals[:, 0]], axis=1)
    rows = np.tile(np.arange(2 * n), 2)
    columns = np.concatenate([dofs[0], dofs[0], dofs[1], dofs[1]])
    values = np.concatenate([normals[:, 0], tangents[:, 0], normals[:, 1], tangents[:, 1]])
    return sparse.csr_matrix((values, (rows, columns)), shape=(2 * n, size))


def _corners_below(x: Array, rng: np.random.Generator) -> Array:
    """Corners of a block under nodes x (2, n) on a horizontal line."""
    left, right, deep = x[0].min(), max(x[0].max(), x[0].min() + 0.1), rng.uniform(0.3, 1.5)
    return np.array([(left, -deep), (right, -deep), (right, 0.0), (left, 0.0)])


def _rigid_motions(body: _Block, held: IntArray) -> Array:
    """(2N, k) rigid motions that no support stops."""
    x, y = body.x - body.x.mean(axis=1, keepdims=True)
    motions = np.zeros((body.dofs.size, 3))
    motions[body.dofs[0], 0] = motions[body.dofs[1], 1] = 1.0
    motions[body.dofs[0], 2], motions[body.dofs[1], 2] = -y, x
    if not len(held):
        return motions
    _, values, rows = np.linalg.svd(motions[held])
    return np.asarray(motions @ rows[np.count_nonzero(values > 1e-9) :].T, dtype=np.float64)


def _history(draw: _Draw, body: _Block, size: float) -> Iterator[tuple[Array, Array]]:
    """Forces and prescribed displacements (2N each) of every step: turned, reversed, unloaded at random."""
    rng, N, top = draw.rng, body.x.shape[1], body.sides["top"]
    drive = {
        "press": np.array([0.1, -1.0, 0.0]),
        "drag": np.array([rng.choice([-1, 1]) * rng.uniform(0.2, 2.5), -1.0, 0.0]),
        "tilt": np.array([0.2, -1.0, rng.normal()]),
        "pull": np.array([rng.normal() * 0.3, 1.0, 0.1]),
        "mixed": rng.normal(size=3),
    }[draw.load]
    across = np.linspace(-1.0, 1.0, len(top))
    for step in range(draw.steps):
        if step:
            drive = drive * rng.choice([-1.0, 0.5, 1.0, 1.5], size=3) + rng.normal(size=3) * 0.4
            if draw.support != "clamped" and rng.random() < 0.7:
                drive[1] = -abs(drive[1]) - 0.3
        f, u = np.zeros(2 * N), np.zeros(2 * N)
        if draw.support == "clamped":
            u[body.dofs[0, top]], u[body.dofs[1, top]] = size * drive[0], size * (drive[1] + drive[2] * across)
            f[body.dofs[0]] = size * rng.normal() * 0.05 / N
        else:
            f[body.dofs[0]] = size * drive[0] * 0.5 / N
            f[body.dofs[1]] = size * drive[1] * 0.5 / N
            f[body.dofs[0, top]] += size * drive[0] * 0.5 / len(top)
            f[body.dofs[1, top]] += size * (0.5 * drive[1] + 0.6 * drive[2] * across) / len(top)
        yield f, u


def _gap(draw: _Draw, n: int, size: float) -> Array:
    rng, x = draw.rng, np.linspace(-1.0, 1.0, n)
    shapes = {
        "none": np.zeros(n),
        "gap": np.full(n, 0.3),
        "fit": np.full(n, -0.4 * rng.random()),
        "rough": rng.normal(size=n) * 0.3,
        "parabola": 1.5 * x**2 - (0.2 if rng.random() < 0.5 else 0.0),
    }
    shape = shapes["parabola" if draw.family == "punch" else draw.gap]
    ties = draw.gap == "none" and draw.family in ("wedge", "peg", "corner") and rng.random() < 0.5
    return np.asarray(size * (shape + ties * 1e-3 * rng.normal(size=n)), dtype=np.float64)
