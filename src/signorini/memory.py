# SPDX-License-Identifier: BSD-3-Clause
"""The most memory that this process has held."""

from __future__ import annotations

import sys

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
