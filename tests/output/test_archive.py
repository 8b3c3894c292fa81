# SPDX-License-Identifier: BSD-3-Clause
"""Archives and decks that are written are read back exactly."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import signorini as sg
from signorini.attempt import MethodRun
from signorini.cli import main
from signorini.deck.write import write_deck
from signorini.errors import InputError
from signorini.gallery.cylinder import zhu_cylinder
from signorini.output.compare import compare
from signorini.output.dataclasses_json import from_plain, to_plain

DECKS = Path(__file__).parents[1] / "deck" / "inp" / "decks"


def plain(value: object) -> str:
    """Everything in a value, arrays spelled in full: equal only for equal values."""
    arrays: dict[str, list[object]] = {}

    def keep(path: str, array: np.ndarray, _: str) -> str:
        arrays[path] = array.tolist()
        return path

    return json.dumps([ordered(to_plain(value, "", keep)), arrays], sort_keys=True)


def ordered(part: object) -> object:
    """The order of names says nothing."""
    if isinstance(part, dict):
        members = {key: ordered(inner) for key, inner in part.items()}
        if members.get("$") in ("table", "proxy"):
            members["of"] = sorted(members["of"], key=lambda pair: str(pair[0]))
        return members
    return [ordered(inner) for inner in part] if isinstance(part, list) else part


@pytest.fixture(scope="module")
def solution() -> sg.Solution:
    return sg.solve(sg.read(DECKS / "two_blocks.inp"))


def test_an_archive_holds_everything_exactly(solution: sg.Solution, tmp_path: Path) -> None:
    solution.write(tmp_path / "all.h5")
    again = sg.load(tmp_path / "all.h5")
    assert type(again) is type(solution)
    assert plain({**vars(again)}) == plain({**vars(solution)})
    assert str(again) == str(solution)
    differences, words = compare(solution, again)
    assert words == []
    assert all(difference.largest == 0.0 for difference in differences)


def test_a_history_goes_on_from_an_archive(solution: sg.Solution, tmp_path: Path) -> None:
    whole = sg.read(DECKS / "two_blocks.inp")
    sg.solve(replace(whole, steps=whole.steps[:1])).write(tmp_path / "half.h5")
    second = sg.solve(replace(whole, steps=whole.steps[1:]), start=sg.load(tmp_path / "half.h5").end)
    assert np.array_equal(second.last.displacement, solution.last.displacement)


@pytest.mark.parametrize("name", [*(path.name for path in sorted(DECKS.glob("*.inp"))), "cylinder"])
def test_a_model_survives_its_deck(name: str, tmp_path: Path) -> None:
    model = zhu_cylinder(friction=0.4) if name == "cylinder" else sg.read(DECKS / name)
    write_deck(model, tmp_path / "deck.toml")
    expected = replace(model, mesh=replace(model.mesh, cell_word="cell"))  # in TOML nobody calls cells elements
    assert plain(vars(sg.read(tmp_path / "deck.toml"))) == plain(vars(expected))


NAMES = st.text(st.characters(codec="utf-8", exclude_categories=["Cs", "Cc", "Cf", "Zl", "Zp"]), min_size=1, max_size=6)


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(title=NAMES, force=st.floats(-1e100, 1e100), name=NAMES, tilt=st.floats(-1, 1))
def test_any_words_and_numbers_survive(
    tmp_path_factory: pytest.TempPathFactory, title: str, force: float, name: str, tilt: float
) -> None:
    block = sg.rectangle(width=1.0, height=1.0, nx=1, ny=1)
    model = sg.Model(
        block,
        title=title,
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3), formulation="incompatible")],
        supports=[sg.Support("left", u=(None, 0.0), name="held")],
        loads=[sg.Load("top", force=(force, None), name=name)] if name != "held" else [],
        contacts=[sg.Contact("bottom", sg.Circle(centre=(tilt, -1.0), radius=1.0), friction="stick")],
    )
    path = tmp_path_factory.mktemp("deck") / "deck.toml"
    write_deck(model, path)
    assert plain(vars(sg.read(path))) == plain(vars(model))


def test_results_are_compared(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = str(DECKS / "two_blocks.inp")
    changed = tmp_path / "deck.inp"
    changed.write_text(Path(deck).read_text().replace("-0.001", "-0.0011"))
    for source, folder in ((deck, "a"), (str(changed), "b")):
        assert main(["run", source, "-o", str(tmp_path / folder), "--quiet"]) == 0
    assert main(["diff", str(tmp_path / "a"), str(tmp_path / "a" / "solution.h5")]) == 0
    assert "none apart" in capsys.readouterr().out
    assert main(["diff", str(tmp_path / "a"), str(tmp_path / "b")]) == 1
    assert "Sslave: pressure" in capsys.readouterr().out
    assert main(["diff", str(tmp_path / "a"), str(tmp_path / "b"), "--tolerance", "0.5"]) == 0


@pytest.mark.parametrize("content", [None, b"", b"no archive", b"\x89HDF\r\n\x1a\n"])
def test_what_is_no_archive_is_refused(content: bytes | None, tmp_path: Path) -> None:
    path = tmp_path / "x.h5"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match="archive"):
        sg.load(path)


def test_another_version_is_refused() -> None:
    with pytest.raises(InputError, match="another version"):
        from_plain({"$": "class", "name": "Support", "of": {"on": "a"}}, lambda _: np.empty(0))


@pytest.mark.parametrize("ending", ["h5", "npz"])
def test_formats_from_before_are_refused_by_name(
    ending: str, solution: sg.Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    what, now, path = {"h5": ("archive", 7, tmp_path / "old.h5"), "npz": ("state", 6, tmp_path / "old.npz")}[ending]
    with monkeypatch.context() as before:
        before.setattr(
            f"signorini.output.{'archive' if ending == 'h5' else 'checkpoint'}._FORMAT", f"signorini {what} 5"
        )
        solution.write(path) if ending == "h5" else solution.save_state(path)
    with pytest.raises(InputError) as caught:
        sg.load(path) if ending == "h5" else sg.solve(solution.model, start=path)
    assert f"'{path}' is 'signorini {what} 5'; expected 'signorini {what} {now}'" in str(caught.value)


def test_files_from_before_a_class_was_renamed_are_read() -> None:
    written = {"method": "newton", "iterations": 3, "changes": {"$": "tuple", "of": [2, 0, 0]}, "end": "solved"}
    found = from_plain({"$": "class", "name": "Attempt", "of": written}, lambda _: np.empty(0))
    assert found == MethodRun(method="newton", iterations=3, changes=(2, 0, 0), end="solved")


def test_unknown_endings_are_refused(solution: sg.Solution) -> None:
    with pytest.raises(InputError, match=r"expected a name that ends in \.vtu"):
        solution.write("x.txt")


def test_names_that_the_page_promises_are_there_for_plain_h5py(tmp_path: Path) -> None:
    """Arrays stand under their documented paths where they occur first, short ones in the text."""
    import h5py

    page = (Path(__file__).parents[2] / "docs" / "howto" / "archive.md").read_text()
    model = sg.Model(
        sg.rectangle(width=40.0, height=2.0, nx=40, ny=2),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("left", u=(0, None))],
        loads=[sg.Load("top", pressure=3.0), sg.Load("right", traction=(0.5, 0.0))],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), friction=0.2)],
        steps=[sg.Step(at=[0.5])],
    )
    solution = sg.solve(model)
    solution.write(tmp_path / "solution.h5")
    promised = []
    for row in re.findall(r"^\| (`.+?`) \|", page, re.MULTILINE):
        first, *others = (name.strip("`") for name in row.split(", "))
        whole = [first, *(f"{first.rsplit('/', 1)[0]}{name}" for name in others)]
        promised += [name for name in whole if not name.startswith("end/")]
    assert len(promised) == 22
    fixed = {"FAMILY": "quad", "NAME": "block", "/K/": "/0/", "/I/": "/0/", "/C/": "/0/"}
    with h5py.File(tmp_path / "solution.h5") as file:
        assert file.attrs["format"] in page
        assert file.userblock_size == 512
        assert "structure" in file
        structure = json.loads(file["structure"].asstr()[()].split("\n", 1)[1])
        found = []
        for name in promised[1:]:
            for letter, value in fixed.items():
                name = name.replace(letter, value)
            part = structure
            for key in name.split("/"):
                inside = part["of"] if "$" in part else part
                part = (
                    dict(inside)[key]
                    if part.get("$") in ("table", "proxy")
                    else inside[int(key) if key.isdigit() else key]
                )
            assert part["path"] in file, name
            found.append(part["path"] == name)
        assert sum(found) >= 17  # the others are equal to one that stands elsewhere
        pressure = file["steps/0/instants/0/contacts/0/pressure"][...]
        assert pressure.tolist() == solution.at(load=0.5).contacts[0].pressure.tolist()
        assert (file["steps/0/displacement"][...] == solution.last.displacement).all()
        assert file["end/state/displacement"].shape == (2 * len(model.mesh.points),)
