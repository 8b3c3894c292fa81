# SPDX-License-Identifier: BSD-3-Clause
"""What results take in memory, asked for before they are made."""

from __future__ import annotations

from signorini.memory import available_memory
from signorini.model.model import Model

# measured (tests/output/test_memory.py)
_RESULTS = 40e6  # bytes of writing results, whatever the size: points of thousands of cells at a time, buffers of HDF5
# bytes a node by the dimension: stresses, strains and forces there, and what files make of them
_RESULTS_NODE = {2: 850.0, 3: 3600.0}
_STRESSES_NODE = 56.0  # bytes a node of the stresses at the end of a step, with its number
_SHARE = 0.5  # of the memory that there is: what stresses that are kept may fill


def results_bytes(model: Model) -> float:
    """The most that writing the fields of one state takes, of elastic bodies in files of every kind.

    That is less than the least that a solve takes, and is taken when what a solve holds is given back; but where a step
    is written before the next one is solved, both are held at once.

    Parameters
    ----------
    model : of the state
    """
    return _RESULTS + _RESULTS_NODE[model.dimension] * model.mesh.number_of_nodes


def shared_states(model: Model) -> int:
    """Of how many states the stresses may be kept that several files need: those of half of the memory.

    Parameters
    ----------
    model : of the states
    """
    return int(_SHARE * available_memory() / (_STRESSES_NODE * max(1, model.mesh.number_of_nodes)))
