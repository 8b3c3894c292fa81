# SPDX-License-Identifier: BSD-3-Clause
"""A roller whose crown is found that levels its line load, beside Lundberg's logarithmic profile.

    python examples/crown_roller.py [FOLDER]

A rigid roller of finite length is pressed on an elastic block that goes on beyond its end, where a straight roller cuts
in: a quarter in space. Every station along the roller has a profile, the gap of all nodes there; Newton's method takes
what each of them makes of the load of every station. Lundberg's profile levels a contact that is long for its width,
``q / (pi E*) ln 1 / (1 - (y / L)^2)``, and is infinite at the end. Writes crown_roller.png (default: docs/figures).

References
----------
Lundberg (1939), Elastische Beruehrung zweier Halbraeume, Forschung auf dem Gebiete des Ingenieurwesens 10:201.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import signorini as sg
from signorini.arrays import Array

RADIUS, HALF, FORCE, E, NU = 20.0, 6.0, 60.0, 1000.0, 0.3  # the force is that on a quarter
SIZE = 30.0  # of the block, from the middle of the contact
MODULUS = E / (1.0 - NU**2)
WIDTH = float(np.sqrt(4.0 * (2.0 * FORCE / HALF) * RADIUS / (np.pi * MODULUS)))
"""Half of Hertz' contact under the mean line load, both sides of the middle together."""


def roller(stations: int, across: int) -> sg.Model:
    """A quarter of the block under a quarter of the roller.

    Parameters
    ----------
    stations : along half of the roller, closer to each other towards its end
    across : nodes from the middle of the contact to Hertz' half-width
    """
    cell = WIDTH / across
    y = np.linspace(0.0, HALF, stations)
    last = y[-1] - y[-2]
    x = np.concatenate([cell * np.arange(across + 3), cell * (across + 2) + np.geomspace(2.0 * cell, SIZE, 6)])
    y = np.concatenate([y, HALF + np.geomspace(last, SIZE, 6)])
    z = -np.concatenate([[0.0], np.geomspace(cell, SIZE, 8)])[::-1]
    mesh = sg.box(x=x, y=y, z=z)
    top = mesh.boundaries["top"]
    seat = top[((mesh.points[top][..., 0] <= x[across + 2]) & (mesh.points[top][..., 1] <= HALF)).all(axis=1)]
    mesh = sg.Mesh(
        points=mesh.points, cells=mesh.cells, bodies=mesh.bodies, boundaries={**mesh.boundaries, "seat": seat}
    )
    body = sg.Cylinder(point=(0.0, 0.0, RADIUS), axis=(0.0, 1.0, 0.0), radius=RADIUS)
    return sg.Model(
        mesh,
        bodies=[sg.Body("block", sg.Elastic(E=E, nu=NU))],
        supports=[
            sg.Support("left", u=(0.0, None, None)),
            sg.Support("front", u=(None, 0.0, None)),
            sg.Support("bottom", u=(None, None, 0.0)),
        ],
        obstacles=[sg.Rigid("roller", body, u=(0.0, 0.0, None), force=(0.0, 0.0, -FORCE))],
        contacts=[sg.Contact("seat", "roller", name="seat")],
        steps=[sg.Step(scale={"roller": 1.0}, increments=1)],
    )


def crown(stations: int = 15, across: int = 4, most: int = 8) -> tuple[Array, list[Array], Array]:
    """Places of the stations, their line loads over the mean after every step, and the profile that levels them.

    Parameters
    ----------
    stations, across : see `roller`
    most : Newton steps
    """
    prepared = sg.prepare(roller(stations, across))
    seat = prepared.solve().contact("seat")
    places, station = np.unique(seat.points[:, 1].round(9), return_inverse=True)
    of = np.eye(len(places))[station]  # (nodes, stations)
    outputs = [sg.pressure("seat").mean(tuple(column)) for column in of.T]
    function = prepared.function(["gap.seat"], outputs)
    share = of.T @ seat.area / float(seat.area.sum())
    inside = np.minimum(places, 0.5 * (places[-2] + HALF))  # his profile is infinite at the end
    profile, loads = np.zeros(len(places)), [function.values(np.zeros(len(of)))]
    step = lundberg(inside)
    for _ in range(most):
        pressure = function.values(of @ touching(profile + step))
        while pressure.min() <= 0.0:  # a station that lifts off would be lost: it knows of no gap
            step = 0.5 * step
            pressure = function.values(of @ touching(profile + step))
        profile = touching(profile + step)
        loads.append(pressure)
        even = float(share @ pressure)
        if np.abs(pressure / even - 1.0).max() < 1e-6:
            break
        # a gap that all have moves the roller and no load: of all steps the smallest
        step = np.linalg.lstsq(function.jacobian(of @ profile) @ of, even - pressure, rcond=1e-6)[0]
    return places, [part / float(share @ part) for part in loads], profile - profile[0]


def touching(profile: Array) -> Array:
    """The profile as near as the roller comes without load."""
    return profile - profile.min()


def lundberg(y: Array) -> Array:
    """His profile under the mean line load, infinite at the end."""
    with np.errstate(divide="ignore"):
        return -2.0 * FORCE / HALF / (np.pi * MODULUS) * np.log1p(-((y / HALF) ** 2))


def main(folder: Path) -> None:
    """Level, print and draw."""
    places, loads, profile = crown()
    print("line load at the end over the mean:", ", ".join(f"{part[-1]:.4f}" for part in loads))
    y = np.linspace(0.0, 0.998 * HALF, 400)
    figure = Figure(figsize=(7.2, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    for load, colour, label in (
        (loads[0], "#c4451c", "straight"),
        (loads[1], "#6b7785", "Lundberg's profile"),
        (loads[-1], "#1b4f8a", "profile found"),
    ):
        left.plot(places / HALF, load, "o-", ms=3, color=colour, label=label)
    left.set_xlabel("y / half of the length")
    left.set_ylabel("line load over its mean")
    left.set_ylim(bottom=0.0)
    left.legend(frameon=False)
    right.plot(places / HALF, 1e3 * profile, "o", ms=3, color="#1b4f8a", label="profile found")
    right.plot(y / HALF, 1e3 * lundberg(y), "-", color="#333333", lw=1.0, label="Lundberg")
    right.set_xlabel("y / half of the length")
    right.set_ylabel("gap, 1e-3")
    right.legend(frameon=False)
    figure.savefig(folder / "crown_roller.png", dpi=150)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("docs/figures"))
