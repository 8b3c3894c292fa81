# SPDX-License-Identifier: BSD-3-Clause
"""The results of a contact and of a step, as arrays and resultants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array, BoolArray, IntArray, elsewhere, stored
from signorini.attempt import MethodRun
from signorini.model.outputs import Part
from signorini.plasticity.state import PlasticState
from signorini.short import Short
from signorini.solution.bolt_result import BoltResult
from signorini.solution.certificate import Certificate
from signorini.solution.contact_wear import ContactWear
from signorini.solution.nodal_forces import NodalForces
from signorini.solution.obstacle_result import ObstacleMotion, ObstacleResult

OPEN, STICK, SLIP = "open", "stick", "slip"


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ContactResult(Short):
    """One contact at the end of a step, on its nonmortar nodes.

    Attributes
    ----------
    name : of the contact
    nonmortar, mortar : the sides as they were taken, an obstacle in words
    coupling : "nodes", "mortar", "node-to-segment" or "obstacle"
    node : (n,) node indices, from 0
    points : (n, d) undeformed coordinates, with twist (n, 2)
    normals, tangents : (n, d) unit vectors, in space (n, 2, 3) tangents with ``t1 x t2 = n``, with twist along the
        meridian and the hoop; the normal points from the mortar side into the nonmortar body
    levers : (n, d, 1 or 3) moments about the origin of unit normal and tangential forces of every pair on the nonmortar
        body, where these act (of quadratic facets not at the corners alone), length
    area : (n,) tributary area
    gap : (n,) length, 0 where closed; negative only as overlap of an interface with finite stiffness
    pressure : (n,) force per area, positive compressive
    traction : (n,) friction on the nonmortar body along the tangent, force per area; (n, 2) in space
    slip : (n,) accumulated along the tangent, nonmortar minus mortar, length; (n, 2) in space
    sliding : (n,) distance slid either way in this step, length
    slip_range : (n,) largest less smallest slip of this step's last cycle, twice the slip amplitude
    status : (n,) "open", "stick" or "slip"
    worn : (n,) dissipation of this step at each node, work per area
    dissipation : of this step, work
    wear : what the sides have lost since the beginning; None where none wears
    damage : (n,) of bonds, 0 where they hold, 1 where there is none (any more); None where no contact is bonded
    """

    name: str
    nonmortar: str
    mortar: str
    coupling: str
    node: IntArray
    points: Array
    normals: Array
    tangents: Array
    levers: Array
    area: Array
    gap: Array
    pressure: Array
    traction: Array
    slip: Array
    sliding: Array
    slip_range: Array
    status: NDArray[np.str_]
    worn: Array
    dissipation: float
    wear: ContactWear | None = None
    damage: Array | None = None

    @property
    def closed(self) -> BoolArray:
        """(n,) whether a pair touches."""
        return np.asarray(self.status != OPEN)

    @property
    def normal_force(self) -> Array:
        """Resultant of the pressure on the nonmortar body, (d,) force; with twist the third one is a torque."""
        force: Array = (self.pressure * self.area) @ self.normals
        return force

    @property
    def tangential_force(self) -> Array:
        """Resultant of the friction on the nonmortar body, (d,) force; with twist the third one is a torque."""
        force: Array = self.area @ self.shear
        if self.twists:
            force[2] = self.torque
        return force

    @property
    def shear(self) -> Array:
        """Friction on the nonmortar body as vectors, (n, d) force per area."""
        return self.along_tangents(self.traction)

    def along_tangents(self, components: Array) -> Array:
        """Vectors (n, d) from components along the tangents, (n,) in the plane and (n, 2) in space."""
        if components.ndim == 1:
            return components[:, None] * self.tangents
        return np.einsum("nk,nki->ni", components, self.tangents)

    @property
    def slipped(self) -> Array:
        """Size of the accumulated slip, (n,) length."""
        return np.abs(self.slip) if self.slip.ndim == 1 else np.linalg.norm(self.slip, axis=1)

    @property
    def forces(self) -> Array:
        """On the nonmortar body at every node, (n, d) force."""
        forces: Array = self.area[:, None] * (self.pressure[:, None] * self.normals + self.shear)
        return forces

    def moment(self, about: Sequence[float] | Array, of: Part = "all") -> Array:
        """Resultant moment on the nonmortar body about a point (d,), ``int (x - about) x t dA``, force times length.

        Of the forces as they act on all nodes of the facets, so that it balances those of loads and supports. A number
        in the plane, counterclockwise positive; (3,) in space; with twist that about the axis, wherever the point is;
        of all of them, of the pressure or of the friction.
        """
        parts = [0.0 if of == skipped else 1.0 for skipped in ("friction", "pressure")]
        tractions = np.column_stack([parts[0] * self.pressure, parts[1] * self.traction])
        total = np.einsum("k,ki,kim->m", self.area, tractions, self.levers)
        if self.twists:
            return np.asarray(total[0])
        place, force = np.asarray(about, float), parts[0] * self.normal_force + parts[1] * self.tangential_force
        if len(place) == 3:
            return np.asarray(total - np.cross(place, force))
        return np.asarray(total[0] - place[0] * force[1] + place[1] * force[0])

    @property
    def twists(self) -> bool:
        """Whether it is one of bodies of revolution that twist: the third component goes round."""
        return self.normals.shape[1] > self.points.shape[1]

    @property
    def torque(self) -> float:
        """Moment about the axis on the nonmortar body, where bodies of revolution twist; elsewhere 0."""
        return float(self.moment((0.0, 0.0))) if self.twists else 0.0

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


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PlasticResult(Short):
    """Plastic flow of all bodies in one state.

    Attributes
    ----------
    state : of the points of the bodies, where the displacement is known too; otherwise its energies alone
    dissipation : plastic work since the beginning of the step, what back stresses and hardening store included
    """

    state: PlasticState
    dissipation: float

    @property
    def stored(self) -> float:
        """Energy in back stresses, which flow in reverse can give back."""
        return self.state.stored


@dataclass(frozen=True, kw_only=True)
class PairEvent:
    """Pairs of one contact that change their state at one load of an exact path.

    Attributes
    ----------
    load_factor : step k goes from k - 1 to k
    contact : name
    nodes : indices of nonmortar nodes, from 0
    what : "closes", "opens", "slips", "sticks"; "kinks": slips on, at the shear limit or below it again; "stiffens" or
        "softens", at a kink of its closure; "softens": its bond reaches its strength; "breaks": it is gone
    """

    load_factor: float
    contact: str
    nodes: tuple[int, ...]
    what: str


@elsewhere("displacement")
@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Instant(Short):
    """The contacts at one load on the way: at every event or increment, at kinks of the load, at times asked for.

    Attributes
    ----------
    load_factor : step k goes from k - 1 to k
    what : "start", "event", "increment", "asked", "segment" (of the step ends), "jump" and "landing" (its two ends),
        "change" (of the law of contact, before the loads of the step), "approach" (of bodies that float, up to where
        they touch), "wear" (of the sides, at one load), "mesh" (that moves with what is worn, at one load)
    contacts : in the order of the model; gaps are NaN where the bodies were not looked at and a pair is far from
        touching, dissipation counts from the beginning of the step
    work : since the beginning of the step, NaN where the bodies were not looked at
    displacement : (nodes, d) length, at times asked for, and everywhere where ``at = "events"``; otherwise None
    factors : load factors by name
    plastic : flow of the bodies; None where none yields
    places : (nodes, d) of the mesh where displacements are known, if sides are worn and it has moved; otherwise None
    nodal_forces : where displacements are known, and at the end of a step; None where bodies turn
    motions : of moving obstacles and rigid bodies by name, where displacements are known; otherwise None
    """

    load_factor: float
    what: str
    contacts: tuple[ContactResult, ...]
    work: float
    displacement: Array | None
    factors: Mapping[str, float]
    plastic: PlasticResult | None = None
    places: Array | None = None
    nodal_forces: NodalForces | None = None
    motions: Mapping[str, ObstacleMotion] | None = None

    @property
    def deformed(self) -> bool:
        """Whether displacements are known; they are not asked for."""
        return stored(self, "displacement") is not None


@dataclass(frozen=True, kw_only=True)
class Yielding:
    """How far bodies have yielded at the end of a step.

    Attributes
    ----------
    largest : equivalent plastic strain of any point
    body, at : where that is: name of the body, (d,) undeformed coordinates; "" and () where nothing has flowed
    share : of the volume of the bodies that may yield, in which anything has flowed, 0 .. 1
    first : load factor at which points begin to flow in this step; None where none does
    """

    largest: float
    body: str
    at: tuple[float, ...]
    share: float
    first: float | None


@dataclass(frozen=True, kw_only=True)
class Cycle:
    """One cycle of a step that repeats.

    Attributes
    ----------
    number : from 1
    load_factor : at its end
    work, dissipation, released : in it
    sliding : longest distance that a pair slid in it, length
    change : largest change of a contact force from the beginning to the end of it, of the largest force
    drift : how far a pair that touches at both ends of it has moved along, length
    flow : largest growth of the equivalent plastic strain of a point in it
    plastic_drift : largest change of a point's plastic strain from its beginning to its end, equivalent
    worn : volume that it wears, on both sides of all contacts
    """

    number: int
    load_factor: float
    work: float
    dissipation: float
    released: float
    sliding: float
    change: float
    drift: float
    flow: float = 0.0
    plastic_drift: float = 0.0
    worn: float = 0.0


@elsewhere("displacement", "external")
@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StepResult(Short):
    """The end of a step, or how far it was followed.

    Attributes
    ----------
    name, path : of the step; path is "single" (one increment), "increments" or "exact"
    finished : whether it was solved to its end; only the last step of a history may not be
    events : of an exact path, in order
    displacement : (nodes, d) length
    external : (nodes, d) loads and reactions of supports, force
    obstacles : moving obstacles by name
    rigid_bodies : the same of rigid bodies
    reactions : support or elastic foundation to its force on the bodies, (d,), with twist the third one a torque; on a
        rigid body with its moments
    strain_energy : of the bodies
    interface_energy : of compliant interfaces and elastic foundations
    work : of loads, moving supports, interferences and changes of temperature in this step
    released : energy set free at once in this step: in jumps, by changes of the law, by contacts switched off
    energy_defect : work less what is stored, dissipated by friction and plastic flow, and released; rounding on an
        exact path
    certificate : the worst of every increment, or the end of an exact path
    trace : for every increment the methods tried, in order: iterations, status changes, how each ended
    instants : on the way, in order; the end of the step is the last
    cycles : of a step that repeats
    steadiness : of the cycles: "shakes down", "steady", "ratchets" or "not yet", empty without cycles
    notes : what a reader should know
    yielding : which bodies yield, and how far; None where none may
    bolts : what they bear, by name
    """

    name: str
    path: str
    finished: bool
    events: tuple[PairEvent, ...]
    displacement: Array
    external: Array
    obstacles: Mapping[str, ObstacleResult]
    rigid_bodies: Mapping[str, ObstacleResult]
    reactions: Mapping[str, Array]
    strain_energy: float
    interface_energy: float
    work: float
    released: float
    energy_defect: float
    certificate: Certificate
    trace: tuple[tuple[MethodRun, ...], ...]
    instants: tuple[Instant, ...]
    cycles: tuple[Cycle, ...]
    steadiness: str
    notes: tuple[str, ...]
    yielding: Yielding | None = None
    bolts: Mapping[str, BoltResult] = field(default_factory=dict)

    @property
    def load_factor(self) -> float:
        """Step k ends at k; one that is not finished before."""
        return self.instants[-1].load_factor

    @property
    def factors(self) -> Mapping[str, float]:
        """Load factors at its end, by name."""
        return self.instants[-1].factors

    @property
    def places(self) -> Array | None:
        """(nodes, d) Of the mesh at its end, where it has moved with what is worn; otherwise None."""
        return self.instants[-1].places

    @property
    def nodal_forces(self) -> NodalForces | None:
        """Of supports and contacts at its end."""
        return self.instants[-1].nodal_forces

    @property
    def motions(self) -> Mapping[str, ObstacleMotion]:
        """Of moving obstacles and rigid bodies at its end, by name."""
        return {**self.obstacles, **self.rigid_bodies}

    @property
    def contacts(self) -> tuple[ContactResult, ...]:
        """At its end, in the order of the model."""
        return self.instants[-1].contacts

    @property
    def plastic(self) -> PlasticResult | None:
        """Flow of the bodies at its end; None where none yields."""
        return self.instants[-1].plastic

    @property
    def increments(self) -> int:
        """Solved in this step; 0 on an exact path."""
        return 0 if self.path == "exact" else len(self.trace)

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
