# SPDX-License-Identifier: BSD-3-Clause
"""Fields at the ends of steps and at times asked for, as a series that ParaView opens as an animation."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from signorini.arrays import Array
from signorini.errors import InputError
from signorini.fem.space import make_space
from signorini.model.model import Model
from signorini.output.atomic_write import atomic_write
from signorini.output.surface import write_surfaces
from signorini.output.vtu import write_fields
from signorini.solution.history import History
from signorini.solution.results import ContactResult

FIELDS = "fields"
"""The folder of the files that are no ends of steps."""

_APART = 1e-6  # of a step: times of what happens at one load, a jump and where it lands


@dataclass(frozen=True, kw_only=True, eq=False)
class Frame:
    """A state of a series.

    Attributes
    ----------
    time : load factor: step k goes from k - 1 to k
    step, number : of the step, and of the state in it, from 1
    last : whether it is the end of the step
    displacement, factors, contacts : as an instant has them
    """

    time: float
    step: int
    number: int
    last: bool
    displacement: Array
    factors: Mapping[str, float]
    contacts: tuple[ContactResult, ...]


def frames(history: History) -> list[Frame]:
    """The states whose displacements are kept, in order, at increasing times; nothing is copied."""
    found: list[Frame] = []
    time = 0.0
    for k, step in enumerate(history.steps, start=1):
        kept = [(shot.load_factor, shot.displacement, shot.factors, shot.contacts) for shot in step.instants[:-1]]
        kept = [shot for shot in kept if shot[1] is not None]
        kept.append((step.load_factor, step.displacement, step.factors, step.contacts))
        for i, (load_factor, displacement, factors, contacts) in enumerate(kept, start=1):
            assert displacement is not None
            time = max(load_factor, time + _APART)
            found.append(
                Frame(
                    time=time,
                    step=k,
                    number=i,
                    last=i == len(kept),
                    displacement=displacement,
                    factors=factors,
                    contacts=contacts,
                )
            )
    return found


def write_series(
    model: Model,
    states: Sequence[Frame],
    folder: Path,
    *,
    bodies: str = "solution",
    surfaces: str = "contact",
    done: Collection[str] = (),
) -> list[str]:
    """Write fields of the bodies, in space of the contact surfaces too, and the lists that ParaView opens.

    Stresses are computed and written state by state. ``bodies.pvd`` lists ``bodies_0001.vtu``, ... for the ends of
    steps and ``fields/bodies_0001_0001.vtu``, ... for what is between; ``surfaces.pvd`` the same of contacts, all in
    ``fields``. Their times are load factors: step k goes from k - 1 to k.

    Parameters
    ----------
    bodies, surfaces : how the names of the files begin
    done : names of files that were written before, and are left out

    Returns
    -------
    Names of the files in the folder, the lists last
    """
    space = make_space(model.mesh, axisymmetric=model.axisymmetric)
    touching = model.dimension == 3 and bool(model.contacts)
    lists: dict[str, list[tuple[float, str]]] = {name: [] for name in (bodies, surfaces)[: 1 + touching]}
    if touching or not all(state.last for state in states):
        (folder / FIELDS).mkdir(exist_ok=True)
    for state in states:
        within = f"{state.step:04d}_{state.number:04d}.vtu"
        name = f"{bodies}_{state.step:04d}.vtu" if state.last else f"{FIELDS}/{bodies}_{within}"
        if name not in done:
            write_fields(space, model, state.displacement, state.factors, folder / name)
        lists[bodies].append((state.time, name))
        if touching:
            name = f"{FIELDS}/{surfaces}_{within}"
            if name not in done:
                write_surfaces(model, state.contacts, folder / name)
            lists[surfaces].append((state.time, name))
    for name, entries in lists.items():
        with atomic_write(folder / f"{name}.pvd") as aside:
            aside.write_text(listed(entries) + "\n", encoding="utf-8")
    return [*(name for entries in lists.values() for _, name in entries), *(f"{name}.pvd" for name in lists)]


def write_pvd(history: History, path: Path) -> None:
    """Write a series whose list is a file ``NAME.pvd``, with ``NAME_contact.pvd`` in space; see :func:`write_series`.

    Raises
    ------
    InputError
        If nothing was solved.
    """
    if not history.steps:
        raise InputError("nothing was solved; there is no result")
    write_series(history.model, frames(history), path.parent, bodies=path.stem, surfaces=f"{path.stem}_contact")


def listed(entries: Sequence[tuple[float, str]]) -> str:
    """A PVD document of files and their times.

    >>> print(listed([(0.5, "fields/solution_0001_0001.vtu"), (1.0, "solution_0001.vtu")]))
    <VTKFile type="Collection" version="0.1">
      <Collection>
        <DataSet timestep="0.5" file="fields/solution_0001_0001.vtu" />
        <DataSet timestep="1" file="solution_0001.vtu" />
      </Collection>
    </VTKFile>
    """
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1")
    collection = ElementTree.SubElement(root, "Collection")
    for time, name in entries:
        ElementTree.SubElement(collection, "DataSet", timestep=f"{time:.12g}", file=name)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode")
