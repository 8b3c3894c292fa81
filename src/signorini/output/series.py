# SPDX-License-Identifier: BSD-3-Clause
"""The list of a series of VTU files, one a step, that ParaView opens as an animation."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree


def series(names: Sequence[str]) -> str:
    """A PVD document; file k is shown at time k, counted from 1.

    >>> print(series(["solution_0001.vtu"]))
    <VTKFile type="Collection" version="0.1">
      <Collection>
        <DataSet timestep="1" file="solution_0001.vtu" />
      </Collection>
    </VTKFile>
    """
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1")
    collection = ElementTree.SubElement(root, "Collection")
    for number, name in enumerate(names, start=1):
        ElementTree.SubElement(collection, "DataSet", timestep=str(number), file=name)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode")
