# SPDX-License-Identifier: BSD-3-Clause
"""Random small models with bodies that yield, beside elements, a flow rule and a solver that share no line with it.

    python -m benchmarks.plastic_histories                          # 100 models, all kinds
    python -m benchmarks.plastic_histories 1000 --seed 17           # any number, any seed
    python -m benchmarks.plastic_histories 100 --kinds space mortar # those in space, of meshes that do not match
    python -m benchmarks.plastic_histories 400 --in-turn --kept F   # every kind in its turn; goes on where it stopped
    python -m benchmarks.plastic_histories --only 4711              # one model, with all its numbers
    python -m benchmarks.plastic_histories 20 --solve               # the slow solver beside every increment too
    python -m benchmarks.plastic_histories 20 --refine              # and in tiny increments, to which few must tend
    python -m benchmarks.plastic_histories 1000 --write docs/plasticity.md

One elastoplastic block on a rigid plane, at rest or moving, or on another block, which yields, is elastic, or rigid;
pressed, dragged, heated, overlapping, released and reversed in 1 to 5 increments a stretch or as many as it takes, up
to 1.08 of what the block bears. Displacements of every instant are put into the equations of `independent_plastic`:
equilibrium with stresses that its own flow rule makes of them, and the law of contact, row by row, to 1e-7 of the
largest force and motion; plastic strains agree to as much. Where the package names collapse, its mechanism must take
less work than the loads do; where it finds no equilibrium, the slow solver looks for one. Some are solved again: cut
behind a step and gone on with ("restart": to the last bit), in other units ("units"), in another place and with other
axes ("turned"): displacements are the same, or another answer that is as right, of bodies that balance on a point.

Outcomes: "right"; "collapse", its mechanism takes less than the loads do; "named", said to have no equilibrium, and the
slow solver finds none either; "jump"; "looser", increments did not come within the tolerance, which is said, and with
ten times of it the answer is right; failures are in capitals.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Collection
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import signorini as sg
from benchmarks.independent_history import Follower
from benchmarks.moved_models import in_other_units, turned
from benchmarks.plastic_models import KINDS, Case, make
from benchmarks.random_search import Verdict, parser, search
from signorini.arrays import Array
from signorini.engine.prepare import prepare

TOLERANCE = 1e-7
AGREED = 1e-6  # of the largest displacement
SAME = 1e-9  # of the largest displacement: the same model in other words
TINY = 64  # increments of a step that stand for any number
COARSE = (4, 8, 16)  # increments of a step that must tend to those
HALVED = 0.75  # of the difference: what is left with twice the increments, 0.47 and 0.43 where it is C / N
UNSETTLED = "increments still change"
"""What the package says where its increments do not come within the tolerance; a larger one is its remedy."""
LOOSER = 1e-2  # tolerance of the steps then, where 1e-3 is the rule
ALIKE = 1e-4  # of the largest displacement: differences below are of increments that all but agree


def solved(model: sg.Model, kinds: Collection[str] = (), **given: Any) -> Any:
    """As far as there is an answer, the way that the kinds say.

    Raises
    ------
    KeyboardInterrupt
        Where it comes while the package solves, which ends that in good order.
    """
    backend = "iterative" if "iterated" in kinds else "auto"
    history = sg.solve(model, raise_on_failure=False, backend=backend, **given)
    if history.status == "interrupted":
        raise KeyboardInterrupt
    return history


def judge(case: Case, *, solve: bool = False) -> Verdict:
    """Solve, and look at every instant; ``solve``: beside the slow solver too."""
    verdict = _judged(case, solve=solve)
    if UNSETTLED not in verdict.words:
        return verdict
    steps = [replace(step, tolerance=LOOSER) for step in case.model.steps]
    again = _judged(replace(case, model=replace(case.model, steps=steps)), solve=solve)
    return again if again.failed else replace(again, outcome="looser", words=f"{verdict.words}; then {again.words}")


def _judged(case: Case, *, solve: bool) -> Verdict:
    """As the tolerance of its steps is."""
    try:
        history = solved(case.model, case.kinds)
    except Exception as error:  # whatever a solver may do is told, not raised
        return Verdict(outcome="ERROR", words=f"{type(error).__name__}: {str(error)[:300]}")
    follower = Follower.of(case.structure)
    looked = _looked_at(case, history, follower, solve=solve)
    if isinstance(looked, Verdict):
        return looked
    wrong = _solved_again(case, history)
    if wrong is not None:
        return wrong
    if history.status == "solved":
        return _flowed_alike(case, history, follower, looked)
    return _without_answer(case, history, follower)


def _looked_at(
    case: Case, history: Any, follower: Follower, *, solve: bool = False, back: Callable[[Array], Array] | None = None
) -> Verdict | float:
    """The worst violation of any instant, or what is wrong.

    Parameters
    ----------
    case, history, follower : what is looked at, and what looks at it
    solve : beside the slow solver
    back : to the displacements of the case, where the history is of the same model in other words
    """
    worst = 0.0
    for k, step in enumerate(history.steps):
        for instant in step.instants:
            if instant.displacement is None and not step.finished:
                break  # the bodies were not looked at
            u = instant.displacement if back is None else back(instant.displacement)
            u, acts = u.ravel(), case.acts(instant.factors, instant.load_factor)
            if instant.what == "approach":
                follower.u, follower.acts = follower.settled(u, acts), acts
                continue
            gradual = instant.what != "landing"
            where = f"step {k + 1} at {instant.load_factor - k:.4%}, {instant.what}"
            if solve and gradual:
                other, part = follower.reached(acts)
                off = np.abs(other[: u.size] - u).max() / max(np.abs(u).max(), follower.length, 1e-300)
                if part == 1.0 and off > AGREED:
                    return Verdict(outcome="ANOTHER", words=f"{where}: displacements differ by {off:.1e}")
                if part < 1.0:
                    print(f"{case.seed}: {where}: the slow solver comes to {part:.3%} only", flush=True)
            found = follower.violations(u, acts, incremental=gradual)
            name = max(found, key=lambda key: found[key])
            if not found[name] <= TOLERANCE:
                return Verdict(outcome="WRONG", words=f"{where}: {name} {found[name]:.1e}, {step.path} {step.methods}")
            worst = max(worst, found[name])
    return worst


def _flowed_alike(case: Case, history: Any, follower: Follower, worst: float) -> Verdict:
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
    words = f"{worst:.1e}, equivalent plastic strain {flowed:.1e}"
    return Verdict(outcome="right", words=words, worst=max(worst, off / largest))


def _without_answer(case: Case, history: Any, follower: Follower) -> Verdict:
    """Where the package found no equilibrium: is it named, and is there none?"""
    done = sum(step.finished for step in history.steps)
    words, s = f"step {done + 1}: {history.message[:400]}", case.structure
    acts = case.acts(case.model.steps[done].scale or {}, done + 1.0)
    if history.status == "jump":
        return Verdict(outcome="jump", words=words)
    if "flow plastically" in history.message and history.escape is not None:
        v = np.zeros(len(s.T))
        v[: history.escape.size] = history.escape.ravel()
        taken, given = s.dissipation(v, acts.heat), float(acts.force @ v)
        rates = (s.pairs @ v)[:, ~s.tied]
        opens, slides = rates[0], np.linalg.norm(rates[1:], axis=0)
        size = np.abs(v).max()
        apart = opens >= s.friction[~s.tied] * slides - 1e-6 * size
        if given > taken and apart.all():
            return Verdict(outcome="collapse", words=words)
        words += f" [mechanism: loads {given:.4g}, flow {taken:.4g}, {(~apart).sum()} pairs rub or press]"
    _, part = follower.reached(acts, parts=16)
    if part == 1.0:
        return Verdict(outcome="MISSED", words=words)
    named = "flow plastically" in history.message or history.status == "no_equilibrium"
    return Verdict(outcome="named" if named else "UNNAMED", words=f"{words} [the slow solver comes to {part:.3%}]")


def _solved_again(case: Case, history: Any) -> Verdict | None:
    """What is wrong where the model is cut in two, in other units, in another place; None where nothing is."""
    if "restart" in case.kinds and (words := _cut(case, history)):
        return Verdict(outcome="RESTART", words=words)
    for kind, moved in (("units", in_other_units), ("turned", turned)):
        if kind not in case.kinds:
            continue
        model, back = moved(case.model)
        other = solved(model, case.kinds)
        if other.status != history.status or len(other.steps) != len(history.steps):
            words = f"{other.status}, as it was {history.status}: {other.message[:200]}"
            return Verdict(outcome=kind.upper(), words=words)
        largest = max(np.abs(step.displacement).max() for step in history.steps)
        for k, (one, two) in enumerate(zip(history.steps, other.steps, strict=True)):
            if not one.finished:  # how far it goes below collapse is as exact as the bound of the load
                break
            off = np.abs(one.displacement - back(two.displacement)).max() / largest
            if off > SAME:  # bodies that balance on a point may stand at any angle: is the other one right too?
                looked = _looked_at(case, other, Follower.of(case.structure), back=back)
                if isinstance(looked, float):
                    break
                words = f"displacements of step {k + 1} differ by {off:.1e}: {looked.words}"
                return Verdict(outcome=kind.upper(), words=words)
    return None


def _cut(case: Case, whole: Any) -> str:
    """Cut behind a step and gone on with through a file: what differs in any bit, or nothing."""
    finished = sum(step.finished for step in whole.steps)
    if not finished:
        return ""
    cut = int(np.random.default_rng(case.seed).integers(1, finished + 1))
    if cut == len(case.model.steps):
        return ""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "state.npz"
        solved(replace(case.model, steps=case.model.steps[:cut]), case.kinds).save_state(path)
        after = solved(replace(case.model, steps=case.model.steps[cut:]), case.kinds, start=path)
    if after.status != whole.status:
        return f"cut behind step {cut}: {after.status}, the whole {whole.status}: {after.message[:200]}"
    for k, (one, two) in enumerate(zip(whole.steps[cut:], after.steps, strict=False)):
        if not np.array_equal(one.displacement, two.displacement):
            off = np.abs(one.displacement - two.displacement).max()
            return f"cut behind step {cut}: displacements of step {cut + k + 1} differ by {off:.1e}"
        if [one.work, one.strain_energy, one.dissipation] != [two.work, two.strain_energy, two.dissipation]:
            return f"cut behind step {cut}: energies of step {cut + k + 1} differ"
    if after.end is None:  # the whole history ends where it was cut
        return ""
    state, other = whole.end.state.plastic, after.end.state.plastic
    if not (np.array_equal(state.strain, other.strain) and np.array_equal(state.equivalent, other.equivalent)):
        return f"cut behind step {cut}: plastic strains at the end differ"
    return ""


def refined(case: Case) -> Verdict:
    """Press, and drag, in tiny increments of the slow solver: what few of the package must tend to at first order."""
    steps, factors = case.model.steps[:2], [dict.fromkeys(case.unit, 0.0)]
    factors += [dict(step.scale or {}) for step in steps]
    follower = Follower.of(case.structure)
    try:
        for k in range(len(steps)):
            for part in np.arange(1, TINY + 1) / TINY:
                mixed = {name: (1 - part) * factors[k][name] + part * factors[k + 1][name] for name in case.unit}
                follower.follow(case.acts(mixed, k + part))
    except ArithmeticError:
        return Verdict(outcome="beyond", words="the slow solver does not come to the end")
    u = follower.u[: case.model.mesh.points.size]
    largest, off = np.abs(u).max(), []
    for count in COARSE:
        some = [replace(step, increments=count) for step in steps]
        history = solved(replace(case.model, steps=some), case.kinds)
        if history.status != "solved":
            return Verdict(outcome="beyond", words=history.message[:200])
        off.append(float(np.abs(history.last.displacement.ravel() - u).max() / largest))
    words = "differences " + ", ".join(f"{one:.1e}" for one in off)
    tends = off[2] <= ALIKE or off[2] <= HALVED**2 * off[0]
    return Verdict(outcome="of first order" if tends else "APART", words=words, worst=off[2])


def main() -> None:
    made = parser(__doc__, KINDS, 100)
    made.add_argument("--solve", action="store_true", help="the slow solver beside every increment")
    made.add_argument("--refine", action="store_true", help="in place of all else: do increments tend to tiny ones")
    options = made.parse_args()

    def judged(seed: int, wanted: frozenset[str]) -> tuple[frozenset[str], Verdict]:
        case = make(seed, wanted)
        return case.kinds, refined(case) if options.refine else judge(case, solve=options.solve)

    search(options, KINDS, judged, "plastic increments" if options.refine else "plastic histories")


if __name__ == "__main__":
    main()
