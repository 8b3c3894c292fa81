# SPDX-License-Identifier: BSD-3-Clause
"""Fields of the bodies are computed once for all files of a run."""

from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest

from signorini.cli import main
from signorini.output import fields

DECK = """*NODE, NSET=ALL
1, 0, 0
2, 1, 0
3, 1, 1
4, 0, 1
*ELEMENT, TYPE=CPE4, ELSET=BLOCK
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
100, 0.3
*SOLID SECTION, ELSET=BLOCK, MATERIAL=M
*BOUNDARY
1, 1, 2
2, 2
{steps}"""
STEP = """*STEP
*STATIC
*BOUNDARY
3, 2, 2, {u}
4, 2, 2, {u}
*NODE FILE
U
*EL FILE
S
*EL PRINT, ELSET=BLOCK
S
*EL PRINT, ELSET=BLOCK
S
*END STEP
"""


def test_a_run_makes_one_space_and_the_stresses_of_every_step_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """For the last state, the series, ``.frd`` and ``.dat``, where two tables ask for the stresses of each step."""
    calls: Counter[str] = Counter()

    def counted(name: str) -> Callable[..., object]:
        real = getattr(fields, name)

        def call(*given: object, **keys: object) -> object:
            calls[name] += 1
            return real(*given, **keys)

        return call

    for name in ("make_space", "body_stresses", "point_stresses"):
        monkeypatch.setattr(fields, name, counted(name))
    monkeypatch.setattr("signorini.output.folder._MAX_KEEP_SHARE", -1.0)  # nothing is written before the end
    deck, out = tmp_path / "press.inp", tmp_path / "out"
    deck.write_text(DECK.format(steps="".join(STEP.format(u=u) for u in (-0.1, -0.2, -0.3))))
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    names = {file.name for file in out.iterdir()}
    assert names >= {"solution.vtu", "solution_0003.vtu", "solution.pvd", "solution.frd", "solution.dat"}
    assert calls == {"make_space": 1, "body_stresses": 3, "point_stresses": 3}
