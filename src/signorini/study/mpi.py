# SPDX-License-Identifier: BSD-3-Clause
"""Ranks of MPI among which rows are shared out."""

from __future__ import annotations

import os
from typing import Any

from signorini.errors import InputError

_SIZES = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE")
"""What launchers tell of how many ranks there are: Open MPI; MPICH, Intel MPI and Slurm."""


def world() -> Any:
    """The communicator of all ranks, where a launcher has started several; None.

    Raises
    ------
    InputError
        If mpi4py cannot be imported.

    Examples
    --------
    >>> world() is None
    True
    """
    if max(int(os.environ.get(name) or 1) for name in _SIZES) < 2:
        return None
    try:
        from mpi4py import MPI
    except ImportError as error:
        raise InputError(f"rows on several ranks need mpi4py ({error}); expected it, or one process") from error
    return MPI.COMM_WORLD if MPI.COMM_WORLD.size > 1 else None
