# SPDX-License-Identifier: BSD-3-Clause
"""Turns of processes at a file."""

import threading

import pytest

from signorini import turn
from signorini.turn import Turn

pytest.importorskip("fcntl")


def test_one_has_the_turn_and_the_others_wait_until_it_ends(tmp_path):
    path = tmp_path / "folder" / "loop.turn"
    one, two = Turn(str(path)), Turn(str(path))
    assert one.free()
    assert two.free()
    assert not one.waited()
    assert one.free()  # its own
    assert not two.free()
    threading.Timer(0.1, one.end).start()
    assert two.waited()
    assert not one.free()
    two.end()
    two.end()
    assert one.free()
    assert not path.exists()


def test_who_hangs_with_the_turn_is_not_waited_for_without_end(tmp_path, monkeypatch):
    monkeypatch.setattr(turn, "LONGEST_WAIT", 0.05)
    one, two = (Turn(str(tmp_path / "loop.turn")) for _ in range(2))
    assert not one.waited()
    assert two.waited()
    two.end()
    assert not two.free()
    one.end()


def test_where_no_file_can_be_made_or_locked_everybody_has_the_turn(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    one, two = (Turn(str(tmp_path / "file" / "loop.turn")) for _ in range(2))
    assert (one.waited(), two.waited(), two.free()) == (False, False, True)
    monkeypatch.setattr(turn, "_locks", lambda: None)
    one, two = (Turn(str(tmp_path / "loop.turn")) for _ in range(2))
    assert (one.waited(), two.waited(), two.free()) == (False, False, True)
