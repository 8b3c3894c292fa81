# SPDX-License-Identifier: BSD-3-Clause
"""Random small models with bodies that yield, beside elements, a flow rule and a solver that share no line with it.

    python -m benchmarks.plastic_histories                          # 100 models, all kinds
    python -m benchmarks.plastic_histories 1000 --seed 17           # any number, any seed
    python -m benchmarks.plastic_histories 100 --kinds space mortar # those in space, of meshes that do not match
    python -m benchmarks.plastic_histories --only 4711              # one model, with all its numbers
    python -m benchmarks.plastic_histories 20 --solve               # the slow solver beside every increment too

One elastoplastic block on a rigid plane, or two on one another, pressed, dragged, released and reversed in 1 to 5
increments a stretch, up to 1.08 of what the block bears. Displacements of every instant are put into the equations
of `independent_plastic`: equilibrium with stresses that its own flow rule makes of them, and the law of contact, row by
row, to 1e-7 of the largest force and motion; plastic strains agree to as much. Where the package names collapse, its
mechanism must take less work than the loads do; where it finds no equilibrium, the slow solver looks for one.

Outcomes: "right"; "collapse", its mechanism takes less than the loads do; "named", said to have no equilibrium, and the
slow solver finds none either; "jump"; failures are in capitals.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import signorini as sg
from benchmarks import independent_plastic as own
from benchmarks.random_search import Verdict, parser, search
from signorini.engine.prepare import prepare

KINDS = (
    "plane strain",
    "plane stress",
    "axisymmetric",
    "space",
    "two",
    "mortar",
    "curved",
    "quad8",
    "triangle6",
    "perfect",
    "table",
    "prager",
    "frederick",
    "driven",
)
GEOMETRIES, LAWS = KINDS[:4], ("perfect", "table", "prager", "frederick")
TOLERANCE = 1e-7
AGREED = 1e-6  # of the largest displacement
E, NU = 200.0, 0.3


@dataclass(kw_only=True)
class Case:
    """A random model, and the same in the words of the adversary.

    Attributes
    ----------
    kinds : what was mixed in
    structure : bodies and pairs
    unit : forces and prescribed displacements (dofs,) for a factor of 1, by name of the load
    drag : whether friction alone holds the block along the contact
    """

    seed: int
    kinds: frozenset[str]
    model: sg.Model
    structure: own.Structure
    unit: dict[str, tuple[np.ndarray, np.ndarray]]
    friction: float
    drag: bool


def chosen(rng: np.random.Generator, wanted: frozenset[str]) -> frozenset[str]:
    """What a model is made of: one geometry, one law, one family, and some more."""

    def one_of(names: tuple[str, ...], odds: tuple[float, ...]) -> str:
        name = str(rng.choice(names, p=odds))
        return next((asked for asked in names if asked in wanted), name)

    geometry = one_of(GEOMETRIES, (0.4, 0.25, 0.15, 0.2))
    law = one_of(LAWS, (0.3, 0.3, 0.2, 0.2))
    family = one_of(("quad", "quad8", "triangle6"), (0.5, 0.25, 0.25))
    found = {geometry, law} | {kind for kind in ("two", "mortar", "curved", "driven") if rng.random() < 0.5}
    found |= wanted
    if geometry != "space" and not (geometry == "axisymmetric" and family == "triangle6"):
        found.add(family)
    if "mortar" in found:
        found.add("two")
    if "two" not in found or geometry == "space":
        found.discard("curved")
    return frozenset(found & set(KINDS))


def plastic(rng: np.random.Generator, law: str, yields: float) -> sg.Plastic:
    """A random law with a yield stress."""
    H = float(rng.choice([1e-3, 1e-2, 0.1])) * E
    if law == "table":
        rows = [(0.0, yields), (2e-3, yields + 2e-3 * H), (1e-2, yields + 5e-3 * H)]
        return sg.Plastic(rows, hardening=0.2 * H)
    if law == "prager":
        return sg.Plastic(yields, backstresses=[(H, 0.0)])
    if law == "frederick":
        return sg.Plastic(yields, hardening=0.05 * H, backstresses=[(H, 3.0 * H / yields), (0.1 * H, 0.0)])
    return sg.Plastic(yields)


def block(rng: np.random.Generator, kinds: frozenset[str], wide: float, columns: int, low: float) -> sg.Mesh:
    """A box of height 1 from ``low`` up; from the axis on where it is a disc."""
    rows = int(rng.integers(2, 4))
    if "space" in kinds:
        line = np.linspace(-wide / 2, wide / 2, columns + 1)
        return sg.box(x=line, y=line, z=np.linspace(low, low + 1.0, rows + 1))
    begin = 0.0 if "axisymmetric" in kinds else -wide / 2
    end = wide / 2
    family = next((kind for kind in ("quad8", "triangle6") if kind in kinds), "quad")
    count = columns if family == "quad" else max(2, columns // 2)
    lines = {"x": np.linspace(begin, end, count + 1), "y": np.linspace(low, low + 1.0, rows + 1)}
    mesh: sg.Mesh = sg.rectangle(cells=family, **lines)
    return mesh


def make(seed: int, wanted: frozenset[str] = frozenset()) -> Case:
    """The model of a seed; the same seed makes the same one."""
    rng = np.random.default_rng(seed)
    kinds = chosen(rng, wanted)
    geometry = next(kind for kind in GEOMETRIES if kind in kinds)
    d, two = 3 if geometry == "space" else 2, "two" in kinds
    columns = int(rng.integers(2, 4 if d == 3 else 7))
    upper = block(rng, kinds, 2.0, columns, 0.0)
    if "curved" in kinds:
        at = np.array(upper.points)
        at[:, 1] += at[:, 0] ** 2 / (2 * rng.uniform(5, 40)) * (1 - at[:, 1])
        upper = replace(upper, points=at)
    parts = {"upper": upper}
    if two:
        wide, other = (3.0, int(rng.integers(2, 4 if d == 3 else 7))) if "mortar" in kinds else (2.0, columns)
        parts["lower"] = block(rng, kinds, wide, other, -1.0)
    mesh = sg.join(parts) if two else upper
    names = list(mesh.bodies)
    side = {name: f"{name}." if two else "" for name in names}
    top = f"{side[names[0]]}top"
    friction = float(rng.choice([0.0, 0.1, 0.3, 0.6, 1.0]))
    drags = friction > 0 and geometry != "axisymmetric"
    level = rng.uniform(0.8, 1.08)
    law = next(kind for kind in LAWS if kind in kinds)
    strength = 1.155 if geometry == "plane strain" else 1.0
    Y = 1.0 / level / strength  # a mean pressure of 1 is `level` of what the block bears
    area = {2: 2.0, 3: 4.0}[d] * (np.pi / 2 if geometry == "axisymmetric" else 1.0)
    thickness = float(rng.choice([1.0, 0.3])) if geometry in GEOMETRIES[:2] else 1.0
    elastic = sg.Elastic(E=E, nu=NU, plastic=plastic(rng, law, Y))
    stiff = float(rng.choice([70.0, 200.0, 600.0]))
    soft = sg.Elastic(E=stiff, nu=NU, plastic=plastic(rng, law, Y) if rng.random() < 0.5 else None)
    bodies = [sg.Body(names[0], elastic)] + [sg.Body(name, soft) for name in names[1:]]
    supports = [sg.Support("lower.bottom", u=(0.0,) * d)] if two else []
    ring = geometry == "axisymmetric"
    supports += [sg.Support(f"{side[name]}left", u=(0.0, None)) for name in names] if ring else []
    push, loads = np.zeros(len(mesh.points) * d), []
    on_top = mesh.nodes_of(top)
    drag = rng.uniform(-0.9, 0.9) * friction * (0.5 if friction > 0.5 else 0.95) if drags else 0.0
    unit: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    held: set[int] = set()
    zero = np.zeros_like(push)
    groups: list[np.ndarray] = []

    def rows(direction: int) -> np.ndarray:
        found: np.ndarray = d * on_top + direction
        return found

    def driven(name: str, direction: int, value: float) -> None:
        given = [None] * d
        given[direction] = value
        supports.append(sg.Support(top, u=tuple(given), name=name))
        moved = zero.copy()
        moved[rows(direction)] = value
        unit[name] = (zero, moved)
        held.update(rows(direction).tolist())

    def pushed(name: str, direction: int, value: float) -> None:
        given = [None] * d
        given[direction] = value
        loads.append(sg.Load(top, force=tuple(given), spread="displacement", name=name))
        force = zero.copy()
        force[rows(direction)[0]] = value
        unit[name] = (force, zero)
        groups.append(rows(direction))

    act = driven if "driven" in kinds else pushed
    strain = 2.0 * len(names) * Y / E
    act("press", d - 1, -strain if "driven" in kinds else -area * thickness)
    if drags:
        act("drag", 0, strain if "driven" in kinds else area * thickness)
    fixed = [k for k in range(d - 1) if not (drags and k == 0) and not (ring and k == 0)]
    if fixed:
        still = [0.0 if k in fixed else None for k in range(d)]
        supports.append(sg.Support(top, u=tuple(still), name="guide"))
        held |= {int(row) for k in fixed for row in rows(k)}
    ends = [(1.0, 0.0), (1.0, drag), (0.3, 0.0), (1.0, -drag), (0.05, -0.05 * drag)]
    if not drags:
        ends = [(1.0, 0.0), (0.2, 0.0), (1.0, 0.0), (0.05, 0.0)]
    count = int(rng.choice([1, 1, 2, 5]))
    steps = [
        sg.Step(scale={"press": p, **({"drag": q} if drags else {})}, increments=count, at="events") for p, q in ends
    ]
    against: Any = "lower.top" if two else sg.Plane((0.0,) * d, (0.0,) * (d - 1) + (1.0,))
    model = sg.Model(
        mesh,
        kind="3d" if d == 3 else geometry,
        thickness=thickness,
        bodies=bodies,
        supports=supports,
        loads=loads,
        contacts=[sg.Contact(f"{side[names[0]]}bottom", against, friction=friction, name="c")],
        steps=steps,
    )
    for name in names:
        if two and name == "lower":
            held |= {int(d * node + k) for node in mesh.nodes_of("lower.bottom") for k in range(d)}
        if ring:
            held |= {int(d * node) for node in mesh.nodes_of(f"{side[name]}left")}
    structure = in_words(model, held, groups, friction)
    return Case(seed=seed, kinds=kinds, model=model, structure=structure, unit=unit, friction=friction, drag=drags)


def in_words(
    model: sg.Model, held: set[int], groups: Sequence[np.ndarray] = (), friction: float = 0.0
) -> own.Structure:
    """The model in the words of the adversary; of the package only what pairs measure.

    Parameters
    ----------
    model : of cells of one family
    held : displacements that are prescribed
    groups : displacements that are the same
    friction : of all pairs
    """
    mesh, interface = model.mesh, prepare(model).interface
    (family, cells), dofs, d = next(iter(mesh.cells.items())), mesh.points.size, mesh.points.shape[1]
    owner = np.zeros(len(cells), int)
    for b, body in enumerate(model.bodies):
        owner[mesh.bodies[body.name]] = b
    laws = []
    for body in model.bodies:
        law = body.material.plastic
        rows = np.array([[0.0, np.inf]]) if law is None else np.array(law.yield_stress)
        backs = np.zeros((0, 2)) if law is None or not law.backstresses else np.array(law.backstresses)
        beyond = 0.0 if law is None else law.hardening
        laws.append(own.Law(E=body.material.E, nu=body.material.nu, rows=rows, beyond=beyond, backs=backs))
    thin = model.kind == "plane stress"
    both = [
        own.points(
            mesh.points,
            family,
            np.asarray(cells)[owner == b],
            owner[owner == b],
            kind=model.kind,
            thickness=model.thickness,
            projected=model.bodies[b].material.yields and not thin,
        )
        for b in range(len(model.bodies))
    ]
    joined = {part: np.concatenate([getattr(one, part) for one in both]) for part in ("B", "weights", "places", "body")}
    columns = [np.eye(dofs)[:, [k]] for k in range(dofs) if k not in held and not any(k in g for g in groups)]
    for group in groups:
        column = np.zeros((dofs, 1))
        column[group] = 1.0
        columns.append(column)
    n = len(interface)
    return own.Structure(
        points=own.Points(**joined),
        laws=laws,
        thin=thin,
        T=np.hstack(columns),
        pairs=interface.B.toarray()[:, :dofs].reshape(d, n, dofs),
        gap=np.array(interface.gap),
        friction=np.full(n, friction),
    )


def acting(case: Case, factors: Any) -> tuple[np.ndarray, np.ndarray]:
    """Forces and prescribed displacements, (dofs,), at factors by name."""
    force, moved = (sum(factors[name] * unit[k] for name, unit in case.unit.items()) for k in (0, 1))
    return force, moved


def judge(case: Case, *, solve: bool = False) -> Verdict:
    """Solve, and look at every instant; ``solve``: beside the slow solver too."""
    try:
        history = sg.solve(case.model, raise_on_failure=False)
    except Exception as error:  # whatever a solver may do is told, not raised
        return Verdict(outcome="ERROR", words=f"{type(error).__name__}: {str(error)[:300]}")
    follower = own.Follower.of(case.structure)
    worst = 0.0
    for k, step in enumerate(history.steps):
        for instant in step.instants:
            if instant.displacement is None and not step.finished:
                break  # the bodies were not looked at
            u = instant.displacement.ravel()
            if instant.what == "approach":
                follower.u = u
                continue
            acts, gradual = acting(case, instant.factors), instant.what != "landing"
            where = f"step {k + 1} at {instant.load_factor - k:.4%}, {instant.what}"
            if solve and gradual:
                other, part = follower.reached(*acts)
                off = np.abs(other - u).max() / max(np.abs(u).max(), follower.length, 1e-300)
                if part == 1.0 and off > AGREED:
                    return Verdict(outcome="ANOTHER", words=f"{where}: displacements differ by {off:.1e}")
                if part < 1.0:
                    print(f"{case.seed}: {where}: the slow solver comes to {part:.3%} only", flush=True)
            found = follower.violations(u, *acts, incremental=gradual)
            name = max(found, key=lambda key: found[key])
            if not found[name] <= TOLERANCE:
                return Verdict(outcome="WRONG", words=f"{where}: {name} {found[name]:.1e}, {step.path} {step.methods}")
            worst = max(worst, found[name])
    if history.status == "solved":
        return _flowed_alike(case, history, follower, worst)
    return _without_answer(case, history, follower)


def _flowed_alike(case: Case, history: Any, follower: own.Follower, worst: float) -> Verdict:
    """Plastic strains at the end, point by point."""
    bodies, plastic = prepare(case.model).yielding, history.end.state.plastic
    places = bodies.places()
    at = np.argmin(np.linalg.norm(places[:, None] - case.structure.points.places[None], axis=2), axis=1)
    strain = follower.state.strain[at]
    d = case.model.dimension
    columns = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)][: 4 if d == 2 else 6]
    mine = np.stack([strain[:, i, j] * (1 if i == j else 2) for i, j in columns], axis=1)
    largest = max(np.abs(mine).max(), follower.length)
    off = max(np.abs(mine - plastic.strain).max(), np.abs(follower.state.equivalent[at] - plastic.equivalent).max())
    if off > TOLERANCE * largest:
        return Verdict(outcome="STRAINS", words=f"plastic strains differ by {off / largest:.1e}")
    flowed = follower.state.equivalent.max()
    return Verdict(outcome="right", words=f"{worst:.1e}, equivalent plastic strain {flowed:.1e}", worst=worst)


def _without_answer(case: Case, history: Any, follower: own.Follower) -> Verdict:
    """Where the package found no equilibrium: is it named, and is there none?"""
    done = sum(step.finished for step in history.steps)
    words, s = f"step {done + 1}: {history.message[:400]}", case.structure
    scale = case.model.steps[done].scale or {}
    acts = acting(case, scale)
    if history.status == "jump":
        return Verdict(outcome="jump", words=words)
    if "flow plastically" in history.message and history.escape is not None:
        v = history.escape.ravel()
        taken, given = s.dissipation(v), float((acts[0]) @ v)
        opens, slides = (s.pairs @ v)[0], np.linalg.norm((s.pairs @ v)[1:], axis=0)
        size = np.abs(v).max()
        apart = opens >= s.friction * slides - 1e-6 * size
        if given > taken and apart.all():
            return Verdict(outcome="collapse", words=words)
        words += f" [mechanism: loads {given:.4g}, flow {taken:.4g}, {(~apart).sum()} pairs rub or press]"
    _, part = follower.reached(*acts, parts=16)
    if part == 1.0:
        return Verdict(outcome="MISSED", words=words)
    named = "flow plastically" in history.message or history.status == "no_equilibrium"
    return Verdict(outcome="named" if named else "UNNAMED", words=f"{words} [the slow solver comes to {part:.3%}]")


def main() -> None:
    made = parser(__doc__, KINDS, 100)
    made.add_argument("--solve", action="store_true", help="the slow solver beside every increment")
    options = made.parse_args()

    def judged(seed: int, wanted: frozenset[str]) -> tuple[frozenset[str], Verdict]:
        case = make(seed, wanted)
        return case.kinds, judge(case, solve=options.solve)

    search(options, KINDS, judged, "plastic histories")


if __name__ == "__main__":
    main()
