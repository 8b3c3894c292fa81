# SPDX-License-Identifier: BSD-3-Clause
"""Random small models, solved by the package and looked at by an adversary that shares no line with it.

    python -m benchmarks.adversary                        # 200 models, all kinds
    python -m benchmarks.adversary 5000 --seed 17         # thousands, any seed
    python -m benchmarks.adversary 500 --kinds rigid thin # those with rigid or thin bodies
    python -m benchmarks.adversary --only 4711            # one model, with all its numbers

Stacks of one to three bodies in the plane and in space, on a rigid floor or held, pressed, sheared, lifted off and
pressed again by forces or by motions, with gaps, ties, rigid and thin bodies, in any units, cut in two and gone on
with. Every answer is put into the equations of `independent`: equilibrium and the law of contact, row by row, to
1e-8. Where the package proves that there is no equilibrium, or finds none, all states are tried in the plane, and many
starts in space; where they find one, that is a failure.

Outcomes: "right"; "proved", no equilibrium, and the adversary finds none either; "not found", nor by the adversary;
"jump"; "refused", before solving; failures are in capitals.
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

import signorini as sg
from benchmarks import independent
from benchmarks.random_search import Verdict, parser, search

KINDS = ("space", "rigid", "tied", "stack", "thin", "units", "restart", "exact", "driven", "floor")
TOLERANCE = 1e-8


@dataclass(kw_only=True)
class Case:
    """A random model, and the same in the words of the adversary.

    Attributes
    ----------
    kinds : what was mixed in
    model : of all steps
    factors : (steps, 2) of what presses and of what shears
    structure : its finite elements
    unit : forces and motions for a factor of 1 of pressing, of shearing: force (N, d), moved (N, d), loads
    """

    seed: int
    kinds: frozenset[str]
    model: sg.Model
    factors: np.ndarray
    structure: independent.Structure
    unit: list[tuple[np.ndarray, np.ndarray, list[np.ndarray]]]


def grid(d: int, xs: np.ndarray, ys: np.ndarray, heights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points and cells of a box, numbered as the package does: x fastest in the plane, the height in space."""
    order: Literal["F", "C"] = "F" if d == 2 else "C"
    sides = [xs, heights] if d == 2 else [xs, ys, heights]
    counts = [len(side) for side in sides]
    mesh = np.meshgrid(*sides, indexing="ij")
    points = np.column_stack([part.ravel(order=order) for part in mesh])
    number = np.arange(len(points)).reshape(counts, order=order)
    if d == 2:
        cells = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
        return points, cells.reshape(-1, 4)
    low = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]
    cells = np.stack([part[..., k] for k in (slice(None, -1), slice(1, None)) for part in low], axis=-1)
    return points, cells.reshape(-1, 8)


@dataclass(frozen=True, kw_only=True)
class Stack:
    """Boxes on one another, node on node, numbered as the package joins them.

    Attributes
    ----------
    meshes : points and cells of every body
    heights : of the grid lines of every body
    """

    d: int
    length: float
    names: str
    sides: dict[str, np.ndarray]
    heights: list[np.ndarray]
    meshes: list[tuple[np.ndarray, np.ndarray]]

    @staticmethod
    def of(d: int, length: float, xs: np.ndarray, ys: np.ndarray, thick: list[float], layers: list[int]) -> Stack:
        """Bodies as thick as asked, of so many layers of cells."""
        bottom = np.append(0.0, np.cumsum(thick))
        heights = [np.linspace(low, high, n + 1) for low, high, n in zip(bottom, bottom[1:], layers, strict=False)]
        return Stack(
            d=d, length=length, names="abc"[: len(thick)], sides={"x": xs} if d == 2 else {"x": xs, "y": ys},
            heights=heights, meshes=[grid(d, xs, ys, lines) for lines in heights],
        )  # fmt: skip

    @property
    def points(self) -> np.ndarray:
        return np.vstack([points for points, _ in self.meshes])

    @property
    def offsets(self) -> np.ndarray:
        """The first node of every body, and the number of all."""
        return np.append(0, np.cumsum([len(points) for points, _ in self.meshes]))

    def mesh(self) -> Any:
        """The same for the package."""
        build, up = (sg.rectangle, "y") if self.d == 2 else (sg.box, "z")
        boxes = {name: build(**self.sides, **{up: lines}) for name, lines in zip(self.names, self.heights, strict=True)}
        return sg.join(boxes) if len(boxes) > 1 else boxes["a"]

    def side(self, body: int, which: Literal["bottom", "top"]) -> str:
        """What the package calls a side."""
        return f"{self.names[body]}.{which}" if len(self.names) > 1 else which

    def nodes(self, body: int, which: Literal["bottom", "top"]) -> np.ndarray:
        """Those of a side."""
        height = self.heights[body][0 if which == "bottom" else -1]
        on = np.isclose(self.meshes[body][0][:, -1], height, rtol=0, atol=1e-12 * self.length)
        return self.offsets[body] + np.flatnonzero(on)

    def tributary(self, body: int) -> np.ndarray:
        """(N,) length or area of the top of a body that belongs to every node: half the edges beside it."""
        shares, over = np.zeros(len(self.points)), self.nodes(body, "top")
        for node in over:
            shares[node] = 1.0
            for x, axis in zip(self.points[node], self.sides.values(), strict=False):
                k = int(np.searchsorted(axis, x))
                shares[node] *= 0.5 * (axis[min(k + 1, len(axis) - 1)] - axis[max(k - 1, 0)])
        return shares


