# SPDX-License-Identifier: BSD-3-Clause
"""The gallery: a page with a picture and a number beside its reference for every problem of ``examples/gallery``.

    python -m website.gallery [FOLDER]

runs them all and writes ``gallery.md`` and its pictures into a folder (default: docs). Every problem is a script of
cells, ``# %%``, which defines ``figure``, and ``found`` beside ``known``, ``within`` of each other; the site offers it
as a notebook, too.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl

ROOT = Path(__file__).parents[1]
SCRIPTS = ROOT / "examples" / "gallery"

WORDS = {
    "fretting_pad": "stick over contact, Cattaneo and Mindlin",
    "press_fit": "torque at which it slides, N m",
    "bolted_joint": "force of the bolt at a pull of 9 kN, kN",
    "bearing_ball": "largest pressure, Hertz, MPa",
    "dovetail": "force on the flank, kN per mm",
    "gear_teeth": "largest pressure, Hertz, MPa",
    "seal": "squeezed by, over its thickness, Johnson",
    "wheel_on_rail": "largest pressure, Hertz' ellipse, MPa",
    "hip_cup": "largest pressure, a layer of columns, MPa",
    "fault": "largest slip, infinite body, mm",
    "closing_crack": "closes at, infinite body, MPa",
    "joint_damping": "damping ratio, microslip of a bar",
}
"""Problems in order, and what the number of each is."""

HEAD = """# Gallery

Problems of those who use contact programs: each is a script of some fifty lines that runs as it stands, draws a picture
and compares one number with a closed form. The page is written by `python -m website.gallery`, and a test runs every
script; the site offers them as notebooks.

![18,000 cycles of fretting wear, one by one](figures/fretting_wear.png)

The demonstration: a cylinder frets on a flat for 18,000 cycles, each of them followed and certified; beside it what
jumps over cycles and increments cost. Data, tables and the command that runs it are in [wear](wear.md).

| problem | number | found | reference | apart |
|---|---|---:|---:|---:|
"""


def cells(name: str) -> Iterator[tuple[str, str]]:
    """Kind, "markdown" or "code", and text of every cell of a script."""
    parts = re.split(r"^# %%(.*)\n", (SCRIPTS / f"{name}.py").read_text(), flags=re.MULTILINE)[1:]
    for mark, text in zip(parts[::2], parts[1::2], strict=True):
        if "markdown" in mark:
            yield "markdown", re.sub(r"^# ?", "", text, flags=re.MULTILINE).strip()
        else:
            yield "code", text.strip()


def notebook(name: str) -> dict[str, Any]:
    """A script as a notebook, format 4.5."""
    found: list[dict[str, Any]] = []
    for i, (kind, text) in enumerate(cells(name)):
        cell: dict[str, Any] = {"cell_type": kind, "id": f"{name}-{i}", "metadata": {}}
        cell["source"] = text.splitlines(keepends=True)
        found.append(cell | ({"execution_count": None, "outputs": []} if kind == "code" else {}))
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": found, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def run(name: str) -> dict[str, Any]:
    """What the cells of a script have defined, one after the other as a notebook runs them."""
    names: dict[str, Any] = {"__name__": "gallery"}
    for kind, text in cells(name):
        if kind == "code":
            exec(compile(text, f"{name}.py", "exec"), names)
    return names


def write_notebooks(folder: Path) -> None:
    """All problems as notebooks."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in WORDS:
        (folder / f"{name}.ipynb").write_text(json.dumps(notebook(name), indent=1) + "\n")


def write_page(folder: Path) -> None:
    """Run all problems; the page and its pictures."""
    mpl.use("agg")
    from matplotlib import pyplot

    pictures = folder / "figures" / "gallery"
    pictures.mkdir(parents=True, exist_ok=True)
    rows, parts = [], []
    for name, words in WORDS.items():
        names = run(name)
        title, text = next(cells(name))[1].split("\n", 1)
        title = title.lstrip("# ")
        found, known = float(names["found"]), float(names["known"])
        anchor = title.lower().replace(" ", "-")
        rows.append(f"| [{title}](#{anchor}) | {words} | {found:.5g} | {known:.5g} | {apart(found, known)} |")
        names["figure"].savefig(pictures / f"{name}.png", dpi=110)
        link = f"[{name}.py](../examples/gallery/{name}.py)"  # the site says where its notebook is
        parts.append(f"## {title}\n\n{text.strip()}\n\n![{title}](figures/gallery/{name}.png)\n\n{link}")
        pyplot.close("all")
    (folder / "gallery.md").write_text(HEAD + "\n".join(rows) + "\n\n" + "\n\n".join(parts) + "\n")


def apart(found: float, known: float) -> str:
    """Of the reference, in per cent; less than a millionth of it is rounding."""
    share = found / known - 1.0
    return "0" if abs(share) < 1e-6 else f"{100.0 * share:.2g} %"


if __name__ == "__main__":
    write_page(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs")
