# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that turn: each in a frame of its own, in which its strains are small and its stiffness is constant.

Displacements u of a body are coordinates: a point d and an angle theta of the frame are read off them, and

    v = u - d - theta x (X - p),    x = p + d + R(theta) (X - p + v),

so that supports of a hub, forces and moments on it and equilibrium ``K u = K v`` are what they are where nothing turns;
what changes is where nodes are, x, and its derivative ``dx = J du``, with which rows of B and forces of a fixed
direction are seen from the frame. In the plane theta may be any angle; in space it is a rotation vector, shorter than
a turn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial.transform import Rotation

from signorini.arrays import Array, IntArray

_SLOW = 1e-4  # radians: below it the rates of a rotation vector are taken from their series


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyFrame:
    """The frame of parts that turn as one.

    Attributes
    ----------
    label : of the parts, as messages call them
    places : (k,) points that it carries: nodes of the mesh, behind them the first of the two nodes of what is rigid
    lever : (k, d) where they are, from its point p
    reading : (d + 1, dofs), in space (d + 3, dofs): its displacement d and rotation theta, of the displacements
    turning : (1 or 3,) dofs of the rotation of a hub that it is read off; empty where it is read off nodes
    corners : (d,) nodes whose places tell the rotation
    triad : (d, d) unit vectors of the directions between them, see :func:`triad`, undeformed
    """

    label: str
    places: IntArray
    lever: Array
    reading: sp.csr_array
    turning: IntArray
    corners: IntArray
    triad: Array

    def turn_at(self, points: Array) -> Array:
        """(d, d) The rotation that has taken the corners where they are among points (nodes, d)."""
        return np.asarray(triad(points[self.corners]).T @ self.triad)

    def motion(self, displacement: Array) -> tuple[Array, Array]:
        """Displacement (d,) of its point and rotation (1 or 3,), radians, of displacements (dofs,)."""
        read, d = self.reading @ displacement, self.lever.shape[1]
        return read[:d], read[d:]

    def elastic(self, at_places: Array, shift: Array, angles: Array) -> Array:
        """(k, d) What is left of displacements without the motion of the frame, in its axes.

        Parameters
        ----------
        at_places : (k, d) displacements of the points that it carries
        shift, angles : (d,) displacement and (1 or 3,) rotation of the frame
        """
        return np.asarray(at_places - shift - _cross(angles, self.lever))


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyFrames:
    """The frames of all bodies that turn; of a model without any everything stays as it is.

    Attributes
    ----------
    frames : one for each
    dimension : d
    """

    frames: tuple[BodyFrame, ...] = ()
    dimension: int = 2

    def __bool__(self) -> bool:
        return bool(self.frames)

    def displaced(self, displacement: Array) -> Array:
        """(dofs,) Displacements of all nodes in space, of displacements as the frames see them."""
        if not self.frames:
            return displacement
        result = displacement.copy()
        at = result.reshape(-1, self.dimension)
        for frame, (shift, turn, _, elastic) in zip(self.frames, self._seen(displacement), strict=True):
            at[frame.places] = shift + (frame.lever + elastic) @ turn.T - frame.lever
        return result

    def elastic(self, displacement: Array) -> Array:
        """(dofs,) Displacements without the motions of the frames."""
        if not self.frames:
            return displacement
        result = displacement.copy()
        at = result.reshape(-1, self.dimension)
        for frame, (*_, elastic) in zip(self.frames, self._seen(displacement), strict=True):
            at[frame.places] = elastic
        return result

    def turns(self, displacement: Array) -> Array:
        """(dofs / d, d, d) Rotation of every node; of those behind the mesh too."""
        count = len(displacement) // self.dimension
        result = np.broadcast_to(np.eye(self.dimension), (count, self.dimension, self.dimension)).copy()
        for frame in self.frames:
            result[frame.places] = rotation(frame.motion(displacement)[1])
        return result

    def turned(self, before: Array, after: Array) -> float:
        """The largest angle, radians, that a frame has turned by from one displacement to another, (dofs,) each."""
        found = [frame.motion(after)[1] - frame.motion(before)[1] for frame in self.frames]
        return max((float(np.linalg.norm(angles)) for angles in found), default=0.0)

    def in_space(self, forces: Array, displacement: Array) -> Array:
        """(dofs,) Forces of the axes of the frames along those of space."""
        if not self.frames:
            return forces
        return np.einsum("kij,kj->ki", self.turns(displacement), forces.reshape(-1, self.dimension)).ravel()

    def about_axes(self, forces: Array, displacement: Array) -> Array:
        """(dofs,) Forces of supports, of hubs with moments about the axes of space, of what does work on rotations."""
        found = forces.copy()
        for frame in self.frames:
            if len(frame.turning):
                rates = rotation_rates(frame.motion(displacement)[1])
                found[frame.turning] = np.linalg.solve(rates.T, forces[frame.turning])
        return found

    def tangent(self, rows: sp.csr_array, displacement: Array) -> sp.csr_array:
        """Rows of derivatives by the places of nodes (k, dofs) as derivatives by displacements: ``rows J``."""
        if not self.frames:
            return rows
        d, entries, turns = self.dimension, sp.coo_array(rows), self.turns(displacement)
        node, axis = np.divmod(entries.col, d)
        values = entries.data[:, None] * turns[node, axis]
        columns = node[:, None] * d + np.arange(d)
        at = np.broadcast_to(entries.row[:, None], columns.shape)
        result = sp.csr_array((values.ravel(), (at.ravel(), columns.ravel())), shape=rows.shape)
        for frame, carried in zip(self.frames, self._carried(displacement), strict=True):
            result = result + sp.csr_array(rows @ carried) @ frame.reading
        result = sp.csr_array(result)
        result.eliminate_zeros()
        result.sum_duplicates()
        return result

    def spin_of(self, nodes: IntArray, displacement: Array) -> sp.csr_array:
        """(1 or 3, dofs) Rate of rotation in space of the frame of nodes (k,); 0 where they do not belong to one frame.

        Parameters
        ----------
        nodes : of one side of a contact
        displacement : (dofs,) as the frames see it
        """
        for frame in self.frames:
            if np.isin(nodes, frame.places).all():
                rates = rotation_rates(frame.motion(displacement)[1])
                return sp.csr_array(sp.csr_array(rates) @ frame.reading[self.dimension :])
        return sp.csr_array((1 if self.dimension == 2 else 3, len(displacement)))

    def felt(self, forces: Array, displacement: Array) -> Array:
        """(dofs,) Forces in space as the frames see them, ``J^T f``: they do the same work."""
        if not self.frames:
            return forces
        turned = np.einsum("kij,ki->kj", self.turns(displacement), forces.reshape(-1, self.dimension)).ravel()
        for frame, carried in zip(self.frames, self._carried(displacement), strict=True):
            turned = turned + frame.reading.T @ (carried.T @ forces)
        return np.asarray(turned)

    def _seen(self, displacement: Array) -> list[tuple[Array, Array, Array, Array]]:
        """Of every frame its displacement, its rotation as a matrix and as angles, and what is elastic (k, d)."""
        at, found = displacement.reshape(-1, self.dimension), []
        for frame in self.frames:
            shift, angles = frame.motion(displacement)
            found.append((shift, rotation(angles), angles, frame.elastic(at[frame.places], shift, angles)))
        return found

    def _carried(self, displacement: Array) -> list[sp.csr_array]:
        """Of every frame (dofs, d + 1 or d + 3): what its motion moves beyond what turned displacements do."""
        result = []
        for frame, (_, turn, angles, elastic) in zip(self.frames, self._seen(displacement), strict=True):
            axes = np.eye(len(angles))
            rates = rotation_rates(angles)
            by_shift = np.broadcast_to(np.eye(self.dimension) - turn, (len(elastic), *turn.shape))
            at = (frame.lever + elastic) @ turn.T
            by_angle = np.stack(
                [_cross(rates @ axis, at) - _cross(axis, frame.lever) @ turn.T for axis in axes], axis=-1
            )
            moved = np.concatenate([by_shift, by_angle], axis=-1).reshape(-1, self.dimension + len(angles))
            dofs = (frame.places[:, None] * self.dimension + np.arange(self.dimension)).ravel()
            if len(frame.turning):
                size = 1.0 / frame.reading[self.dimension, frame.turning[0]]
                spins = np.concatenate([np.zeros((len(angles), self.dimension)), size * (rates - axes)], axis=1)
                moved, dofs = np.concatenate([moved, spins]), np.concatenate([dofs, frame.turning])
            rows = sp.coo_array(moved)
            shape = (len(displacement), moved.shape[1])
            result.append(sp.csr_array((rows.data, (dofs[rows.row], rows.col)), shape=shape))
        return result


