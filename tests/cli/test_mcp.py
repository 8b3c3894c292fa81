# SPDX-License-Identifier: BSD-3-Clause
"""The server for agents, spoken to by the client of the protocol's own package."""

import asyncio
import contextlib
import io
import json
import os
import sys
from pathlib import Path

import pytest

import signorini
from signorini.cli import main

DECK = """kind = "plane strain"
[mesh]
generator = "rectangle"
[material.soft]
E = 100.0
nu = 0.0
[[body]]
name = "block"
material = "soft"
[[support]]
on = "left"
u = [0, "free"]
[[load]]
on = "top"
pressure = 3.0
[[contact]]
nonmortar = "bottom"
plane = { point = [0, 0], normal = [0, 1] }
"""


@pytest.fixture
def deck(tmp_path):
    path = tmp_path / "deck.toml"
    path.write_text(DECK)
    return path


def conversation(server, *questions):
    """What a client is answered: lists of contents, or the data where there are any."""
    mcp = pytest.importorskip("mcp")

    async def talk():
        answers = []
        async with mcp.Client(server) as client:
            tools = await client.list_tools()
            assert {tool.name for tool in tools.tools} == {
                "check",
                "run",
                "sweep",
                "report",
                "plot",
                "explain",
                "schema",
            }
            for name, arguments in questions:
                found = await client.call_tool(name, arguments)
                assert not found.is_error, found
                answers.append(found.structured_content or found.content)
        return answers

    return asyncio.run(talk())


def test_without_its_package_the_server_says_what_to_install(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "mcp", None)
    monkeypatch.setitem(sys.modules, "mcp.server.mcpserver", None)
    monkeypatch.delitem(sys.modules, "signorini.cli.mcp_server", raising=False)
    assert main(["mcp"]) == 2
    assert "pip install 'signorini[mcp]'" in capsys.readouterr().err


@pytest.mark.slow
def test_over_standard_input_a_refusal_is_an_answer_with_its_line(deck):
    """The true program at the other end of a pipe."""
    mcp = pytest.importorskip("mcp")
    deck.write_text(DECK.replace("nu = ", "mu = "))
    home = str(Path(signorini.__file__).parents[1])
    place = os.environ | {"PYTHONPATH": os.pathsep.join([home, os.environ.get("PYTHONPATH", "")])}
    start = mcp.StdioServerParameters(command=sys.executable, args=["-m", "signorini", "mcp"], env=place)
    (refused,) = conversation(start, ("run", {"deck": str(deck)}))
    assert refused["exit_code"] == 2
    assert refused["message"] == f"{deck}:6: material.soft.mu: unknown key. Known: E, nu, density, expansion, plastic"
    assert "summary" not in refused


@pytest.fixture
def here(monkeypatch):
    """The server, whose commands run in this process, which has loaded already what they need."""
    pytest.importorskip("mcp")
    from signorini.cli import mcp_server

    async def ended(command, say):
        assert command[:3] == [sys.executable, "-m", "signorini"]
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                code = main(command[3:])
            except SystemExit as left:
                code = left.code
        for line in err.getvalue().splitlines():
            await say(line)
        return code, out.getvalue()

    monkeypatch.setattr(mcp_server, "_ended", ended)
    return mcp_server.server


@pytest.mark.slow
def test_an_agent_checks_solves_and_sees_a_deck(here, deck, tmp_path):
    folder = str(tmp_path / "out")
    understood, solved, drawn, undrawn, page, swept = conversation(
        here,
        ("check", {"deck": str(deck)}),
        ("run", {"deck": str(deck), "folder": folder}),
        ("plot", {"folder": folder, "what": "stress", "choices": {"component": "yy", "step": 1, "range": [-5, 0]}}),
        ("plot", {"folder": folder, "what": "stresses"}),
        ("report", {"folder": folder}),
        ("sweep", {"deck": str(deck), "values": {"load.top": "1,2"}, "folder": str(tmp_path / "sweep")}),
    )
    assert understood["found"]["contacts"][0]["pairs"] == 2
    assert "certificate passed" in solved["found"]
    assert (solved["exit_code"], solved["summary"]["status"], solved["folder"]) == (0, "solved", folder)
    assert "event_list" not in solved["summary"]["steps"][0]
    assert json.loads(drawn[0].text)["meaning"].startswith("Done")
    assert drawn[1].mime_type == "image/png"
    assert len(undrawn) == 1
    assert swept["exit_code"] == 0
    assert swept["found"].count("certified") == 2
    assert "invalid choice: 'stresses'" in json.loads(undrawn[0].text)["message"]
    assert Path(page["found"]).read_text().startswith("<!doctype html>")


def test_an_agent_asks_what_words_mean(here):
    meaning, tables, table, unknown = conversation(
        here,
        ("explain", {"word": "contact.friction"}),
        ("schema", {}),
        ("schema", {"table": "contact"}),
        ("schema", {"table": "contract"}),
    )
    assert meaning["found"].startswith("contact.friction")
    assert "contact" in tables["found"]
    assert "friction" in table["found"]["items"]["properties"]
    assert unknown["exit_code"] == 2
    assert "did you mean 'contact'" in unknown["message"]


def test_a_long_solve_tells_how_far_it_is():
    """A command that says what `run` says to a pipe, in pieces that end within lines."""
    pytest.importorskip("mcp")
    from signorini.cli import mcp_server

    told = []

    class Request:
        async def report_progress(self, *values):
            told.append(values)

    program = (
        "import sys, time\n"
        "for part in ('signorini: 5 s, 30%: step 1\\nsigno', 'rini: no certified solution', ' (jump): why'):\n"
        "    sys.stderr.write(part); sys.stderr.flush(); time.sleep(0.05)\n"
        "print('a table'); sys.exit(3)"
    )
    command = [sys.executable, "-S", "-c", program]
    answer = asyncio.run(mcp_server._told(command, context=Request()))
    assert told == [(30.0, 100.0, "step 1")]
    assert answer["exit_code"] == 3
    assert answer["message"] == "no certified solution (jump): why"
    assert answer["found"] == "a table"
