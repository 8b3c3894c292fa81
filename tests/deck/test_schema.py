# SPDX-License-Identifier: BSD-3-Clause
"""The schema of decks: every example fits it, what the reader refuses by its key it refuses, and every key is in it."""

import json
import re
import tomllib
from pathlib import Path

import pytest

from signorini.cli import main
from signorini.deck.schema import deck_schema, meanings
from signorini.outcome import Outcome

jsonschema = pytest.importorskip("jsonschema")
EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def validator():
    schema = deck_schema()
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


@pytest.mark.parametrize("deck", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_examples_fit(validator, deck):
    assert [error.message for error in validator.iter_errors(tomllib.loads(deck.read_text()))] == []


BASE = (EXAMPLES / "zhu_cylinder.toml").read_text()


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("friction = 0.4", "fricton = 0.4"),
        ("friction = 0.4", 'friction = "glue"'),
        ("friction = 0.4", "friction = 0.4\nfacets = 1.5"),
        ("E = 200.0", 'E = "steel"'),
        ('generator = "quarter_disk"', 'generator = "quarter"'),
        ("radius = 8.0", "radios = 8.0"),
        ('u = [0.0, "free"]', 'u = [0.0, "loose"]'),
    ],
)
def test_what_is_wrong_by_its_key_or_type_does_not_fit(validator, right, wrong):
    assert right in BASE
    errors = list(validator.iter_errors(tomllib.loads(BASE.replace(right, wrong))))
    if wrong.endswith('"loose"]'):  # a formula is text: the reader has to look
        assert errors == []
    else:
        assert errors


def test_what_varies_fits(validator):
    text = BASE.replace(
        "friction = 0.4", "friction = { x = [0, 2], mu = [0.1, 0.3] }\ngap = { x = [0, 1], value = [0, 1] }"
    )
    assert list(validator.iter_errors(tomllib.loads(text))) == []


def test_forces_of_a_file_fit(validator):
    text = BASE + '\n[[load]]\nname = "shake"\nnodal_forces = { file = "modes.vtu", column = "stuck_1_force" }\n'
    assert list(validator.iter_errors(tomllib.loads(text))) == []


def test_keys_of_the_manual_are_explained():
    """Rows of the tables of docs/deck.md below a heading [[table]] begin with keys."""
    manual, table, missing, found = (EXAMPLES.parent / "docs" / "deck.md").read_text(), "", [], meanings()
    properties = deck_schema()["properties"]
    for line in manual.splitlines():
        if line.startswith("#"):
            table = line.strip("# `[]").replace(".NAME", "")
        elif line.startswith("| `") and table in properties and table not in ("mesh", "material"):
            keys = re.findall(r"`(\w+)`", line.split("|")[1])
            missing += [f"{table}.{key}" for key in keys if f"{table}.{key}" not in found]
    # constants of criteria stand one table further inside
    assert [key for key in missing if key.replace("fatigue.", "fatigue.criterion.") not in found] == []


def test_tables_inside_that_of_a_contact_are_known():
    """A new one is added to the schema with the class that it becomes."""
    contact = deck_schema()["properties"]["contact"]["items"]["properties"]
    for key, schema in contact.items():
        for part in schema.get("anyOf", [schema]):
            if part.get("type") == "object" and key not in ("friction", "gap", "interference"):
                assert part.get("properties"), key


def test_the_command_prints_what_the_examples_name(capsys):
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out) == deck_schema()
    for deck in EXAMPLES.glob("*.toml"):
        assert deck.read_text().startswith("#:schema deck.schema.json\n"), deck


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("contact.friction", "contact.friction (default 0.0)\n  Coulomb's coefficient, >= 0;"),
        ("jump", "status jump\n  No equilibrium continues"),
        ("jump", "step.jump\n"),
        ("3", "exit code 3\n  No certified"),
        ("penetration", "certificate, penetration\n  the largest overlap"),
        ("newton_steps", "solver.newton_steps (default 200)"),
    ],
)
def test_words_are_explained(word, said, capsys):
    assert main(["explain", word]) == 0
    assert said in capsys.readouterr().out


def test_a_table_is_explained_with_all_of_its_keys(capsys):
    assert main(["explain", "body"]) == 0
    heads = [line for line in capsys.readouterr().out.splitlines() if not line.startswith(" ")]
    assert heads == ["body", "body.name", "body.material", "body.formulation", "body.thickness"]


def test_every_key_and_table_has_words():
    """Whatever an editor completes it also says what it is."""
    silent, known = set(), meanings()

    def walk(schema, path):
        for part in (schema, *schema.get("anyOf", ())):
            for key, inner in part.get("properties", {}).items():
                name = f"{path}.{key}".lstrip(".")
                silent.update({name} - known.keys())
                walk(inner, name)
            for inner in (part.get("items"), part.get("additionalProperties")):
                if isinstance(inner, dict):
                    walk(inner, path)

    walk(deck_schema(), "")
    assert not silent


def test_an_unknown_word_is_told_with_its_neighbour(capsys):
    assert main(["explain", "fricton"]) == 2
    assert capsys.readouterr().err == "signorini: explain: unknown key or code 'fricton'; did you mean 'friction'?\n"


def test_every_status_has_words(capsys):
    for outcome in Outcome:
        assert main(["explain", str(outcome)]) == 0
        assert outcome.advice[:20] in capsys.readouterr().out
