# SPDX-License-Identifier: BSD-3-Clause
"""What sliding does to the sides of contacts that wear: distance, and pressure times distance or the work of friction.

On a linear piece of an exact path pressure and slip are linear in the load, and slip keeps its direction in the plane,
so that ``int p |ds|`` is the mean pressure times the slip of the piece, exactly. In space slip turns on smooth cones:
there it is the sum over the chords.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from signorini.arrays import Array
from signorini.engine.solver import CondensedSolver
from signorini.engine.step_parts import FollowedPart, Snapshot
from signorini.friction.history import Segment
from signorini.interface.interface import Interface
from signorini.interface.worn_sides import WornSides
from signorini.solution.state import State, wear_of
from signorini.solution.wear_state import WearState


@dataclass(frozen=True, kw_only=True, eq=False)
class Rubbing:
    """What sliding has done to n pairs on some way.

    Attributes
    ----------
    distance : (n,) slid where they were closed, either way, length
    wearing : (n,) ``int p |ds|``, force per length; of pairs that wear by energy the work of friction per area
    travel : (n,) how far both sides have moved along each other, open or closed, length
    volume : (m,) worn off at the corners of the sides by it
    """

    distance: Array
    wearing: Array
    travel: Array
    volume: Array

    def and_then(self, other: Rubbing) -> Rubbing:
        """Both ways, one after the other."""
        return Rubbing(
            distance=self.distance + other.distance,
            wearing=self.wearing + other.wearing,
            travel=self.travel + other.travel,
            volume=self.volume + other.volume,
        )


def rubbing_of_states(sides: WornSides, interface: Interface, states: Sequence[State]) -> Rubbing:
    """Rubbing on a way, linear from state to state.

    Parameters
    ----------
    sides, interface : sides that wear, and the pairs
    states : the ends of linear pieces, in order
    """
    n = len(interface)
    distance, wearing = np.zeros(n), np.zeros(n)
    for one, two in pairwise(states):
        slid = np.linalg.norm(two.slip - one.slip, axis=0)
        pressed = 0.5 * (one.forces + two.forces)[0] * slid
        distance += slid
        wearing += np.where(sides.by_energy, two.dissipation - one.dissipation, pressed) / interface.area
    return Rubbing(distance=distance, wearing=wearing, travel=distance, volume=sides.volume @ wearing)


def rubbing_of_segment(sides: WornSides, interface: Interface, paths: CondensedSolver, segment: Segment) -> Rubbing:
    """Rubbing along a segment of a path on the condensed interface.

    Parameters
    ----------
    sides, interface : sides that wear, and the pairs
    paths : in whose scaled units the segment is
    segment : as it was followed
    """
    n, active, root = len(interface), paths.active, paths.condensed.root
    h, r = (np.array([getattr(piece, name) for piece in segment.pieces]) for name in ("h", "r"))
    forces, slips = 0.5 * (r[1:] + r[:-1]) * root, (np.diff(h, axis=0) / root)[:, 1:]
    normal, friction = forces[:, 0], forces[:, 1:]
    slid = np.abs(slips[:, 0]) if slips.shape[1] == 1 else np.linalg.norm(slips, axis=1)
    distance, wearing, travel = np.zeros(n), np.zeros(n), np.zeros(n)
    travel[active] = slid.sum(axis=0)
    distance[active] = np.where(normal > 0.0, slid, 0.0).sum(axis=0)
    pressed, work = (normal * slid).sum(axis=0), -(friction * slips).sum(axis=(0, 1))
    wearing[active] = np.where(sides.by_energy[active], work, pressed) / interface.area[active]
    return Rubbing(distance=distance, wearing=wearing, travel=travel, volume=sides.volume @ wearing)


def rubbed(wear: WearState, rubbing: Rubbing) -> WearState:
    """A state of wear after sides have slid, which have lost nothing by it yet."""
    return replace(wear, distance=wear.distance + rubbing.distance, loose=wear.loose + rubbing.volume)


def worn(sides: WornSides, wear: WearState, *, cycles: int = 0) -> WearState:
    """A state of wear after the sides have lost what has rubbed.

    Parameters
    ----------
    sides : sides that wear
    wear : their state
    cycles : that have gone by since
    """
    return replace(
        wear,
        depth=wear.depth + sides.depth(wear.loose),
        volume=wear.volume + wear.loose,
        loose=np.zeros_like(wear.loose),
        cycles=wear.cycles + cycles,
    )


def set_loose(before: State, followed: FollowedPart) -> FollowedPart:
    """A part at constant loads in which gaps have grown: forces that gave way there did work, which is set free.

    Its states hold ``- int r_n dg`` as work of an interference, and it is none of the loads.

    Parameters
    ----------
    before : where the part began
    followed : as it was followed
    """
    last, energy, shots = before, 0.0, list[Snapshot]()
    for shot in followed.snapshots:
        now = shot.state
        energy += float(0.5 * (last.forces + now.forces)[0] @ (now.point.gap - last.point.gap))
        shots.append(replace(shot, state=_freed(now, energy)))
        last = now
    return replace(followed, snapshots=tuple(shots), after=_freed(followed.after, energy))


def _freed(state: State, energy: float) -> State:
    wear = wear_of(state)
    return replace(
        state,
        work=state.work + energy,
        released=state.released + energy,
        wear=replace(wear, energy=wear.energy + energy),
    )
