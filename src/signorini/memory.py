# SPDX-License-Identifier: BSD-3-Clause
"""The memory that this process has held, and that there still is."""

from __future__ import annotations

import os
import sys
from pathlib import Path

try:
    import resource
except ImportError:  # Windows has no such module
    resource = None  # type: ignore[assignment]


def peak_memory() -> int:
    """Bytes; 0 where the system does not tell.

    >>> peak_memory() > 1_000_000 or sys.platform == "win32"
    True
    """
    if resource is None:
        return 0
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return int(peak if sys.platform == "darwin" else 1024 * peak)  # macOS counts bytes, Linux kilobytes


def available_memory() -> int:
    """Bytes that this process can still take without swapping; half of all where the system does not say.

    >>> available_memory() > 1_000_000
    True
    """
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
        return next(1024 * int(line.split()[1]) for line in lines if line.startswith("MemAvailable:"))
    except (OSError, StopIteration):
        pages = os.sysconf("SC_PHYS_PAGES") if hasattr(os, "sysconf") else 2**21
        return pages * 4096 // 2
