# SPDX-License-Identifier: BSD-3-Clause
"""Units that differ by powers of two change no digit: no size, outcome or word may rest on an absolute number."""

import re

import numpy as np
import pytest

import signorini as sg

FAR = 2.0**40, 2.0**-40  # of stresses, about 1e12
LONG = 2.0**30, 2.0**-30  # of lengths, about 1e9


def blocks(seed: int, *, stress: float = 1.0, length: float = 1.0) -> sg.Model:
    """Two random blocks: held, driven, rigid, or by contact alone; pressed, dragged or lifted; gaps and overlaps."""
    rng = np.random.default_rng(seed)
    d = 2 if rng.random() < 0.7 else 3
    width, height, start = rng.uniform(0.5, 1.5), rng.uniform(0.4, 1.5), rng.uniform(0.0, 0.5)
    gap = float(rng.choice([0.0, 0.0, 1e-3, -5e-4]))
    across, beside = (int(rng.integers(2, 6 - d)) for _ in range(2))

    def body(begin: float, size: float, low: float, high: float, cells: int) -> sg.Mesh:
        along, up = begin + size * np.linspace(0.0, 1.0, cells + 1), np.linspace(low, high, 3)
        along, up = (length * along).tolist(), (length * up).tolist()
        return sg.rectangle(x=along, y=up) if d == 2 else sg.box(x=along, y=along, z=up)

    middle = (length * (start + width / 2),) * (d - 1) + (length * (gap + height),)
    modulus = 1000.0 * stress * np.array([1.0, rng.choice([0.1, 1.0, 1000.0])])
    pressure = stress * float(rng.choice([1.0, 5.0, 20.0]))
    traction = pressure * np.append(rng.choice([-0.29, 0.0, 0.1, 0.5, 2.0], d - 1), rng.choice([-1.0, -1.0, -1.0, 1.0]))
    held, driven, rigid = rng.permutation([True, False, False])
    supports = [sg.Support("a.bottom", u=(0,) * d)]
    if held:
        supports.append(sg.Support("b.left", u=(0, *[None] * (d - 1))))
    if driven:
        supports.append(sg.Support("b.top", u=(1e-3 * length,) * (d - 1) + (-2e-3 * length,), name="drive"))
    return sg.Model(
        sg.join({"a": body(0.0, 2.0, -1.0, 0.0, across), "b": body(start, width, gap, gap + height, beside)}),
        kind="3d" if d == 3 else "plane strain",
        thickness=length if d == 2 else 1.0,
        bodies=[sg.Body(name, sg.Elastic(E=float(E), nu=0.3)) for name, E in zip("ab", modulus, strict=True)],
        supports=supports,
        loads=[] if driven else [sg.Load("b.top", traction=tuple(traction.tolist()))],
        rigid_bodies=[sg.RigidBody("rigid", "b", middle)] if rigid else [],
        contacts=[sg.Contact("b.bottom", "a.top", friction=rng.choice([0.0, 0.1, 0.3, 0.8]))],
        steps=[sg.Step(increments=1)] if rng.random() < 0.5 else [sg.Step()],
    )


def answer(model: sg.Model, backend: str) -> tuple[str, str, list[np.ndarray]]:
    """Status; words, numbers left out; displacements, pressures and tractions."""
    try:
        solution = sg.solve(model, backend=backend, raise_on_failure=False)
    except sg.InputError as error:
        return "wrong", re.sub(r"[-+]?[\d.]+(e[-+]?\d+)?", "#", str(error)), []
    words = " ".join([solution.message, *(note for step in solution.steps for note in step.notes)])
    end = [] if not solution.steps else [solution.last.displacement]
    end += [part for step in solution.steps for c in step.contacts for part in (c.pressure, c.traction)]
    return solution.status, re.sub(r"[-+]?[\d.]+(e[-+]?\d+)?", "#", words), end


@pytest.mark.slow
@pytest.mark.parametrize(
    ("backend", "seeds"), [("auto", range(16)), ("superlu", range(3)), ("iterative", (3, 7, 9))], ids=str
)
def test_powers_of_two_change_no_digit(backend, seeds):
    seen = set()
    for seed in seeds:
        status, words, numbers = answer(blocks(seed), backend)
        seen.add(status)
        for stress, length in ((FAR[0], LONG[1]), (FAR[1], 1.0), (1.0, LONG[0]), (1.0, LONG[1])):
            found, said, others = answer(blocks(seed, stress=stress, length=length), backend)
            assert (found, said) == (status, words), (seed, stress, length)
            for k, (here, there) in enumerate(zip(numbers, others, strict=True)):
                unit = stress if k else length
                assert np.abs(there / unit - here).max() <= 1e-13 * np.abs(here).max(), (seed, stress, length, k)
    assert (
        seen >= {"auto": {"solved", "no_equilibrium"}, "superlu": {"no_equilibrium"}, "iterative": {"solved"}}[backend]
    )
