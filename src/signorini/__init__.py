# SPDX-License-Identifier: BSD-3-Clause
"""signorini: frictional elastic contact by finite elements and linear complementarity."""

from signorini._version import __version__

__all__ = ["__version__"]
