# SPDX-License-Identifier: BSD-3-Clause
"""Thick walls of revolution under inner pressure, whose solutions Lame wrote down: a tube and a sphere."""

import signorini as sg

STEEL = sg.Elastic(E=200.0, nu=0.3)
WALL = {"inner": 1.0, "outer": 2.0, "pressure": 3.0, "E": 200.0, "nu": 0.3}


def tube(n, family):
    return sg.Model(
        sg.rectangle(width=1.0, height=0.5, nx=n, ny=n // 2, origin=(1.0, 0.0), cells=family),
        kind="axisymmetric",
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("bottom", u=(None, 0)), sg.Support("top", u=(None, 0))],
        loads=[sg.Load("left", pressure=3.0)],
    )


def sphere(n, family):
    """The upper half of a hollow sphere."""
    return sg.Model(
        sg.annulus(inner=1.0, outer=2.0, n_radial=n, n_angular=2 * n, angle=90.0, cells=family),
        kind="axisymmetric",
        bodies=[sg.Body("ring", STEEL)],
        supports=[sg.Support("start", u=(None, 0))],
        loads=[sg.Load("inner", pressure=3.0)],
    )
