# SPDX-License-Identifier: BSD-3-Clause
"""Motions of bodies of revolution in pictures of their meridian."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array

HOOP_WORDS = "around the axis: up and to the right"
"""For titles: where `oblique` draws what goes round."""

_AWAY = np.array([0.7, 0.5])  # where the third axis points in the picture, as in a cabinet drawing


def oblique(motion: Array) -> Array:
    """Motions (n, 2 or 3) in the picture, (n, 2): what goes around the axis leaves the meridian at an angle.

    Parameters
    ----------
    motion : length

    Examples
    --------
    >>> oblique(np.array([[1.0, 0.0, 2.0]])).tolist()
    [[2.4, 1.0]]
    """
    return motion[:, :2] + motion[:, 2:3] * _AWAY if motion.shape[1] == 3 else motion
