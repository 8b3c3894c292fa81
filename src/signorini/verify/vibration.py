# SPDX-License-Identifier: BSD-3-Clause
"""B18: natural frequencies, and what a joint damps."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from signorini.api import solve
from signorini.gallery.sectors import SECTORS, ring_on_shaft
from signorini.gallery.vibrating import bar_in_a_bed, plane_bar, thin_disc
from signorini.model.modes import SLIPPING, STUCK
from signorini.reference.vibration import bar_frequencies, disc_frequencies, free_beam_frequencies
from signorini.verify.check import Check, checks_of, farthest
from signorini.vibration.damping import joint_damping
from signorini.vibration.modes import natural_modes

_SPEED = 10.0  # of waves along the bars of the gallery
_NU = 0.3  # of the disc
_WAVES = 20  # modes of the ring: six of a sector for every number of waves are more


def frequencies() -> Iterator[Check]:
    """A bar clamped and free, a free beam, a disc; and how fast the frequency of the disc converges."""
    clamped = natural_modes(plane_bar(1.0, 0.1, (16, 1), guided=True, clamped=True), 3).frequencies
    free = natural_modes(plane_bar(1.0, 0.1, (16, 1), guided=True, clamped=False), 4).frequencies[1:]
    beam = natural_modes(plane_bar(1.0, 0.05, (40, 4), guided=False, clamped=False), 6).frequencies[3:]
    bars = [bar_frequencies(_SPEED, 1.0, 3, clamped=held) for held in (True, False)]
    exact = free_beam_frequencies(_SPEED, 1.0, 0.05, 0.0, 3)
    yield from checks_of(
        "B18 bars and beams",
        ("bar clamped at one end, three frequencies over theirs", farthest(clamped / bars[0], 1.0), 1.0, 1e-4),
        ("free bar, three frequencies over theirs", farthest(free / bars[1], 1.0), 1.0, 1e-4),
        ("free beam, L/h = 20, three over Timoshenko's", farthest(beam / exact, 1.0), 1.0, 3e-4, "Huang 1961"),
        source="closed form",
    )
    wave = np.sqrt((1.0 - _NU) / ((1.0 + _NU) * (1.0 - 2.0 * _NU)))
    rings = disc_frequencies(float(wave), 1.0, _NU, 2)
    families: tuple[Literal["quad", "quad8"], ...] = ("quad", "quad8")
    found = {
        (family, n): natural_modes(thin_disc(1.0, _NU, n, family), 2).frequencies
        for family in families
        for n in (8, 16)
    }
    errors = {key: abs(found[key][0] / rings[0] - 1.0) for key in found}
    rates = [np.log2(errors[family, 8] / errors[family, 16]) for family in families]
    yield from checks_of(
        "B18 disc in plane strain",
        ("two radial frequencies over theirs", farthest(found["quad8", 16] / rings, 1.0), 1.0, 1e-5),
        ("order in h of the frequency, linear cells", rates[0], 2.0, 0.05),
        ("order in h of the frequency, quadratic cells", rates[1], 4.0, 0.1),
        source="Love 1927, section 201",
    )


def waves_around_a_ring() -> Iterator[Check]:
    """A ring on a shaft as it is drawn, and the waves of one of its sectors, whose sides cut the joint."""
    whole, sector = (ring_on_shaft(whole=every) for every in (True, False))
    for joint in (STUCK, SLIPPING):
        exact = natural_modes(whole, _WAVES, joint=joint).squares
        found = [natural_modes(sector, 6, joint=joint, nodal_diameters=h).squares for h in range(SECTORS // 2 + 1)]
        both = np.sort(np.concatenate([found[0], *(np.repeat(one, 2) for one in found[1:-1]), found[-1]]))[:_WAVES]
        yield from checks_of(
            f"B18 waves around a ring, {joint} joint",
            (f"omega^2 of {_WAVES} modes, of the largest", np.abs(both - exact).max() / exact[-1], 0.0, 1e-9),
            source="the whole ring",
        )


def bar_in_bed() -> Iterator[Check]:
    """Loops of a bar that sticks out of a rough bed, in microslip."""
    model, exact = bar_in_a_bed(cells=80)
    found = joint_damping(solve(model), [exact.amplitude(share) for share in (0.4, 0.8)], cycles=1)
    force = np.array([loop.force.max() for loop in found.loops])
    secant = np.sqrt(force / exact.coordinate(force)) / (2.0 * np.pi)
    yield from checks_of(
        "B18 bar in a rough bed",
        ("frequency of the stuck bed", found.frequency, exact.frequency, 1e-4),
        ("dissipation, slip through 0.4 of the bed", found.dissipations[0], exact.dissipation(force)[0], 2e-3),
        ("dissipation, slip through 0.8 of the bed", found.dissipations[1], exact.dissipation(force)[1], 5e-4),
        ("secant frequency there", found.frequencies[1], secant[1], 5e-3),
        ("damping ratio there", found.ratios[1], exact.ratio(force)[1], 1e-2),
        source="Goodman, Klumpp 1956; Masing",
    )
