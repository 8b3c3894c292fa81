# SPDX-License-Identifier: BSD-3-Clause
"""Which keywords are read, which can be left out without changing the answer, and which cannot."""

from __future__ import annotations

OUTPUT = (
    "CONTACT OUTPUT",
    "ELEMENT OUTPUT",
    "ENERGY FILE",
    "ENERGY OUTPUT",
    "ENERGY PRINT",
    "FACE PRINT",
    "FILE FORMAT",
    "FILE OUTPUT",
    "FILTER",
    "MONITOR",
    "NODE OUTPUT",
    "OUTPUT",
    "PREPRINT",
    "PRINT",
    "RESTART",
    "SECTION FILE",
    "SECTION PRINT",
    "TIME POINTS",
    "USER OUTPUT VARIABLES",
)
"""What to write, which does not change the answer."""

PRINTED = ("CONTACT FILE", "CONTACT PRINT", "EL FILE", "EL PRINT", "NODE FILE", "NODE PRINT")
"""What to write, which is written: ``.frd`` always, ``.dat`` as asked for."""

HARMLESS = (
    *OUTPUT,
    "CONDUCTIVITY",
    "CONTACT CONTROLS",
    "CONTACT STABILIZATION",
    "CONTROLS",
    "DAMPING",
    "DIAGNOSTICS",
    "GAP CONDUCTANCE",
    "GAP HEAT GENERATION",
    "HOURGLASS STIFFNESS",
    "PHYSICAL CONSTANTS",
    "SECTION CONTROLS",
    "SOLUTION TECHNIQUE",
    "SPECIFIC HEAT",
)
"""What does not act in a static analysis of displacements, and how other programs find the answer."""

MODEL_WORDS = (
    "AMPLITUDE",
    "BOUNDARY",
    "CLEARANCE",
    "CONTACT PAIR",
    "COUPLING",
    "DENSITY",
    "DISTRIBUTING",
    "ELASTIC",
    "ELEMENT",
    "ELSET",
    "EQUATION",
    "EXPANSION",
    "FRICTION",
    "HEADING",
    "INITIAL CONDITIONS",
    "KINEMATIC",
    "MATERIAL",
    "NODE",
    "NSET",
    "ORIENTATION",
    "RIGID BODY",
    "SOLID SECTION",
    "SURFACE",
    "SURFACE BEHAVIOR",
    "SURFACE INTERACTION",
    "TIE",
)
"""What is read outside the steps."""

STEP_WORDS = (
    *PRINTED,
    "AMPLITUDE",
    "BOUNDARY",
    "CHANGE CONTACT PAIR",
    "CHANGE FRICTION",
    "CLOAD",
    "DLOAD",
    "DSLOAD",
    "ELSET",
    "FRICTION",
    "MODEL CHANGE",
    "NSET",
    "STATIC",
    "TEMPERATURE",
)
"""What is read inside the steps."""


STRUCTURE = (
    "ASSEMBLY",
    "END ASSEMBLY",
    "END INSTANCE",
    "END PART",
    "END STEP",
    "INCLUDE",
    "INSTANCE",
    "PART",
    "STEP",
)
"""What orders the others."""
