# SPDX-License-Identifier: BSD-3-Clause
"""Models in space that loads carry away, tip, roll or let jump, random ones and decks: what each ends in, and its cost.

    python -m benchmarks.overloaded [--number N] [--seed S] [--limit SECONDS] [--page]

Boxes of hexahedra and tetrahedra, on planes, blocks and stacks of blocks, between walls, clamped and lifted; pressed,
then pulled, tipped and turned by less or more than friction holds; on exact cones, ellipses and facets; one or several
steps; matching or not; paths as they come, exact, in a few increments, jumps followed or not. Then decks: the bolted
bracket of the examples under several times what its friction holds, lifted, on other ways of stepping; decks of the
tests under many times their loads; cubes of up to 289 pairs and some ten thousand unknowns that slide and turn.

Every model ends certified, proved (no equilibrium), named (a jump or gross sliding, with its load), or in nothing. What
it takes is counted twice. Factorisations of the stiffness of its bodies, sparse, which is what a large model pays for.
And work on the interface, dense matrices of as many rows as its pairs have: the factorisations among it, and all of it
as a price (Newton systems, their iterations, sweeps, held interfaces, linear programmes), operations over those of one
factorisation, the sparse one or a dense one of all rows of the pairs, whichever takes more. CPU seconds of models so
small count how often Python is asked. With --page the table of how they ended goes into docs/three_dimensions.md.
"""

from __future__ import annotations

import signal
import statistics
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import FrameType
from typing import Any, Literal
from unittest.mock import patch

import numpy as np
import scipy

import signorini as sg
from benchmarks import command, page
from signorini.condense.operator import Single
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.errors import InputError, SolveFailed
from signorini.friction import krylov, newton
from signorini.friction.history.space import find_rates as space_rates
from signorini.friction.history.space import sticking_response as held
from signorini.friction.space import proximal
from signorini.linalg import _fronts, multifrontal
from signorini.meshing.solid import box
from signorini.model.mesh import join

ROOT = Path(__file__).parents[1]
FAMILIES = ("block on plane", "block on block", "stack", "slab", "wedge", "tall block")
SEED = 1993
HEADS = (
    *("ended", "models", "most factorisations of bodies", "median of dense ones", "most dense ones"),
    *("median price", "largest price", "median CPU s", "largest CPU s"),
)
FRICTION = (0.05, 0.1, 0.3, 0.6, 1.0, 2.0, 4.0)


@dataclass
class Work:
    """Operations so far.

    Attributes
    ----------
    law : of the law of contact
    sparse : of the largest sparse factorisation
    counts : how often each was done
    """

    law: float = 0.0
    sparse: float = 0.0
    counts: Counter[str] = field(default_factory=Counter)

    def add(self, what: str, operations: float) -> None:
        """One more of them."""
        self.counts[what] += 1
        self.law += operations


class OutOfTime(Exception):
    """The limit of seconds is over."""


