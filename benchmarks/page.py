# SPDX-License-Identifier: BSD-3-Clause
"""Tables of docs/performance.md, each between two markers, written by the script that measured it."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

PAGE = Path(__file__).parent.parent / "docs" / "performance.md"
KEEP_MEMORY = {"MALLOC_MMAP_MAX_": "0", "MALLOC_TRIM_THRESHOLD_": str(10**12)}
"""The C library's settings to hand no memory back: otherwise whichever solve comes after a long pause pays for new
pages, which on a virtual machine cost as much as the computing. All codes gain."""


def thread_environment(number: int) -> dict[str, str]:
    """Environment variables that give every library so many threads."""
    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
    made = dict.fromkeys(names, str(number))
    # one thread of MKL's other layer spins beside the one that works
    return made | ({"MKL_THREADING_LAYER": "SEQUENTIAL"} if number == 1 else {})


ONE_THREAD = thread_environment(1)


def measured(module: str, *options: object, keep: bool = True) -> list[dict[str, Any]]:
    """What a benchmark prints as JSON, ``--one`` with options, in a process of its own on one thread.

    Parameters
    ----------
    keep : whether the process keeps freed memory; not where its memory is measured
    """
    command = [sys.executable, "-m", module, "--one", *map(str, options)]
    environment = {**os.environ, **ONE_THREAD, **(KEEP_MEMORY if keep else {})}
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment)
    rows: list[dict[str, Any]] = json.loads(done.stdout)
    return rows


def table(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A Markdown table; the first column is text, the others are numbers."""
    lines = [list(head), ["---", *["---:"] * (len(head) - 1)], *([str(cell) for cell in row] for row in rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def write(name: str, text: str, page: Path = PAGE) -> None:
    """Put a text between the markers of a name; they must be there already."""
    begin, end = markers(name)
    before, found, rest = page.read_text(encoding="utf-8").partition(begin)
    _, closed, after = rest.partition(end)
    if not (found and closed):
        raise SystemExit(f"{page} lacks the line '{begin}' or '{end}'")
    page.write_text(f"{before}{begin}\n{text.strip()}\n{end}{after}", encoding="utf-8")


def markers(name: str) -> tuple[str, str]:
    return f"<!-- {name}: written by its script -->", f"<!-- end of {name} -->"


def machine() -> str:
    """Processor and number of cores, as far as the system tells."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [line.partition(":")[2].strip() for line in info.read_text().splitlines() if "model name" in line]
        model = names[0] if names else model
    return f"{model}, {os.cpu_count()} cores"


def seconds(value: float) -> str:
    """Three digits.

    >>> seconds(0.01234), seconds(12.34), seconds(123.4)
    ('0.0123', '12.3', '123')
    """
    return f"{value:.3g}" if value < 100 else f"{value:.0f}"


def gigabytes(size: float) -> str:
    return f"{size / 1e9:.2f}"


def peak_memory(process: int | str = "self") -> int:
    """Bytes that a running process has held at most; what its parent held before it is not counted."""
    status = Path(f"/proc/{process}/status").read_text().splitlines()
    return 1024 * next(int(line.split()[1]) for line in status if line.startswith("VmHWM"))
