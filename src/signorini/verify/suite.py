# SPDX-License-Identifier: BSD-3-Clause
"""Run the verification cases."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context

from signorini.cores import threads
from signorini.verify import (
    bolts,
    bounded,
    closures,
    cohesion,
    cylinder,
    elements,
    fatigue,
    fenet,
    footings,
    half_planes,
    hertz,
    indentation,
    one_node,
    patches,
    plasticity,
    punches,
    rates,
    rings,
    rolling,
    scalar,
    sectors,
    sliding,
    solids,
    space,
    twist,
    vibration,
    wear,
)
from signorini.verify.check import Check

Case = Callable[[], Iterator[Check]]
Row = dict[str, str | float | bool]
Begin = Callable[[str, int, int], None]

QUICK: tuple[Case, ...] = (
    patches.patch_p1,
    patches.patch_p2,
    patches.patch_p4,
    patches.patch_p5,
    patches.patch_p6,
    patches.patch_discs,
    hertz.line_contact,
    hertz.point_contact,
    hertz.below_the_contact,
    hertz.revolved_spheres,
    hertz.small_revolved_spheres,
    fenet.fenet_cylinder,
    punches.flat_punches,
    punches.corner_exponents,
    rings.press_fits,
    rings.shrink_fits,
    rings.hollow_bodies,
    rings.drawn_press_fits,
    scalar.scalar_signorini,
    one_node.one_node,
    one_node.one_node_path,
    one_node.one_node_path_in_space,
    bounded.shear_limits,
    bounded.friction_over_pressure,
    cylinder.paper_mesh,
    cylinder.refined,
    cylinder.literal_equals_compliance,
    cylinder.exact_path,
    cylinder.increments_at_events,
    half_planes.cattaneo_mindlin,
    elements.sphere_on_a_plane,
    elements.revolved_hollow_spheres,
    elements.cantilever,
    elements.inside_bodies,
    solids.spheres,
    solids.hollow,
    space.ball_on_plane,
    space.ball_on_block,
    space.mindlin,
    space.press_fit_as_slab,
    plasticity.hills_tube,
    plasticity.yielding_press_fits,
    plasticity.stretched_square,
    plasticity.overlaid,
    indentation.first_yield,
    wear.worn_volumes,
    sliding.sliding_cylinder,
    rolling.tilted_block,
    bolts.stiffness_diagram,
    sectors.ring_and_sector,
    sectors.contact_that_sectors_cut,
    fatigue.trailing_edge,
    vibration.frequencies,
    vibration.bar_in_bed,
    vibration.waves_around_a_ring,
    closures.block_on_a_gasket,
    closures.gasket_in_a_cycle,
    closures.rough_interface,
    closures.layer_that_wears,
    cohesion.bar_torn_off,
    cohesion.double_cantilever,
    cohesion.strip_in_space,
    cohesion.brittle_arm,
    twist.torsion_of_a_shaft,
    twist.shaft_that_yields,
    twist.torque_of_a_press_fit,
    twist.ring_in_space,
    twist.sticking_punch,
    twist.ball_that_turns,
)
SLOW: tuple[Case, ...] = (
    space.mindlin_cycle,
    rates.smooth_contact,
    plasticity.hills_tube_of_other_cells,
    plasticity.bending,
    footings.flat_punch,
    wear.worn_annulus,
    fatigue.known_histories,
    sliding.rolling_wheel,
    rolling.rolling_without_slip,
    cylinder.small_load,
    half_planes.cattaneo_mindlin_refined,
    half_planes.spence,
    half_planes.complete_contact,
    solids.spheres_refined,
    space.balls_refined,
    space.round_punch_on_body,
    space.mindlin_refined,
    space.mindlin_cycle_exact,
    rates.smooth_contact_refined,
    rates.corners,
    footings.rough_flat_punch,
    footings.flat_punch_in_space,
    indentation.full_plasticity,
    indentation.ball_in_a_block,
    indentation.cone_in_a_block,
    indentation.rolling,
    rolling.rolling_shakedown,
    wear.worn_cylinder,
    sliding.dissimilar_rollers,
    wear.fretting_over_elements,
    wear.worn_track,
    wear.worn_block,
)

COMPILE_MUCH: tuple[Case, ...] = (plasticity.hills_tube, space.ball_on_block)
"""Where nothing is compiled they go ahead: each has loops that take seconds, others of its kind would wait for them."""


def verification_rows(
    slow: bool = False,
    begin: Begin = lambda *_: None,
    processes: int = 1,
    beside: Callable[[], None] | None = None,
) -> Iterator[Row]:
    """Run the quick cases, or all of them: the rows of the table in its order, each as soon as it is computed.

    Parameters
    ----------
    slow : whether all
    begin : told before every case what it is, how many are done and how many there are
    processes : that share the cases; a row comes once its case is done where there are several
    beside : what one of them does while the first case runs, where nothing is compiled yet

    Yields
    ------
    rows with case, quantity, computed, reference, error, tolerance, source, passed, and at_least: the reference is a
    lower bound
    """
    yield from rows_of(QUICK + SLOW if slow else QUICK, begin, processes, beside)


def rows_of(
    cases: Sequence[Case], begin: Begin, processes: int = 1, beside: Callable[[], None] | None = None
) -> Iterator[Row]:
    """Rows of cases.

    Parameters
    ----------
    cases : in the order of their rows
    begin, processes, beside : as of :func:`verification_rows`
    """
    if processes == 1:
        yield from _in_turn(cases, [partial(_rows, case) for case in cases], begin)
        return
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        futures = {0: pool.submit(_all_rows, cases[0])}
        ahead: tuple[Case, ...] = ()
        if beside is not None:
            pool.submit(beside)
            ahead = COMPILE_MUCH
        for k in sorted(range(1, len(cases)), key=lambda k: cases[k] not in ahead):
            futures[k] = pool.submit(_all_rows, cases[k])
        try:
            yield from _in_turn(cases, [futures[k].result for k in range(len(cases))], begin)
        finally:
            pool.shutdown(cancel_futures=True)


def _in_turn(cases: Sequence[Case], found: Iterable[Callable[[], Iterable[Row]]], begin: Begin) -> Iterator[Row]:
    for done, (case, rows) in enumerate(zip(cases, found, strict=True)):
        begin(case.__name__.replace("_", " "), done, len(cases))
        yield from rows()


def _rows(case: Case) -> Iterator[Row]:
    for check in case():
        yield check.row()


def _all_rows(case: Case) -> list[Row]:
    with threads(1):
        return list(_rows(case))
