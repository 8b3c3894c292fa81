# SPDX-License-Identifier: BSD-3-Clause
"""``signorini mcp``: the door to the server, which an extra is needed for."""

from __future__ import annotations

import argparse

from signorini.errors import InputError


def mcp(options: argparse.Namespace) -> int:
    """Serve until whoever asks has left.

    Raises
    ------
    InputError
        If the package ``mcp`` is not installed.
    """
    del options
    try:
        from signorini.cli.mcp_server import server
    except ImportError as error:
        words = f"needs the package 'mcp' ({error}); expected pip install 'signorini[mcp]'"
        raise InputError(words, where=("mcp",)) from error
    server.run("stdio")
    return 0
