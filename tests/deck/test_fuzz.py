# SPDX-License-Identifier: BSD-3-Clause
"""Damaged inputs are read or refused: nothing else happens. ``python -m benchmarks.fuzz`` tries a million."""

import os
import random
import time
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signorini.engine.examine import examine

fuzz = pytest.importorskip("benchmarks.fuzz", reason="the benchmarks are beside the tests in a checkout only")
from benchmarks.mutations import KINDS, corpus, damage  # noqa: E402  # nothing to import where fuzz is not


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Any:
    return corpus(tmp_path_factory.mktemp("sound"))


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@settings(
    max_examples=300, deadline=None
)  # what is compiled once, and other processes, take their time; benchmarks.fuzz counts CPU seconds
@given(seed=st.integers(0, 2**32), kind=st.sampled_from(KINDS))
def test_damaged_inputs(sound: Any, tmp_path_factory: pytest.TempPathFactory, seed: int, kind: str) -> None:
    kind, path = damage(sound, random.Random(seed), tmp_path_factory.getbasetemp(), kind)
    assert fuzz.outcome(kind, path, sound) in ("read", "refused")


@pytest.mark.parametrize("kind", ["toml", "inp"])
def test_sound_decks_are_read(sound: Any, tmp_path: Path, kind: str) -> None:
    for number, text in enumerate(sound.texts[kind]):
        deck = tmp_path / f"{number}.{kind}"
        deck.write_text(text)
        assert fuzz.outcome(kind, deck, sound) == "read"


def test_other_inputs_are_read(sound: Any, tmp_path: Path) -> None:
    for name, content in sound.meshes.items():
        (tmp_path / f"mesh{Path(name).suffix}").write_bytes(content)
        for beside in sound.results.parent.glob(f"{Path(name).stem}.h5"):
            (tmp_path / beside.name).write_bytes(beside.read_bytes())
        assert fuzz.outcome("mesh", tmp_path / f"mesh{Path(name).suffix}", sound) == "read"
    for kind, name in (("state", "state.npz"), ("archive", "solution.h5"), ("folder", "")):
        assert fuzz.outcome(kind, sound.results / name, sound) == "read"


def test_functions_that_no_sound_deck_calls_are_compiled_before_seconds_count(monkeypatch: pytest.MonkeyPatch) -> None:
    called = set()
    for place, name in (("face_parts", "integrate"), ("points", "meet")):
        module = import_module(f"signorini.interface.{place}")
        original = getattr(module, name)
        monkeypatch.setattr(module, name, lambda *a, name=name, original=original: called.add(name) or original(*a))
    for model in fuzz.rare_models():
        examine(model)
    assert called == {"integrate", "meet"}


def busy() -> None:
    while True:
        pass


def deaf() -> None:
    time.sleep(60)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("way", "said"),
    [
        (busy, "Late: more than 0.2 s"),
        (lambda: os._exit(3), "the process ended: 3"),
        (deaf, "hangs"),
        (lambda: 1 / 0, "ZeroDivisionError: division by zero"),
    ],
)
def test_what_fails_is_found(sound: Any, monkeypatch: pytest.MonkeyPatch, way: Any, said: str) -> None:
    """An input that takes too long, or ends the process, is told, and the others go on."""
    monkeypatch.setattr(fuzz, "outcome", lambda kind, *_: way() if kind == "toml" else "read")
    monkeypatch.setattr(fuzz, "SECONDS", 0.2)
    monkeypatch.setattr(fuzz, "STUCK", 3.0 if way is deaf else 60.0)
    found = list(fuzz.outcomes(sound, 4, 0))
    assert [number for number, *_ in found] == [0, 1, 2, 3]
    assert {became for _, _, became, _ in found} == {"read", said}
