# SPDX-License-Identifier: BSD-3-Clause
"""The verification suite as a page: what is computed, what it should be, how far it is off.

    python -m benchmarks.verification [--dry]

Writes the table of docs/verification.md; it is that of ``signorini verify --all``.
"""

from __future__ import annotations

from pathlib import Path

from benchmarks import command
from signorini.verify.check import Check
from signorini.verify.suite import QUICK, SLOW

PAGE = Path(__file__).parent.parent / "docs" / "verification.md"
ROUNDING = 1e-9


def line(check: Check) -> list[str]:
    """A row of the table; errors of rounding differ between machines, so that their digits are left out."""
    return [
        check.case,
        check.quantity,
        f"{check.computed:.6g}" if check.error > ROUNDING or check.reference else "0",
        f"{'at least ' if check.least else ''}{check.reference:.6g}",
        f"{check.error:.1e}" if check.error > ROUNDING else "rounding" if not check.least else "-",
        f"{check.tolerance:.1e}",
        check.source,
    ]


def table(checks: list[Check]) -> str:
    """As Markdown; a case is named in its first row."""
    head = ["case", "quantity", "computed", "reference", "error", "tolerance", "source"]
    rows = [head, ["---", "---", "---:", "---:", "---:", "---:", "---"]]
    last = ""
    for check in checks:
        row = line(check)
        row[0], last = (row[0] if row[0] != last else ""), row[0]
        rows.append([cell.replace("|", "\\|") for cell in row])
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def main() -> int:
    parser = command.parser(__doc__, dry=True)
    options = parser.parse_args()
    checks = []
    for name, cases in (("quick", QUICK), ("slow", SLOW)):
        checks += (found := [check for case in cases for check in case()])
        text = table(found)
        command.publish(options, name, text, PAGE)
    failed = [check for check in checks if not check.passed]
    print(f"{len(checks)} quantities, {len(failed)} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    raise SystemExit(main())