def random_model(seed: int, number: int) -> sg.Model:
    """One of the models."""
    rng = np.random.default_rng([seed, number])
    family = FAMILIES[number % len(FAMILIES)]
    friction: Any = float(rng.choice(FRICTION[3:] if family == "slab" else FRICTION))
    law: dict[str, Any] = {"friction": friction}
    kind = rng.random()
    if kind < 0.15:
        law |= {"friction": (friction, 0.5 * friction), "friction_axis": (1, 0, 0)}
    elif kind < 0.4:
        law |= {"facets": int(rng.choice([4, 8, 12])), "friction_axis": (1, 0, 0)}
    n = int(rng.integers(1, 7))
    size = np.array([1.0, rng.uniform(0.5, 1.5), rng.uniform(0.3, 1.0) * (4.0 if family == "tall block" else 1.0)])
    cells = str(rng.choice(["hexahedron", "hexahedron", "tetra"]))
    parts = {"top": _box(n, size, 0.0, cells)}
    supports: list[sg.Support] = []
    contacts: list[sg.Contact] = []
    floor = sg.Plane((0, 0, 0), (0, 0, 1))
    if family in ("block on block", "stack"):
        wide = np.array([size[0] + 0.5, size[1] + 0.5, 0.5])
        m = n + int(rng.integers(0, 2))
        parts["base"] = _box(m, wide, -0.5, cells, shift=0.25 * float(rng.random() < 0.8))
        supports.append(sg.Support("base.bottom", u=(0.0, 0.0, 0.0)))
        contacts.append(sg.Contact("top.bottom", "base.top", name="joint", **law))
        if family == "stack":
            parts["cap"] = _box(n, size * (1.0, 1.0, 0.5), size[2], cells)
            contacts.append(sg.Contact("cap.bottom", "top.top", name="upper", **law))
    else:
        contacts.append(sg.Contact("top.bottom", floor, name="floor", **law))
    if family == "wedge":
        tilt = float(np.deg2rad(rng.choice([5.0, 20.0, 45.0, 70.0])))
        wall = sg.Plane((1.0, 0, 0), (-np.cos(tilt), 0, np.sin(tilt)))
        contacts.append(sg.Contact("top.right", wall, name="wall", **law))
    if family == "slab":
        supports.append(sg.Support("top.left", u=(0.0, 0.0, 0.0)))
    loaded = "cap" if family == "stack" else "top"
    pull = rng.normal(size=3) * (1.0, 1.0, 0.3) * 10.0 ** rng.uniform(-1.5, 1.0)
    loads = [
        sg.Load(f"{loaded}.{'bottom' if family == 'slab' else 'top'}", force=(0.0, 0.0, -1.0), name="press"),
        sg.Load(f"{loaded}.{rng.choice(['right', 'top', 'front'])}", force=tuple(pull.tolist()), name="pull"),
    ]
    way: dict[str, Any] = {}
    choice = rng.random()
    if choice < 0.15:
        way = {"increments": int(rng.integers(1, 12))}
    elif choice < 0.3:
        way = {"jump": str(rng.choice(["stop", "follow"])), "increments": "auto"}
    elif choice < 0.45 and "facets" in law:
        way = {"path": "exact", "jump": str(rng.choice(["stop", "follow"]))}
    steps = [sg.Step(name="press", scale={"press": 1.0}), sg.Step(name="pull", scale={"pull": 1.0}, **way)]
    if rng.random() < 0.3:
        steps.append(sg.Step(name="back", scale={"pull": float(rng.uniform(-1.0, 0.5))}, **way))
    E = float(10.0 ** rng.uniform(0.5, 4.0))
    several = len(parts) > 1
    return sg.Model(
        join(parts) if several else join({"top": parts["top"]}),
        title=", ".join([family, f"n {n}", cells, *(f"{key} {value}" for key, value in (law | way).items())]),
        bodies=[sg.Body(name, sg.Elastic(E=E * float(rng.choice([1.0, 1.0, 30.0])), nu=0.3)) for name in parts],
        supports=supports,
        loads=loads,
        contacts=contacts,
        steps=steps,
    )


def _box(n: int, size: np.ndarray, low: float, cells: str, *, shift: float = 0.0) -> sg.Mesh:
    """n cells along x and about as long ones along the others."""
    counts = [max(1, round(n * length / size[0])) for length in size]
    x, y, z = (np.linspace(0.0, length, min(count, 8) + 1) for length, count in zip(size, counts, strict=True))
    return box(x=x - shift, y=y - shift, z=z + low, cells=cells)  # type: ignore[arg-type]


@contextmanager
def counted() -> Iterator[Work]:
    """Count what the law of contact takes."""
    work = Work()

    def wrapped(module: Any, name: str, cost: Callable[[tuple[Any, ...], dict[str, Any], Any], float]) -> Any:
        original = getattr(module, name)

        def call(*arguments: Any, **keywords: Any) -> Any:
            found = original(*arguments, **keywords)
            work.add(name, cost(arguments, keywords, found))
            return found

        return patch.object(module, name, call)

    def programme(_: tuple[Any, ...], keywords: dict[str, Any], found: Any) -> float:
        rows = keywords["A_ub"] if "A_ub" in keywords else keywords["A_eq"]
        return 2.0 * rows.shape[0] * rows.shape[1] * max(int(found.nit), 1)

    def held_form(arguments: tuple[Any, ...], _: dict[str, Any], found: Any) -> float:
        size = 3 * arguments[0].pairs
        return size**3 / 3.0 if found is None else len(found.rows) ** 3 + (size - len(found.rows)) ** 3

    def planned(_a: tuple[Any, ...], _k: dict[str, Any], found: Any) -> float:
        work.sparse = max(work.sparse, found.flops)
        return 0.0

    with (
        wrapped(newton, "linear_system", lambda _a, _k, found: 2.0 / 3.0 * len(found.lu) ** 3),
        wrapped(krylov, "symmetric_product", lambda a, _k, _f: 2.0 * len(a[1]) ** 2),
        wrapped(Single, "product", lambda a, _k, _f: 2.0 * len(a[1]) ** 2),
        wrapped(Single, "solve", lambda a, _k, _f: 2.0 * len(a[1]) ** 2),
        wrapped(proximal, "gauss_seidel", lambda a, k, _f: 2.0 * k["count"] * (3 * a[0].pairs) ** 2),
        wrapped(scipy.optimize, "linprog", programme),
        wrapped(held.StickingResponse, "of", held_form),
        wrapped(space_rates, "_complementary", lambda a, _k, _f: 2.0 / 3.0 * len(a[1]) ** 3),
        wrapped(multifrontal, "analyse", planned),
        wrapped(_fronts, "factorise_fronts", lambda _a, _k, _f: 0.0),
    ):
        yield work


