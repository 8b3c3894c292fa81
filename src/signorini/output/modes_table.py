# SPDX-License-Identifier: BSD-3-Clause
"""Natural modes and the damping of a joint as text."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from signorini.output.table import align
from signorini.solution.damping import JointDamping
from signorini.solution.modes import NaturalModes


def modes_table(modes: Mapping[str, NaturalModes], about: str) -> str:
    """Frequencies, a column for every state of the joints, and the certificate.

    Parameters
    ----------
    modes : by state of the joints
    about : words for the state that bodies vibrate about
    """
    several = len(modes) > 1
    rows = [["mode", *(f"{joint} joint" if several else "frequency" for joint in modes)]]
    count = len(next(iter(modes.values())))
    rows += [[str(k + 1), *(f"{own.frequencies[k]:.6g}" for own in modes.values())] for k in range(count)]
    residual = max(float(own.residuals.max()) for own in modes.values())
    products = max(own.orthogonality for own in modes.values())
    parting = max(own.parting for own in modes.values())
    uncounted = any(own.missed is None for own in modes.values())
    counted = "not counted" if uncounted else "none is missing, by the inertia of K - sigma M"
    return "\n".join(
        [
            f"natural frequencies {about}, cycles per time",
            *align(rows, right=range(len(rows[0]))),
            f"  residual {residual:.1e}, orthogonality {products:.1e}, parting {parting:.1e}; {counted}",
        ]
    )


def damping_table(damping: JointDamping) -> str:
    """Frequency and damping ratio by amplitude, with the exponent of the dissipation."""
    rows = [["amplitude", "frequency", "over stuck", "damping ratio", "dissipation", "exponent", "closure"]]
    exponents = np.concatenate([[np.nan], damping.exponents])
    for k, loop in enumerate(damping.loops):
        rows.append(
            [
                f"{damping.amplitudes[k]:.4g}",
                f"{damping.frequencies[k]:.6g}",
                f"{damping.frequencies[k] / damping.frequency:.5f}",
                f"{loop.ratio:.3e}",
                f"{loop.dissipation:.4g}",
                "" if math.isnan(exponents[k]) else f"{exponents[k]:.2f}",
                f"{loop.closure:.0e}",
            ]
        )
    lines = [
        f"mode {damping.mode} of the stuck joint ({damping.frequency:.6g} cycles per time) by amplitude, the largest "
        "displacement of a node",
        *align(rows, right=range(7)),
    ]
    if damping.message:
        lines.append(f"  no loop beyond: {damping.message.splitlines()[0]}")
    return "\n".join(lines)
