# SPDX-License-Identifier: BSD-3-Clause
"""Pixels as a picture file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from signorini.errors import InputError
from signorini.output.atomic_write import atomic_write


def check_png(path: Path) -> Path:
    """Look at the name before anything is drawn.

    Raises
    ------
    InputError
        If it does not end in ``.png``.
    """
    if path.suffix.lower() != ".png":
        raise InputError(f"is '{path}'; expected a name that ends in .png", where=("path",))
    return path


def write_pixels(pixels: NDArray[np.uint8], path: Path) -> None:
    """Write pixels (height, width, 3) as ``*.png``.

    Raises
    ------
    InputError
        If the name ends otherwise.
    """
    from matplotlib.image import imsave

    with atomic_write(check_png(path)) as aside:
        imsave(aside, pixels)