@contextmanager
def at_most(seconds: float) -> Iterator[None]:
    """Stop what takes more CPU seconds."""

    def over(_number: int, _frame: FrameType | None) -> None:
        raise OutOfTime

    before = signal.signal(signal.SIGPROF, over)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def decks() -> Iterator[sg.Model]:
    """Models of decks, under loads beyond what they hold."""
    bracket = sg.read(ROOT / "examples" / "bolted_bracket.toml")

    def loaded(cable: tuple[float, float, float], friction: float, title: str, **way: Any) -> sg.Model:
        *first, last = bracket.steps
        loads = [replace(load, force=cable) if load.name == "cable" else load for load in bracket.loads]
        contacts = [replace(contact, friction=friction) for contact in bracket.contacts]
        steps = [*first, replace(last, **way)]
        return replace(bracket, loads=loads, contacts=contacts, steps=steps, title=f"bolted bracket, {title}")

    pull = (1600.0, 0.0, 0.0)
    yield loaded(pull, 0.12, "1.6 kN, friction 0.12")
    yield loaded(pull, 0.12, "1.6 kN, friction 0.12, 10 increments", increments=10)
    yield loaded(pull, 0.12, "1.6 kN, friction 0.12, jumps stop", jump="stop", increments="auto")
    yield loaded(pull, 0.02, "1.6 kN, friction 0.02")
    yield loaded((2400.0, 0.0, 0.0), 0.3, "2.4 kN, friction 0.3")
    yield loaded((8000.0, 0.0, 0.0), 0.3, "8 kN, friction 0.3")
    yield loaded((0.0, 0.0, 25e3), 0.3, "lifted by 25 kN")
    yield loaded((800.0, 0.0, 12e3), 0.3, "lifted by 12 kN and pulled")
    for name in ("deck/decks/space.toml", "deck/inp/decks/wedges.inp"):
        deck = sg.read(ROOT / "tests" / name)
        for factor in (10.0, 100.0):
            steps = [replace(step, scale=_multiplied(deck, step, factor)) for step in deck.steps]
            yield replace(deck, steps=steps, title=f"{name}, {factor:g} times its loads")
    for n in (4, 10, 16):
        for pull, turn, jump in ((0.2, 0.0, None), (0.5, 0.0, None), (0.25, 0.35, "follow")):
            yield cube(n, pull=pull, turn=turn, jump=jump)


