# SPDX-License-Identifier: BSD-3-Clause
"""The command line. Nothing heavy is imported before a command needs it: ``signorini --help`` answers at once."""

from signorini.cli.main import main

__all__ = ["main"]
