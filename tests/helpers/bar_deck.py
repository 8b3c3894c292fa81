"""A deck of a bar on a rough floor, pressed down, whose modes are asked for in several tests."""

BAR_ON_A_FLOOR = """\
kind = "plane stress"
[mesh]
generator = "rectangle"
width = 2.0
height = 0.5
nx = 8
ny = 2
[material.steel]
E = 100.0
nu = 0.3
density = 1.0
[[body]]
name = "block"
material = "steel"
[[contact]]
name = "floor"
nonmortar = "bottom"
plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }
friction = 0.4
[[load]]
name = "press"
on = "top"
pressure = 1.0
"""
