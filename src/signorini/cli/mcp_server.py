# SPDX-License-Identifier: BSD-3-Clause
"""A server of the Model Context Protocol: agents check, run and look at decks by the commands that people use.

Every tool starts the command of its name, so that a long solve neither blocks the server nor outlives a request that is
cancelled, and what is refused is an answer with the line and reason that the command line prints.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path
from subprocess import DEVNULL
from typing import Annotated, Any

import anyio
from anyio.streams.text import TextReceiveStream
from mcp.server.mcpserver import Context, Image, MCPServer
from mcp.types import ToolAnnotations
from pydantic import Field

from signorini._version import __version__
from signorini.cli.exit_codes import DONE, EXIT_CODES, NO_SOLUTION, WRONG_INPUT
from signorini.cli.parser import PICTURES
from signorini.errors import one_of

_INSTRUCTIONS = (
    "Frictional elastic contact by finite elements. Write a deck as TOML (schema has its tables, explain its keys) or "
    "take an Abaqus or CalculiX deck; check it, run it, then read the table, plot or report its result folder. Every "
    "answer has an exit code: 0 done, 2 the input is wrong (the message has file, line, key and what is expected), 3 "
    "no certified solution."
)
_PROGRESS = re.compile(r"signorini: \d+ s, (\d+)%: (.*)")

_CHOICES = (
    "what the picture shows: step (number or name), load (part of it that is behind, 0 to 1), component (von_mises, "
    "principal, xx, ... or magnitude, x, ...), range [min, max], zoom [x from, x to, y from, y to, ...], "
    "scale of displacements"
)

Choice = str | int | float | list[float]
Deck = Annotated[str, Field(description="path of a deck: *.toml, or *.inp of Abaqus or CalculiX")]
Folder = Annotated[str, Field(description="result folder that the tool run has written")]
Allowed = Annotated[tuple[str, ...], Field(description="folders besides its own that the deck may name files in")]

server = MCPServer("signorini", version=__version__, instructions=_INSTRUCTIONS, log_level="ERROR")
_READS = ToolAnnotations(read_only_hint=True, open_world_hint=False)
_WRITES = ToolAnnotations(read_only_hint=False, destructive_hint=False, open_world_hint=False)


@server.tool(annotations=_READS)
async def check(deck: Deck, allow: Allowed = ()) -> dict[str, Any]:
    """Say how a deck is understood and what looks wrong (`found.notes`); solves nothing."""
    return await _answer("check", "--json", *_allowing(allow), "--", deck, as_json=True)


@server.tool(annotations=_WRITES)
async def run(
    deck: Deck,
    context: Context,
    folder: Annotated[str, Field(description="where results go; empty: out/ and the name of the deck")] = "",
    accuracy: Annotated[str, Field(description="relative error of the pressures to refine to, 0.01 say")] = "",
    allow: Allowed = (),
) -> dict[str, Any]:
    """Solve a deck and certify the solution: `found` is a table of forces, pressures and the certificate.

    `summary` is summary.json without the lists of events; all files are in `folder`.

    Parameters
    ----------
    deck, folder, accuracy, allow : as of `signorini run`
    context : of the request, which is told how far the solve is
    """
    place = Path(folder) if folder else Path("out", Path(deck).stem)
    fine = [f"--accuracy={accuracy}"] if accuracy else []
    answer = await _answer("run", "-o", str(place), *fine, *_allowing(allow), "--", deck, context=context)
    file = place / "summary.json"
    if answer["exit_code"] in (DONE, NO_SOLUTION) and file.is_file():
        summary = json.loads(file.read_text(encoding="utf-8"))
        for step in summary["steps"]:
            step.pop("event_list", None)
        answer |= {"folder": str(place), "summary": summary}
    return answer


@server.tool(annotations=_WRITES)
async def sweep(
    deck: Deck,
    values: Annotated[dict[str, str], Field(description="key to 'FROM:TO:NUMBER' or values between commas")],
    context: Context,
    folder: Annotated[str, Field(description="where the table goes, and a sweep goes on; empty: out/DECK_sweep")] = "",
    allow: Allowed = (),
) -> dict[str, Any]:
    """Solve a deck with all combinations of values of some keys, as friction.CONTACT, load.NAME (a factor) or mesh.nx.

    `found` is the table; all answers are in sweep.csv of the folder.

    Parameters
    ----------
    deck, values, folder, allow : as of `signorini sweep`
    context : of the request, which is told how many rows are solved
    """
    place = Path(folder) if folder else Path("out", f"{Path(deck).stem}_sweep")
    asked = [f"--set={key}={given}" for key, given in values.items()]
    answer = await _answer("sweep", "-o", str(place), *asked, *_allowing(allow), "--", deck, context=context)
    return answer | {"folder": str(place)}


@server.tool(annotations=_WRITES)
async def report(folder: Folder) -> dict[str, Any]:
    """Write all results as one HTML page; `found` is its path."""
    return await _answer("report", "--", folder)


@server.tool(annotations=_WRITES, structured_output=False)
async def plot(
    folder: Folder,
    what: Annotated[str, Field(description=f"one of {', '.join(PICTURES)}")] = "contact",
    choices: Annotated[dict[str, Choice] | None, Field(description=_CHOICES)] = None,
) -> list[str | Image]:
    """Draw results: the picture, and what the command says of it.

    Parameters
    ----------
    folder, what : as of `signorini plot`
    choices : option to its value
    """
    file = Path(folder) / f"{what}.png"
    asked = []
    for name, value in (choices or {}).items():
        asked += [f"--{name}", *map(str, value if isinstance(value, list) else [value])]
    answer = await _answer("plot", f"--what={what}", *asked, "-o", str(file), "--", folder)
    return [json.dumps(answer), *([Image(path=file)] if answer["exit_code"] == DONE else [])]


@server.tool(annotations=_READS)
async def explain(
    word: Annotated[str, Field(description="a key of decks, with its table or without, a status, an exit code")],
) -> dict[str, Any]:
    """Say what a key of decks, a status, an exit code or a number of a certificate means."""
    return await _answer("explain", "--", word)


@server.tool(annotations=_READS)
async def schema(
    table: Annotated[str, Field(description="a table of decks, contact say; empty: the names of all")] = "",
) -> dict[str, Any]:
    """JSON schema of a table of TOML decks, or of all that is not a table with the names of the tables."""
    answer = await _answer("schema", as_json=True)
    tables = answer["found"]["properties"]
    if not table:
        return answer | {"found": sorted(tables)}
    if table not in tables:
        return _spoken(WRONG_INPUT, one_of(table, tables, "table"), "")
    return answer | {"found": tables[table]}


def _allowing(folders: Sequence[str]) -> list[str]:
    return [f"--allow={folder}" for folder in folders]


async def _answer(*arguments: str, context: Context | None = None, as_json: bool = False) -> dict[str, Any]:
    """What a command says, see `_told`."""
    answer = await _told([sys.executable, "-m", "signorini", *arguments], context)
    return answer | {"found": json.loads(answer["found"])} if as_json and answer["exit_code"] == DONE else answer


async def _told(command: Sequence[str], context: Context | None) -> dict[str, Any]:
    """Run a program and say what it said.

    Parameters
    ----------
    command : the program and its arguments
    context : of the request, which is told how far a solve is; None: nobody is told

    Returns
    -------
    ``exit_code`` and its ``meaning``, ``message`` on what is wrong, and what was ``found``
    """
    said: list[str] = []

    async def say(line: str) -> None:
        step = _PROGRESS.fullmatch(line)
        if step is None:
            said.append(line)
        elif context is not None:
            await context.report_progress(float(step[1]), 100.0, step[2])

    code, out = await _ended(command, say)
    return _spoken(code, "\n".join(said).removeprefix("signorini: "), out.strip())


async def _ended(command: Sequence[str], say: Callable[[str], Awaitable[None]]) -> tuple[int, str]:
    """Exit code and output of a program, whose lines on standard error are said as they come; it ends with the task."""
    out = ""
    async with await anyio.open_process(command, stdin=DEVNULL) as process, anyio.create_task_group() as tasks:
        assert process.stdout is not None
        assert process.stderr is not None
        tasks.start_soon(_lines, TextReceiveStream(process.stderr), say)
        async for part in TextReceiveStream(process.stdout):
            out += part
        code = await process.wait()
    return code, out


async def _lines(stream: TextReceiveStream, say: Callable[[str], Awaitable[None]]) -> None:
    rest = ""
    async for part in stream:
        *lines, rest = (rest + part).split("\n")
        for line in lines:
            await say(line)
    if rest:
        await say(rest)


def _spoken(code: int, message: str, found: Any) -> dict[str, Any]:
    """An answer, see `_told`."""
    return {"exit_code": code, "meaning": EXIT_CODES.get(code, ""), "message": message, "found": found}
