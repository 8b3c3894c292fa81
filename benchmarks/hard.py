# SPDX-License-Identifier: BSD-3-Clause
"""What answers the steps of the hard set, as a table of docs/robust_friction.md, and how many solutions they have.

    python -m benchmarks.hard

``signorini bench hard`` counts the same.
"""

from __future__ import annotations

from signorini.bench.equilibria import equilibria
from signorini.bench.hard import RIVALS, HardReport, hard

METHODS = ("newton", "path open", "path press", "path among touching", "springs", "tree")
PROOFS = ("proved: rigid motions", "proved: tree")
OTHER = ("escape named", "no answer")


def table(report: HardReport) -> str:
    """As Markdown, held bodies first; then what was left without an answer."""
    columns = ("steps", *METHODS, *PROOFS, *OTHER, *RIVALS)
    lines = ["| " + " | ".join(("bodies", *columns)) + " |", "|---" * (len(columns) + 1) + "|"]
    for name, counts in (("held", report.held), ("floating", report.floating)):
        lines.append("| " + " | ".join([name, *(str(counts.get(key, 0)) for key in columns)]) + " |")
    lines.append(
        f"\n{report.problems} problems; {report.negative} certified steps with index -1 (more solutions exist)"
    )
    return "\n".join(lines + [f"no answer: {name}" for name in report.unanswered])


if __name__ == "__main__":
    found = hard()
    print(table(found), equilibria(found.certified), sep="\n\n")
