# SPDX-License-Identifier: BSD-3-Clause
"""Which files a deck may name: engineers' ordinary ones, and none that the sender of a deck has no business with."""

import os
from pathlib import Path

import pytest

from signorini.cli import main
from signorini.deck import DeckError, load_deck
from signorini.deck.inp.syntax import read_cards
from signorini.errors import InputError
from signorini.sources import Reach

pytestmark = pytest.mark.skipif(os.name == "nt", reason="links and pipes are made otherwise there")

NODES = "*NODE\n1, 0., 0.\n"


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    """A deck in ``home/project/cases/a``, its neighbours, and a secret."""
    folder = tmp_path / "home" / "project" / "cases" / "a"
    folder.mkdir(parents=True)
    for name in ("more/nodes.inc", "../nodes.inc", "../../common/nodes.inc", "../../../nodes.inc", "../.ssh/id"):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(NODES)
    (folder / ".git").mkdir()
    (folder / ".git" / "config").write_text(NODES)
    (folder / "link.inc").symlink_to(folder / "../../../nodes.inc")
    os.mkfifo(folder / "pipe.inc")
    return folder / "deck.inp"


@pytest.mark.parametrize("name", ["more/nodes.inc", "../nodes.inc", "../../common/nodes.inc", "absolute"])
def test_near_files_are_read(deck: Path, name: str) -> None:
    path = str((deck.parent / "more" / "nodes.inc").resolve()) if name == "absolute" else name
    deck.write_text(f"*INCLUDE, INPUT={path}\n")
    assert [card.keyword for card in read_cards(deck)] == ["NODE"]


FAR = {
    "../../../nodes.inc": r"lies in .*home, not near the deck \(below .*project\); .* --allow .*home$",
    "link.inc": r"'link\.inc' lies in .*home, not near the deck",
    "../.ssh/id": "hidden, in or as '.ssh'",
    ".git/config": "hidden, in or as '.git'",
    "more": "is a folder; expected a file",
    "pipe.inc": "is a device or a pipe; expected a file",
    "/dev/zero": "lies in /dev, not near",
    "https://example.org/nodes.inc": "on a network",
    r"\\server\share\nodes.inc": "on a network",
    "//server/share/nodes.inc": "on a network",
    "x" * 5000: r"xxx\.\.\.' cannot be read",
}


@pytest.mark.parametrize("name", FAR)
def test_others_are_refused(deck: Path, name: str) -> None:
    """In every place where a deck names a file."""
    deck.write_text(f"*NODE\n1, 0., 0.\n*INCLUDE, INPUT={name}\n")
    with pytest.raises(DeckError, match=rf"deck\.inp:3: \*INCLUDE: .*{FAR[name]}"):
        read_cards(deck)
    toml = deck.with_name("deck.toml")
    toml.write_text(f"[mesh]\nfile = '{name}'\n[material.a]\nE = 1.0\nnu = 0.0\n[[body]]\nname = 'b'\nmaterial = 'a'\n")
    with pytest.raises(DeckError, match=rf"deck\.toml:2: mesh\.file: .*{FAR[name]}"):
        load_deck(toml)
    head = (
        "[mesh]\ngenerator = 'rectangle'\n[material.a]\nE = 1.0\nnu = 0.0\n[[body]]\nname = 'block'\nmaterial = 'a'\n"
    )
    toml.write_text(f"{head}[[contact]]\nnonmortar = 'bottom'\nprofile = {{ file = '{name}' }}\n")
    with pytest.raises(DeckError, match=rf"deck\.toml:11: contact\[0\]\.profile\.file: .*{FAR[name]}"):
        load_deck(toml)


def test_the_user_can_allow_more(deck: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck.write_text("*INCLUDE, INPUT=../../../nodes.inc\n")
    home = deck.parents[3]
    assert len(read_cards(deck, Reach.of(deck, [home]))) == 1
    assert main(["check", str(deck)]) == 2
    assert f"--allow {home}" in capsys.readouterr().err
    assert main(["check", str(deck), "--allow", str(home)]) == 2
    assert "not near" not in capsys.readouterr().err
    assert main(["check", str(deck), "--allow", str(deck)]) == 2
    assert capsys.readouterr().err == f"signorini: --allow: there is no folder '{deck}'\n"
    deck.write_text("*INCLUDE, INPUT=../../../../home/project/cases/.ssh/id\n")
    with pytest.raises(InputError, match="hidden"):  # what is hidden stays so in what is allowed
        read_cards(deck, Reach.of(deck, [home]))


def test_names_are_looked_for_in_folders_that_are_included(deck: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The folder of the deck comes first; a folder that is included is left by no name, as that of the deck is not."""
    home = deck.parents[3]
    library = home / "library"
    library.mkdir()
    library.joinpath("common.inc").write_text("*NODE\n7, 0., 0.\n")
    library.parent.joinpath("outside.inc").write_text("*NODE\n8, 0., 0.\n")
    deck.write_text("*INCLUDE, INPUT=common.inc\n")
    reach = Reach.of(deck, search=[library])
    assert read_cards(deck, reach)[0].path == library / "common.inc"
    deck.with_name("common.inc").write_text("*NODE\n1, 0., 0.\n")
    assert read_cards(deck, reach)[0].path == deck.with_name("common.inc")
    deck.write_text("*INCLUDE, INPUT=../../outside.inc\n")
    with pytest.raises(InputError, match=r"there is no file|not near"):
        read_cards(deck, reach)
    deck.write_text("*INCLUDE, INPUT=../outside.inc\n")
    with pytest.raises(InputError, match="not near"):
        read_cards(deck, reach)
    assert main(["check", str(deck), "--include", str(deck)]) == 2
    assert capsys.readouterr().err == f"signorini: --include: there is no folder '{deck}'\n"


def test_the_root_of_the_file_system_is_near_to_nothing() -> None:
    assert Reach(folder=Path("/a/b")).top == Path("/a")
    with pytest.raises(InputError, match="not near"):
        Reach(folder=Path("/")).file("etc/passwd")


def test_a_file_that_does_not_fit_into_memory(deck: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("signorini.memory.available_memory", lambda: 10)
    deck.write_text("*INCLUDE, INPUT=more/nodes.inc\n")
    with pytest.raises(DeckError, match=r"nodes\.inc' takes 1\.6e-08 GB of memory; there are 1e-08 GB"):
        read_cards(deck)