def interfaces(
    stack: Stack, first: int, gaps: float, ties: bool, rng: np.random.Generator
) -> tuple[list[sg.Contact], independent.Pairs]:
    """Contacts from a body on, that below the first one on the floor: gaps up to half a size, ties where asked."""
    contacts, columns = [], []
    ground = sg.Plane((0.0,) * stack.d, (0.0,) * (stack.d - 1) + (1.0,))
    for k in range(first, len(stack.names)):
        mu: Any = "tied" if ties and k > 0 and rng.random() < 0.6 else "stick" if rng.random() < 0.1 else None
        if mu is None:
            mu = round(float(rng.choice([0.0, rng.uniform(0.05, 1)], p=[0.1, 0.9])), 3)
        gap = 0.0 if rng.random() < 0.6 else float(gaps * rng.uniform(-0.2, 0.5))
        below = ground if k == 0 else stack.side(k - 1, "top")
        contacts.append(sg.Contact(stack.side(k, "bottom"), below, friction=mu, gap=gap, name=f"c{k}"))
        upper = stack.nodes(k, "bottom")
        lower = np.full(len(upper), -1) if k == 0 else stack.nodes(k - 1, "top")
        every = np.ones(len(upper))
        columns.append(
            (upper, lower, gap * every, every * (np.inf if isinstance(mu, str) else mu), every * (mu == "tied"))
        )
    upper, lower, gap, friction, tied = (np.concatenate(column) for column in zip(*columns, strict=True))
    return contacts, independent.Pairs(upper=upper, lower=lower, gap=gap, friction=friction, tied=tied > 0)


