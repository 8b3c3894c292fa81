# SPDX-License-Identifier: BSD-3-Clause
"""A deck whose load lifts a block from its plane: no equilibrium, in its first step."""

DECK = """
mesh = {generator = "rectangle", nx = 2, ny = 2}
material.soft = {E = 1.0, nu = 0.3}
body = [{name = "block", material = "soft"}]
load = [{on = "top", traction = [0.0, 1.0]}]
contact = [{nonmortar = "bottom", plane = {point = [0.0, 0.0], normal = [0.0, 1.0]}, friction = 0.3}]
"""
