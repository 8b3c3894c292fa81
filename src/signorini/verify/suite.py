# SPDX-License-Identifier: BSD-3-Clause
"""Run the verification cases."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from signorini.verify import blocks, cylinder, elements, half_planes, rings, space
from signorini.verify.check import Check

Case = Callable[[], Iterator[Check]]

QUICK: tuple[Case, ...] = (
    blocks.patch_p1,
    blocks.patch_p2,
    blocks.patch_p4,
    blocks.one_node,
    blocks.one_node_path,
    rings.press_fit_plane_stress,
    rings.press_fit_plane_strain,
    cylinder.paper_mesh,
    cylinder.refined,
    cylinder.literal_equals_compliance,
    cylinder.exact_path,
    cylinder.increments_at_events,
    half_planes.cattaneo_mindlin,
    elements.sphere_on_a_plane,
    elements.hollow_spheres,
    elements.cantilever,
    elements.inside_bodies,
    space.ball_on_plane,
    space.ball_on_block,
    space.mindlin,
    space.press_fit,
)
SLOW: tuple[Case, ...] = (
    cylinder.small_load,
    half_planes.cattaneo_mindlin_refined,
    half_planes.spence,
    half_planes.complete_contact,
    space.balls_refined,
    space.punch,
    space.mindlin_refined,
)


def run(slow: bool = False) -> list[dict[str, str | float | bool]]:
    """Run the quick cases, or all of them, and return the rows of the table.

    Returns
    -------
    rows with case, quantity, computed, reference, error, tolerance, source, passed
    """
    return [check.row() for case in (QUICK + SLOW if slow else QUICK) for check in case()]