def make(seed: int, wanted: frozenset[str] = frozenset()) -> Case:
    """The model of a seed; the same seed makes the same one."""
    rng = np.random.default_rng(seed)
    kinds = {kind for kind in KINDS if rng.random() < (0.25 if kind in ("space", "rigid", "tied", "thin") else 0.5)}
    kinds |= wanted
    d = 3 if "space" in kinds else 2
    bodies = int(rng.integers(2, 4)) if "stack" in kinds else 1 + (rng.random() < 0.5)
    floor = "floor" in kinds or bodies == 1
    length, modulus = 10.0 ** rng.uniform(-9, 9, 2) if "units" in kinds else np.ones(2)
    most = 6 // (bodies if floor else bodies - 1) if d == 2 else 3
    xs = length * np.sort(np.append([0.0, 1.0], rng.uniform(0.2, 0.8, int(rng.integers(0, max(most - 1, 1))))))
    ys = length * np.linspace(0, 0.8, int(rng.integers(2, 4)))
    thin = [rng.random() < 0.5 and "thin" in kinds for _ in range(bodies)]
    thick = [length * (0.01 if flat else rng.uniform(0.3, 1.2)) for flat in thin]
    stack = Stack.of(d, length, xs, ys, thick, [1 if flat else int(rng.integers(1, 3)) for flat in thin])
    moduli = modulus * 10.0 ** rng.uniform(-1, 1, bodies)
    nu, kind = rng.uniform(0.0, 0.4), "3d" if d == 3 else str(rng.choice(["plane strain", "plane stress"]))
    rigid = int(rng.integers(1, bodies)) if "rigid" in kinds and bodies > 1 else None
    strain = 10.0 ** rng.uniform(-4, -2)
    contacts, pairs = interfaces(stack, 0 if floor else 1, strain * length, "tied" in kinds, rng)
    points = stack.points
    held, supports = np.zeros(points.shape, bool), []
    if not floor:
        held[stack.nodes(0, "bottom")] = True
        supports.append(sg.Support(stack.side(0, "bottom"), u=(0.0,) * d, name="base"))
    groups, loads, rigid_bodies, unit = [], [], [], []
    if rigid is not None:
        about = np.append(np.full(d - 1, 0.45 * length), stack.heights[rigid][[0, -1]].mean())
        groups.append((np.arange(*stack.offsets[rigid : rigid + 2]), about))
        rigid_bodies.append(sg.RigidBody("R", stack.names[rigid], tuple(about)))
    turns, top, zero = 1 if d == 2 else 3, bodies - 1, np.zeros_like(points)
    shear = np.append(rng.normal(size=d - 1), 0.0)
    for name, way in (("press", -np.eye(d)[-1]), ("shear", shear / np.linalg.norm(shear))):
        force, moved, on_rigid = zero.copy(), zero.copy(), [np.zeros(d + turns) for _ in groups]
        if "driven" in kinds and rigid != top:
            held[stack.nodes(top, "top")] = True
            moved[stack.nodes(top, "top")] = strain * length * way
            given = [None if (name == "press") is (k < d - 1) else float(strain * length * way[k]) for k in range(d)]
            supports.append(sg.Support(stack.side(top, "top"), u=tuple(given), name=name))
        elif rigid == top:
            on_rigid = [np.append(modulus * strain * length ** (d - 1) * way, np.zeros(turns))]
            loads.append(sg.Load("R", force=tuple(on_rigid[0]), name=name))
        else:
            force = modulus * strain * stack.tributary(top)[:, None] * way
            loads.append(sg.Load(stack.side(top, "top"), traction=tuple(modulus * strain * way), name=name))
        unit.append((force, moved, on_rigid))
    count = int(rng.integers(2, 6))
    press = rng.choice([1.0, 0.5, 1.5, 0.2, -0.3], count, p=[0.35, 0.25, 0.15, 0.1, 0.15])
    factors = np.column_stack([press, rng.uniform(-1, 1, count) * rng.choice([0.1, 0.4, 1.0])])
    factors[0, 0] = 1.0
    parts: dict[str, Any] = {} if "exact" in kinds and d == 2 else {"increments": 1}
    mesh, connected = stack.mesh(), zip(stack.offsets, stack.meshes, moduli, strict=False)
    model = sg.Model(
        mesh,
        kind=kind,
        bodies=[sg.Body(name, sg.Elastic(E=E, nu=nu)) for name, E in zip(mesh.bodies, moduli, strict=True)],
        supports=supports,
        loads=loads,
        rigid_bodies=rigid_bodies,
        contacts=contacts,
        steps=[sg.Step(scale={"press": float(a), "shear": float(b)}, at="events", **parts) for a, b in factors],
    )
    K = independent.stiffness(
        points, [(n + cells, independent.elasticity(E, nu, kind)) for n, (_, cells), E in connected]
    )
    structure = independent.Structure(points=points, K=K, held=held, pairs=pairs, rigid=groups)
    is_what = frozenset(kinds - ({"rigid"} if rigid is None else set()))
    return Case(seed=seed, kinds=is_what, model=model, factors=factors, structure=structure, unit=unit)


def increment(case: Case, factors: tuple[float, float], before: np.ndarray) -> independent.Increment:
    """What acts at factors of pressing and of shearing."""
    (press, shear), (a, b) = case.unit, factors
    return independent.Increment(
        force=a * press[0] + b * shear[0],
        moved=a * press[1] + b * shear[1],
        loads=[a * one + b * two for one, two in zip(press[2], shear[2], strict=True)],
        before=case.structure.relative(before),
    )


