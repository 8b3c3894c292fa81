# SPDX-License-Identifier: BSD-3-Clause
"""signorini: frictional elastic contact by finite elements and linear complementarity.

Everything that a user needs is here by name; it is imported when it is first asked for, so that the command line can
answer at once.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from signorini._version import __version__

if TYPE_CHECKING:
    from signorini import fatigue, lcp
    from signorini.api import load, solve
    from signorini.cores import threads
    from signorini.deck import read
    from signorini.derivative.wrappers import jax, torch
    from signorini.distributed.ranks import ranks
    from signorini.engine import paper
    from signorini.errors import InputError, Interrupted, SignoriniError, SolveFailed
    from signorini.inspection.check import check
    from signorini.law.closure import Closure
    from signorini.law.cohesion import Cohesion
    from signorini.law.friction import TabularFriction
    from signorini.meshing.cut import cut
    from signorini.meshing.halves import section
    from signorini.meshing.plane import annulus, half_disk, quarter_disk, rectangle
    from signorini.meshing.profile import mesh_profile, read_profile
    from signorini.meshing.read import read_mesh
    from signorini.meshing.solid import box, extruded
    from signorini.meshing.surface import mesh_surface, read_surface
    from signorini.meshing.values import read_values
    from signorini.model.accuracy import Accuracy
    from signorini.model.body import Body
    from signorini.model.bolt import Bolt
    from signorini.model.conditions import Foundation, Load, Support
    from signorini.model.contact import Contact
    from signorini.model.fatigue import Fatigue
    from signorini.model.links import CyclicSymmetry, Equation, RigidBody
    from signorini.model.material import Elastic, Orthotropic
    from signorini.model.mesh import Mesh, join
    from signorini.model.model import Model
    from signorini.model.obstacle import Circle, Plane, Profile, Sphere
    from signorini.model.outputs import (
        displacement,
        dissipation,
        force,
        gap,
        halfwidth,
        moment,
        motion,
        pressure,
        stress,
        traction,
    )
    from signorini.model.plastic import Plastic
    from signorini.model.revolved import Cone, Cylinder, Torus
    from signorini.model.rigid import Rigid
    from signorini.model.step import Step
    from signorini.model.triangulated import Surface
    from signorini.model.varying import Along, ArcLength, Formula, NodeValues, Scattered
    from signorini.model.wear import Wear
    from signorini.prepared import prepare
    from signorini.settings import SolverSettings
    from signorini.solved import Solution
    from signorini.study.sweep import sweep
    from signorini.vibration.damping import joint_damping
    from signorini.vibration.modes import natural_modes

__all__ = [
    "Accuracy",
    "Along",
    "ArcLength",
    "Body",
    "Bolt",
    "Circle",
    "Closure",
    "Cohesion",
    "Cone",
    "Contact",
    "CyclicSymmetry",
    "Cylinder",
    "Elastic",
    "Equation",
    "Fatigue",
    "Formula",
    "Foundation",
    "InputError",
    "Interrupted",
    "Load",
    "Mesh",
    "Model",
    "NodeValues",
    "Orthotropic",
    "Plane",
    "Plastic",
    "Profile",
    "Rigid",
    "RigidBody",
    "Scattered",
    "SignoriniError",
    "Solution",
    "SolveFailed",
    "SolverSettings",
    "Sphere",
    "Step",
    "Support",
    "Surface",
    "TabularFriction",
    "Torus",
    "Wear",
    "__version__",
    "annulus",
    "box",
    "check",
    "cut",
    "displacement",
    "dissipation",
    "extruded",
    "fatigue",
    "force",
    "gap",
    "half_disk",
    "halfwidth",
    "jax",
    "join",
    "joint_damping",
    "lcp",
    "load",
    "mesh_profile",
    "mesh_surface",
    "moment",
    "motion",
    "natural_modes",
    "paper",
    "prepare",
    "pressure",
    "quarter_disk",
    "ranks",
    "read",
    "read_mesh",
    "read_profile",
    "read_surface",
    "read_values",
    "rectangle",
    "section",
    "solve",
    "stress",
    "sweep",
    "threads",
    "torch",
    "traction",
]

_HOMES = {
    "signorini.api": ("load", "solve"),
    "signorini.cores": ("threads",),
    "signorini.deck": ("read",),
    "signorini.distributed.ranks": ("ranks",),
    "signorini.model.outputs": (
        "displacement",
        "dissipation",
        "force",
        "gap",
        "halfwidth",
        "moment",
        "motion",
        "pressure",
        "stress",
        "traction",
    ),
    "signorini.inspection.check": ("check",),
    "signorini.derivative.wrappers": ("jax", "torch"),
    "signorini.errors": ("InputError", "Interrupted", "SignoriniError", "SolveFailed"),
    "signorini.law.closure": ("Closure",),
    "signorini.law.cohesion": ("Cohesion",),
    "signorini.law.friction": ("TabularFriction",),
    "signorini.meshing.cut": ("cut",),
    "signorini.meshing.halves": ("section",),
    "signorini.meshing.plane": ("annulus", "half_disk", "quarter_disk", "rectangle"),
    "signorini.meshing.profile": ("mesh_profile", "read_profile"),
    "signorini.meshing.read": ("read_mesh",),
    "signorini.meshing.solid": ("box", "extruded"),
    "signorini.meshing.surface": ("mesh_surface", "read_surface"),
    "signorini.meshing.values": ("read_values",),
    "signorini.model.accuracy": ("Accuracy",),
    "signorini.model.body": ("Body",),
    "signorini.model.bolt": ("Bolt",),
    "signorini.model.conditions": ("Foundation", "Load", "Support"),
    "signorini.model.contact": ("Contact",),
    "signorini.model.fatigue": ("Fatigue",),
    "signorini.model.links": ("CyclicSymmetry", "Equation", "RigidBody"),
    "signorini.model.material": ("Elastic", "Orthotropic"),
    "signorini.model.mesh": ("Mesh", "join"),
    "signorini.model.model": ("Model",),
    "signorini.model.obstacle": ("Circle", "Plane", "Profile", "Sphere"),
    "signorini.model.revolved": ("Cone", "Cylinder", "Torus"),
    "signorini.model.plastic": ("Plastic",),
    "signorini.model.rigid": ("Rigid",),
    "signorini.model.step": ("Step",),
    "signorini.model.triangulated": ("Surface",),
    "signorini.model.varying": ("Along", "ArcLength", "Formula", "NodeValues", "Scattered"),
    "signorini.model.wear": ("Wear",),
    "signorini.prepared": ("prepare",),
    "signorini.settings": ("SolverSettings",),
    "signorini.solved": ("Solution",),
    "signorini.study.sweep": ("sweep",),
    "signorini.vibration.damping": ("joint_damping",),
    "signorini.vibration.modes": ("natural_modes",),
}
_MODULES = {"fatigue": "signorini.fatigue", "lcp": "signorini.lcp", "paper": "signorini.engine.paper"}
_HOME_OF = {name: module for module, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return importlib.import_module(_MODULES[name])
    if name not in _HOME_OF:
        raise AttributeError(f"module 'signorini' has no attribute '{name}'")
    value = getattr(importlib.import_module(_HOME_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
