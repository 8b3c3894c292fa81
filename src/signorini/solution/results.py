# SPDX-License-Identifier: BSD-3-Clause
"""The results of a contact and of a step, as arrays and resultants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array, BoolArray, IntArray
from signorini.solution.certificate import Certificate
from signorini.trace import Attempt

OPEN, STICK, SLIP = "open", "stick", "slip"


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactResult:
    """One contact at the end of a step, on its nonmortar nodes.

    Attributes
    ----------
    name : of the contact
    nonmortar, mortar : the sides as they were taken, an obstacle in words
    coupling : "nodes", "mortar", "node-to-segment" or "obstacle"
    node : (n,) node indices, from 0
    points : (n, d) undeformed coordinates
    normals, tangents : (n, d) unit vectors; the normal points from the mortar side into the nonmortar body
    area : (n,) tributary area
    gap : (n,) length, 0 where closed; negative only as overlap of an interface with finite stiffness
    pressure : (n,) force per area, positive compressive
    traction : (n,) friction on the nonmortar body along the tangent, force per area
    slip : (n,) accumulated along the tangent, nonmortar minus mortar, length
    status : (n,) "open", "stick" or "slip"
    dissipation : of this step, work
    """

    name: str
    nonmortar: str
    mortar: str
    coupling: str
    node: IntArray
    points: Array
    normals: Array
    tangents: Array
    area: Array
    gap: Array
    pressure: Array
    traction: Array
    slip: Array
    status: NDArray[np.str_]
    dissipation: float

    @property
    def closed(self) -> BoolArray:
        """(n,) whether a pair touches."""
        return np.asarray(self.status != OPEN)

    @property
    def normal_force(self) -> Array:
        """Resultant of the pressure on the nonmortar body, (d,) force."""
        force: Array = (self.pressure * self.area) @ self.normals
        return force

    @property
    def tangential_force(self) -> Array:
        """Resultant of the friction on the nonmortar body, (d,) force."""
        force: Array = (self.traction * self.area) @ self.tangents
        return force

    @property
    def forces(self) -> Array:
        """On the nonmortar body at every node, (n, d) force."""
        along = self.pressure[:, None] * self.normals + self.traction[:, None] * self.tangents
        forces: Array = self.area[:, None] * along
        return forces

    def moment(self, about: Sequence[float] | Array) -> float:
        """Resultant moment on the nonmortar body about a point (2,), counterclockwise positive, force times length."""
        arm, forces = self.points - np.asarray(about, float), self.forces
        return float(arm[:, 0] @ forces[:, 1] - arm[:, 1] @ forces[:, 0])

    @property
    def extent(self) -> tuple[Array, Array] | None:
        """Corners of the box around the nodes that touch, lower and upper, each (d,); None where none does."""
        touching = self.points[self.closed]
        return (touching.min(axis=0), touching.max(axis=0)) if len(touching) else None

    @property
    def closed_area(self) -> float:
        """Area of the pairs that touch."""
        return float(self.area[self.closed].sum())

    def count(self, status: str) -> int:
        """How many pairs are "open", "stick" or "slip"."""
        return int((self.status == status).sum())


@dataclass(frozen=True, kw_only=True)
class PairEvent:
    """Pairs of one contact that change their state at one load of an exact path.

    Attributes
    ----------
    load_factor : step k goes from k - 1 to k
    contact : name
    nodes : indices of nonmortar nodes, from 0
    what : "closes", "opens", "slips" or "sticks"
    """

    load_factor: float
    contact: str
    nodes: tuple[int, ...]
    what: str


@dataclass(frozen=True, kw_only=True, eq=False)
class StepResult:
    """The end of a step.

    Attributes
    ----------
    name, path : of the step; path is "single" (one increment), "increments" or "exact"
    load_factor : step k ends at k
    increments : solved in this step; 0 on an exact path
    events : of an exact path, in order
    displacement : (nodes, d) length
    reactions : support to its force on the bodies, (d,)
    strain_energy : of the bodies
    interface_energy : of compliant interfaces
    work : of loads and moving supports in this step
    certificate : the worst of every increment, or the end of an exact path
    contacts : in the order of the model
    trace : for every increment the methods tried, in order: iterations, status changes, how each ended
    notes : what a reader should know
    """

    name: str
    path: str
    load_factor: float
    increments: int
    events: tuple[PairEvent, ...]
    displacement: Array
    reactions: Mapping[str, Array]
    strain_energy: float
    interface_energy: float
    work: float
    certificate: Certificate
    contacts: tuple[ContactResult, ...]
    trace: tuple[tuple[Attempt, ...], ...]
    notes: tuple[str, ...]

    @property
    def methods(self) -> tuple[str, ...]:
        """What solved the increments, each method once."""
        return tuple(dict.fromkeys(attempts[-1].method if attempts else "none" for attempts in self.trace))

    @property
    def iterations(self) -> tuple[int, ...]:
        """Of all methods tried, for every increment."""
        return tuple(sum(attempt.iterations for attempt in attempts) for attempts in self.trace)

    @property
    def dissipation(self) -> float:
        """By friction in this step."""
        return sum(contact.dissipation for contact in self.contacts)
