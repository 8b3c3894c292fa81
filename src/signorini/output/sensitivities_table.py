# SPDX-License-Identifier: BSD-3-Clause
"""Sensitivities as text and as plain data."""

from __future__ import annotations

import math
from typing import Any

from signorini.output.table import align
from signorini.solution.sensitivities import Sensitivities, Validity


def sensitivities_table(found: Sensitivities) -> str:
    """Outputs by number, then a row for every parameter: per cent of each output, and where that holds."""
    numbers = [f"[{k}]" for k in range(1, len(found.outputs) + 1)]
    lines = ["answers at the end"]
    answers = zip(numbers, found.values, found.outputs, strict=True)
    lines += align([[number, f"{value:.6g}", words] for number, value, words in answers], right=(1,))
    lines += ["", "per cent of each for one per cent of"]
    rows = [["parameter", "value", *numbers, "holds from", "to"]]
    for name, given, row, holds in zip(found.parameters, found.given, found.per_cent, found.holds, strict=True):
        ends = _per_cent(holds.low), _per_cent(holds.high)
        rows.append([name, f"{given:.6g}", *(f"{part:.4f}" for part in row), *ends])
    lines += align(rows, right=range(1, len(rows[0])))
    told = [line for name, holds in zip(found.parameters, found.holds, strict=True) for line in _ends(name, holds)]
    refused = ["", "refused", *(f"  {words}" for words in found.refused)] if found.refused else []
    return "\n".join([*lines, *(["", "what ends that", *told] if told else []), *refused])


def sensitivities_data(found: Sensitivities) -> dict[str, Any]:
    """Plain data for other programs; None where nothing ends an interval."""
    rows = []
    for name, given, row, holds in zip(found.parameters, found.given, found.per_cent, found.holds, strict=True):
        told = {"low": _finite(holds.low), "high": _finite(holds.high), "ends": holds.ends}
        rows.append({"parameter": name, "value": float(given), "per_cent": row.tolist(), "holds_per_cent": told})
    outputs = [{"output": words, "value": float(at)} for words, at in zip(found.outputs, found.values, strict=True)]
    return {"outputs": outputs, "parameters": rows, "refused": list(found.refused)}


def _per_cent(change: float) -> str:
    return f"{change:+.3g} %" if math.isfinite(change) else "-"


def _finite(change: float) -> float | None:
    return change if math.isfinite(change) else None


def _ends(name: str, holds: Validity) -> list[str]:
    """What happens at the ends of the interval of a parameter."""
    ends = zip((holds.low, holds.high), holds.ends, strict=True)
    return [f"  {name} {_per_cent(change)}: {words}" for change, words in ends if words]
