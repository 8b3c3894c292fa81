# SPDX-License-Identifier: BSD-3-Clause
"""Exit codes of the commands, and what they mean."""

from __future__ import annotations

DONE, FAILED, WRONG_INPUT, NO_SOLUTION, INTERRUPTED = 0, 1, 2, 3, 130

EXIT_CODES = {
    DONE: "Done; of a run: solved, and certified.",
    FAILED: "A check failed (verify, diff), an internal error, a disk that is full, or memory that ran out.",
    WRONG_INPUT: "The input is wrong: the message says where, what was found and what is expected.",
    NO_SOLUTION: (
        "No certified solution: the status and message in summary.json say why; what was solved before is written."
    ),
    INTERRUPTED: "Interrupted, by Ctrl-C or SIGTERM: the finished steps are written, and --from goes on from them.",
}
"""Code to its meaning."""