def cube(n: int, *, pull: float, turn: float, jump: Literal["stop", "follow"] | None) -> sg.Model:
    """A cube of n cells an edge that lies on a block under a force of 1, pulled and turned; friction is 0.3.

    Parameters
    ----------
    pull : force along x at its top
    turn : force along y at its right side, half the size of the cube beside its axis
    jump : what to do at jumps
    """
    x, wide = np.linspace(0.0, 1.0, n + 1), np.linspace(-0.25, 1.25, n + 1)
    return sg.Model(
        join({"cube": box(x=x, y=x, z=x), "block": box(x=wide, y=wide, z=np.linspace(-0.75, 0.0, n // 2 + 1))}),
        title=f"cube of {n}^3 cells, pulled by {pull:g}, turned by {turn:g}, jump {jump}",
        bodies=[sg.Body(name, sg.Elastic(E=100.0, nu=0.3)) for name in ("cube", "block")],
        supports=[sg.Support("block.bottom", u=(0.0, 0.0, 0.0))],
        loads=[
            sg.Load("cube.top", force=(0.0, 0.0, -1.0), name="press"),
            sg.Load("cube.top", force=(pull, 0.0, 0.0), name="pull"),
            sg.Load("cube.right", force=(0.0, turn, 0.0), name="turn"),
        ],
        contacts=[sg.Contact("cube.bottom", "block.top", friction=0.3, name="joint")],
        steps=[
            sg.Step(name="press", scale={"press": 1.0}),
            sg.Step(name="pull", scale={"pull": 1.0, "turn": 1.0}, jump=jump),
        ],
    )


def _multiplied(model: sg.Model, step: sg.Step, factor: float) -> dict[str, Any]:
    """Load factors at the end of a step, those of loads times a factor."""
    loads = {load.label for load in model.loads}
    scale: dict[str, Any] = dict.fromkeys(model.scaled_names, 1.0) if step.scale is None else dict(step.scale)
    return {name: np.multiply(value, factor).tolist() if name in loads else value for name, value in scale.items()}


def solved(seed: int, number: int, limit: float) -> dict[str, Any]:
    """A row of the table, of a random model."""
    return row_of(random_model(seed, number), str(number), limit)


def row_of(model: sg.Model, number: str, limit: float) -> dict[str, Any]:
    """A row of the table."""
    row: dict[str, Any] = {
        "number": number,
        "model": model.title,
        "pairs": 0,
        "price": 0.0,
        "seconds": 0.0,
    }
    start, ended = time.process_time(), "nothing"
    with counted() as work:
        try:
            with at_most(limit):
                prepared = prepare(model)
                row["pairs"] = len(prepared.interface)
                history = solve_prepared(prepared, raise_on_failure=False)
                row["message"] = history.message
                notes = " ".join(note for step in history.steps for note in step.notes)
                ended = {"solved": "certified", "no_equilibrium": "proved", "jump": "named"}.get(
                    history.status, "nothing"
                )
                if ended == "certified" and any(
                    words in notes for words in ("a jump", "gross sliding", "history parts")
                ):
                    ended = "certified, jump named"
                if any(not step.certificate.passed for step in history.steps):
                    ended = "WRONG: not certified"
        except InputError as error:
            ended, row["message"] = "refused", str(error)
        except SolveFailed as failure:
            ended, row["message"] = failure.status, str(failure)
        except OutOfTime:
            ended, row["message"] = "out of time", f"more than {limit:g} s"
    row["seconds"] = time.process_time() - start
    dense = 2.0 / 3.0 * (3.0 * row["pairs"]) ** 3
    row["price"] = work.law / max(work.sparse, dense, 1.0)
    row["ended"], row["bodies"] = ended, work.counts["factorise_fronts"]
    row["dense"] = work.counts["linear_system"] + work.counts["of"]
    return row


def main() -> None:
    """Print the table as it comes, and what it comes to."""
    made = command.parser(__doc__)
    made.add_argument("--number", type=int, default=120, help="of models")
    made.add_argument("--first", type=int, default=0, help="number of the first")
    made.add_argument("--only-decks", action="store_true", help="no random models")
    made.add_argument("--seed", type=int, default=SEED)
    made.add_argument("--limit", type=float, default=60.0, help="CPU seconds that a model may take")
    made.add_argument("--page", action="store_true", help="write how the models ended into docs/three_dimensions.md")
    options = made.parse_args()
    numbers = range(options.first, options.first + options.number) if not options.only_decks else range(0)
    models = [(str(number), random_model(options.seed, number)) for number in numbers]
    models += [(f"d{k}", model) for k, model in enumerate(decks())]
    row_of(random_model(options.seed, 0), "", options.limit)  # compiles what is compiled: no price of a model
    rows = []
    print("number | pairs | bodies | dense | price | CPU s | ended | model")
    for number, model in models:
        row = row_of(model, number, options.limit)
        rows.append(row)
        counted = f"{number:>4} | {row['pairs']:4d} | {row['bodies']:3d} | {row['dense']:6d}"
        figures = f"{counted} | {row['price']:8.1f} | {row['seconds']:7.2f}"
        print(figures, row["ended"], row["model"], row["message"].partition("\n")[0][:200], sep=" | ", flush=True)
    kinds = {"random": [row for row in rows if row["number"].isdigit()]}
    kinds["decks"] = [row for row in rows if not row["number"].isdigit()]
    tables = {kind: page.table(HEADS, summary(own)) for kind, own in kinds.items() if own}
    for kind, table in tables.items():
        print(f"\n{kind}\n\n{table}")
    if options.page and "random" in tables:
        page.write("overloaded", tables["random"], page.PAGE.parent / "three_dimensions.md")


def summary(rows: list[dict[str, Any]]) -> list[list[str]]:
    """By how models ended."""
    lines = []
    for ended in sorted({row["ended"] for row in rows}):
        own = [row for row in rows if row["ended"] == ended]
        dense, price, seconds = ([row[name] for row in own] for name in ("dense", "price", "seconds"))
        lines.append(
            [ended, str(len(own)), str(max(row["bodies"] for row in own))]
            + [f"{statistics.median(dense):.0f}", str(max(dense))]
            + [f"{statistics.median(price):.1f}", f"{max(price):.1f}"]
            + [f"{statistics.median(seconds):.2f}", f"{max(seconds):.2f}"]
        )
    return lines


if __name__ == "__main__":
    main()
