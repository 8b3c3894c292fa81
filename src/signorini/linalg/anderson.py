# SPDX-License-Identifier: BSD-3-Clause
"""Anderson's acceleration of fixed-point iterations ``x <- g(x)``."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signorini.arrays import Array


def anderson(inputs: Sequence[Array], outputs: Sequence[Array], scale: Array, *, rcond: float = 1e-10) -> Array:
    """The next input (n,): of all affine combinations of outputs the one whose residual is the least.

    Parameters
    ----------
    inputs, outputs : of the last rounds, each (n,), the last of all at the end
    scale : (n,) what residuals ``output - input`` are multiplied by before they are measured
    rcond : of differences of residuals, relative to the largest: below it they are none

    References
    ----------
    Walker, Ni (2011), Anderson acceleration for fixed-point iterations, SIAM J. Numer. Anal. 49:1715.

    Examples
    --------
    >>> A = np.array([[0.9, 0.1], [0.0, 0.5]])  # x = A x + 1 in three rounds
    >>> x = [np.zeros(2)]
    >>> for _ in range(3):
    ...     x.append(anderson(x, [A @ each + 1.0 for each in x], np.ones(2)))
    >>> np.allclose(x[-1], A @ x[-1] + 1.0)
    True
    """
    if len(inputs) == 1:
        return outputs[0]
    became = np.stack(outputs, axis=1)
    missing = (became - np.stack(inputs, axis=1)) * scale[:, None]
    share = np.linalg.lstsq(np.diff(missing, axis=1), missing[:, -1], rcond=rcond)[0]
    following: Array = became[:, -1] - np.diff(became, axis=1) @ share
    return following
