# SPDX-License-Identifier: BSD-3-Clause
"""Geometries of Gmsh (``.geo``), meshed by Gmsh itself where it is installed."""

from __future__ import annotations

import re
from pathlib import Path

from signorini.errors import InputError, brief

SUFFIX = ".geo"

_SILENT = re.compile(r'//[^\n]*|/\*.*?\*/|"[^"\n]*"|\'[^\'\n]*\'', re.DOTALL)  # comments and strings
_TOKEN = re.compile(
    r"\d+(?:\.\d*)?(?:[eE][-+]?\d+)?|"  # a number, which may end where a word begins; or a word, given a value or not
    r"(\.?)\s*([A-Za-z_]\w*)(?=\s*((?:\[\s*\]|\(\s*\))?\s*[-+*/]?=|\+\+|~)?)"
)
_HIDDEN = ("\0", "\\'", '\\"')
"""What readers of strings may understand in different ways."""

_KNOWN = frozenset(
    re.findall(
        r"\w+",
        """
    Abs Acos Affine Asin Atan Atan2 Attractor AttractorAnisoCurve AutomaticMeshSizeField BSpline Background Ball
    Beta Bezier BooleanDifference BooleanFragments BooleanIntersection BooleanUnion BoundaryLayer Boundary
    BoundingBox Box Bump Call Ceil Chamfer Characteristic Circle Closest Coherence Color Combined
    CombinedBoundary Compound Cone Constant Cos Cosh Curvature Curve Cylinder DefineConstant Degenerated Delete
    Dilate Disk Distance Duplicata Ellipse Ellipsis Else ElseIf EndFor EndIf Exp Extend Extrude Fabs Field
    Fillet Floor Fmod For Frustum Function Geometry Hypot If In Intersect IntersectAniso Knots Layers Length
    Line LinSpace List Log Log10 LogSpace Loop Macro MathEval MathEvalAniso Max MaxEigenHessian Mean Mesh Min
    Modulo Nurbs Order Param Parametric Periodic Physical Pi Pipe Plane Point PointsOf Progression Quad QuadTri
    QuadTriAddVerts QuadTriNoNewVerts Rand Recombine Rectangle Recursive Restrict Return Reverse ReverseMesh
    Rotate Round Ruled ScaleLastLayer SetFactory SetOrder Sin Sinh Smoother Solid Sphere Spline Sprintf Sqrt Str
    StrCat Surface Symmetry Tan Tanh ThickSolid Threshold ThruSections Torus TransfQuadTri Transfinite Translate
    Using UsingWire Volume Wedge Wire
    """,
    )
)
"""Words of Gmsh that make points, curves, surfaces, volumes and sizes, and compute; others run programs, read files."""

_FORBIDDEN = frozenset(
    re.findall(
        r"\w+",
        """
    Abort CommandLine CreateDir DeleteFile Error ErrorFileName Exit ExternalProcess FileName General GetEnv
    GmshExecutableName Include ListFromFile Merge NonBlockingSystemCall OnelabAction OnelabRun Parse Plugin
    PostProcessing Print Printf Save ShapeFromFile Solver SystemCall View Warning
    """,
    )
)
"""Of these others what a geometry cannot make a name of its own by giving it a value."""


def mesh_geometry(path: Path, mesh: Path) -> None:
    """Mesh a geometry, in space if it has volumes, and write the mesh.

    Parameters
    ----------
    path : of the ``.geo`` file; sizes, order and physical groups are its own
    mesh : of the ``.msh`` file to be written

    Raises
    ------
    InputError
        If Gmsh is not installed, or cannot read or mesh the geometry.
    """
    try:
        import gmsh
    except (ImportError, OSError) as error:  # the wheel needs libraries of the system
        raise InputError(
            f"'{path}' is a geometry, which Gmsh must mesh, and there is no Gmsh ({brief(error)}); expected "
            "pip install 'signorini[gmsh]', or a mesh (gmsh -2 or -3, saved as .msh)",
            where=("mesh", "file"),
        ) from None
    check_harmless(path)
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        gmsh.model.mesh.generate(gmsh.model.getDimension())
        gmsh.write(str(mesh))
    except Exception as error:  # Gmsh knows no other
        raise InputError(f"Gmsh cannot mesh '{path}': {brief(error)}", where=("mesh", "file")) from error
    finally:
        gmsh.finalize()


def check_harmless(path: Path) -> None:
    """Refuse a geometry, which is a program, with any word that is not known to do no more than make a mesh.

    Raises
    ------
    InputError
        With the word.
    """
    text = path.read_text(encoding="utf-8", errors="replace").replace("\r", "\n")
    plain = _SILENT.sub(" ", text)
    if any(hidden in text for hidden in _HIDDEN) or "'" in plain or '"' in plain:
        raise InputError(f"'{path}' has strings that are not clear; expected each in one line, without escapes")
    words = [(match[2], bool(match[1]), match[3] is not None) for match in _TOKEN.finditer(plain) if match[2]]
    own = {word for word, option, given in words if given and not option}
    own |= set(re.findall(r"\b(?:For|Macro|Function|Call)\s+(\w+)", plain))
    for word, option, _ in words:
        harmless = option or not word[0].isupper() or word in _KNOWN or word in own
        if word in _FORBIDDEN or not harmless:
            raise InputError(
                f"'{path}' has '{word}', which may do more than make a mesh; expected a geometry without, or its mesh "
                "(gmsh -2 or -3, saved as .msh)"
            )
