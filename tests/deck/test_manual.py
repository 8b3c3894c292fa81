# SPDX-License-Identifier: BSD-3-Clause
"""``docs/deck.md`` against the code: its deck is right, its message is the real one, no key is missing."""

import inspect
import re
from dataclasses import fields
from pathlib import Path

import pytest

from signorini.deck import DeckError, read
from signorini.deck.load import KEYS
from signorini.deck.meshes import GENERATORS
from signorini.deck.tables import CONTACT_KEYS, OBSTACLE_KEYS
from signorini.fatigue import Crossland, FatemiSocie
from signorini.model.body import Body
from signorini.model.conditions import Foundation, Load, Support
from signorini.model.fatigue import Fatigue
from signorini.model.material import Elastic, Orthotropic
from signorini.model.plastic import Plastic
from signorini.model.step import Step
from signorini.model.wear import Wear
from signorini.settings import SolverSettings

MANUAL = (Path(__file__).parents[2] / "docs" / "deck.md").read_text()
DECK = re.findall(r"```toml\n(.*?)```", MANUAL, re.DOTALL)[0]


def test_the_deck_is_right(tmp_path: Path) -> None:
    (tmp_path / "deck.toml").write_text(DECK)
    assert read(tmp_path / "deck.toml").steps[0].increments == 10


def test_the_message_is_the_real_one(tmp_path: Path) -> None:
    shown = re.findall(r"```text\nsignorini: deck\.toml(.*?), \.\.\.\n```", MANUAL)[0]
    (tmp_path / "deck.toml").write_text(DECK.replace("friction", "fricton"))
    with pytest.raises(DeckError) as caught:
        read(tmp_path / "deck.toml")
    assert str(caught.value).startswith(f"{tmp_path / 'deck.toml'}{shown}")


def test_every_key_is_explained() -> None:
    keys = {*CONTACT_KEYS, *OBSTACLE_KEYS, *GENERATORS, "generator", "file"} | {
        key for key in KEYS if f"[{key}" not in MANUAL
    }
    keys |= {
        field.name
        for kind in (
            Support,
            Foundation,
            Load,
            Step,
            Body,
            Elastic,
            Plastic,
            Orthotropic,
            Wear,
            Fatigue,
            FatemiSocie,
            Crossland,
            SolverSettings,
        )
        for field in fields(kind)
    }
    keys |= {name for generator in GENERATORS.values() for name in inspect.signature(generator).parameters}
    missing = sorted(key for key in keys if not re.search(rf"`{key}[` ]", MANUAL))
    assert not missing


def test_every_generator_is_told_with_its_names() -> None:
    for name, generator in GENERATORS.items():
        needed = {"radius": 8.0, "contact_length": 4.0, "contact_spacing": 0.5, "inner": 1.0, "outer": 2.0}
        needed |= {"n_radial": 1, "n_angular": 2, "angle": 90.0, "z": (0.0, 1.0)}
        needed |= {"x": (0.0, 1.0), "y": (0.0, 1.0)} if name == "box" else {}
        takes = inspect.signature(generator).parameters
        mesh = generator(**{key: value for key, value in needed.items() if key in takes})
        row = next(line for line in MANUAL.splitlines() if line.startswith(f"| `{name}`"))
        assert all(f"`{part}`" in row for part in [*mesh.bodies, *mesh.boundaries])