def judge(case: Case) -> Verdict:
    """Solve, whole and where asked in two parts, and look at every increment, on exact paths at every event."""
    model, structure = case.model, case.structure
    assert np.allclose(model.mesh.points, structure.points, rtol=0, atol=1e-9 * np.abs(structure.points).max())
    try:
        history = sg.solve(model, raise_on_failure=False)
    except sg.InputError as error:
        return _refused(case, str(error))
    except Exception as error:  # whatever a solver may do is told, not raised
        return Verdict(outcome="ERROR", words=f"{type(error).__name__}: {str(error)[:300]}")
    before, worst, energy, length = np.zeros_like(structure.points), 0.0, 1e-300, 0.0
    for k, step in enumerate(history.steps):
        for instant in step.instants:
            if instant.displacement is None and not step.finished:
                break  # the bodies were not looked at
            wrong, size = _at(case, instant, before, length)
            if not size <= TOLERANCE:
                where = f"step {k + 1} at {instant.load_factor - k:.4%}, {instant.what}"
                return Verdict(outcome="WRONG", words=f"{where}: {wrong} {size:.1e}, {step.path} {step.methods}")
            worst, before = max(worst, size), instant.displacement
            length = max(length, float(np.abs(before).max()))
        energy = max(energy, abs(step.work), step.strain_energy, step.dissipation, step.released)
        if step.path == "exact" and abs(step.energy_defect) > TOLERANCE * energy:
            return Verdict(outcome="WRONG", words=f"step {k + 1}: energy defect {step.energy_defect / energy:.1e}")
    if "restart" in case.kinds and len(history.steps) > 1:
        parted = _gone_on(case, history)
        if parted:
            return Verdict(outcome="RESTART", words=parted)
    if history.status == "solved":
        return Verdict(outcome="right", words=f"{worst:.1e}", worst=worst)
    return _without_answer(case, history, sum(step.finished for step in history.steps), before)


def _at(case: Case, instant: Any, before: np.ndarray, length: float) -> tuple[str, float]:
    """What is most wrong at a load, and how much: between two events a path is an increment."""
    if instant.what == "approach":
        return "the approach", independent.carried(case.structure, before, instant.displacement)
    acts = increment(case, (instant.factors["press"], instant.factors["shear"]), before)
    gradual = instant.what != "landing"
    found = independent.violations(case.structure, acts, instant.displacement, incremental=gradual, length=length)
    name = max(found, key=lambda key: found[key])
    return name, found[name]


def _refused(case: Case, words: str) -> Verdict:
    """A model that is no model: something moves freely though all pairs touch."""
    return Verdict(outcome="refused" if independent.floats(case.structure) else "REFUSED", words=words[:300])


def _without_answer(case: Case, history: Any, done: int, before: np.ndarray) -> Verdict:
    """Where the package found no equilibrium, the adversary looks for one."""
    words = f"step {done + 1}: {history.message[:300]}"
    if history.status == "jump":  # an equilibrium at the end of the step says nothing of the way there
        return Verdict(outcome="jump", words=words)
    acts, rng = increment(case, case.factors[done], before), np.random.default_rng(case.seed)
    loose = int((~case.structure.pairs.tied).sum())
    if case.structure.d == 2 and loose <= 6:
        exists = bool(independent.equilibria(case.structure, acts))
    else:
        exists = independent.searched(case.structure, acts, rng) is not None
    if history.status == "no_equilibrium":
        return Verdict(outcome="FALSE PROOF" if exists else "proved", words=words)
    return Verdict(outcome="MISSED" if exists else history.status.replace("_", " "), words=words)


def _gone_on(case: Case, whole: Any) -> str:
    """Cut behind a step and gone on with through a file: what differs in any bit, or nothing."""
    finished = [step for step in whole.steps if step.finished]
    cut = int(np.random.default_rng(case.seed).integers(1, len(finished) + 1))
    if cut == len(case.model.steps):
        return ""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "state.npz"
        first = sg.solve(replace(case.model, steps=case.model.steps[:cut]))
        first.save_state(path)
        after = sg.solve(replace(case.model, steps=case.model.steps[cut:]), start=path, raise_on_failure=False)
    if after.status != whole.status:
        return f"cut behind step {cut}: {after.status}, the whole {whole.status}: {after.message[:200]}"
    for k, (one, two) in enumerate(zip(whole.steps[cut:], after.steps, strict=False)):
        gone = np.abs(one.displacement - two.displacement).max() / max(np.abs(one.displacement).max(), 1e-300)
        if gone:
            return f"cut behind step {cut}: displacements of step {cut + k + 1} differ by {gone:.1e}"
        if [one.work, one.strain_energy, one.dissipation] != [two.work, two.strain_energy, two.dissipation]:
            return f"cut behind step {cut}: energies of step {cut + k + 1} differ"
    return ""


def judged(seed: int, wanted: frozenset[str]) -> tuple[frozenset[str], Verdict]:
    """The kinds and the verdict of the model of a seed."""
    case = make(seed, wanted)
    return case.kinds, judge(case)


def main() -> None:
    search(parser(__doc__, KINDS, 200).parse_args(), KINDS, judged, "adversary")


if __name__ == "__main__":
    main()