def rotation(angles: Array) -> Array:
    """(d, d) The rotation by an angle (1,) or a rotation vector (3,), radians."""
    turn = np.array([0.0, 0.0, angles[0]]) if len(angles) == 1 else angles
    d = 2 if len(angles) == 1 else 3
    return np.asarray(Rotation.from_rotvec(turn).as_matrix()[:d, :d])


def rotation_rates(angles: Array) -> Array:
    """Angular velocity in space per rate of an angle (1, 1) or a rotation vector (3, 3), 1.

    ``(sin a / a) I + ((1 - cos a) / a^2) [r]x + ((a - sin a) / a^3) r r^T`` of the vector r of length a.
    """
    if len(angles) == 1:
        return np.ones((1, 1))
    a = float(np.linalg.norm(angles))
    if a < _SLOW:
        one, two, three = 1.0 - a * a / 6.0, 0.5 - a * a / 24.0, 1.0 / 6.0 - a * a / 120.0
    else:
        one, two, three = np.sin(a) / a, (1.0 - np.cos(a)) / a**2, (a - np.sin(a)) / a**3
    spin = np.cross(angles, np.eye(3)).T
    return np.asarray(one * np.eye(3) + two * spin + three * np.outer(angles, angles))


def mean_turn(points: Array, displacement: Array) -> Array:
    """(1 or 3,) The small rotation, radians, that displacements (k, d) of points (k, d) are nearest to."""
    lever, moved = points - points.mean(axis=0), displacement - displacement.mean(axis=0)
    if points.shape[1] == 2:
        return np.array([(lever[:, 0] * moved[:, 1] - lever[:, 1] * moved[:, 0]).sum() / (lever**2).sum()])
    inertia = (lever**2).sum() * np.eye(3) - lever.T @ lever
    return np.asarray(np.linalg.lstsq(inertia, np.cross(lever, moved).sum(axis=0))[0])


def triad(corners: Array) -> Array:
    """(d, d) Unit vectors, a row each, that the directions between d points (d, d) give: along, across, normal."""
    along = corners[1] - corners[0]
    along = along / np.linalg.norm(along)
    if len(corners) == 2:
        return np.stack([along, [-along[1], along[0]]])
    across = corners[2] - corners[0]
    across = across - (across @ along) * along
    across = across / np.linalg.norm(across)
    return np.stack([along, across, np.cross(along, across)])


def _cross(angles: Array, lever: Array) -> Array:
    """(k, d) ``theta x r`` of an angle (1,) or a vector (3,) and levers (k, d)."""
    if len(angles) == 1:
        return np.asarray(angles[0] * np.stack([-lever[:, 1], lever[:, 0]], axis=1))
    return np.cross(angles, lever)
