# SPDX-License-Identifier: BSD-3-Clause
"""A geometry for Gmsh: a block with a named surface and a named side."""

GEOMETRY = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 1};
Physical Surface("block") = {1};
Physical Curve("bottom") = {1};
Mesh.MeshSizeMax = 0.5;
Mesh.ElementOrder = 2;
"""
