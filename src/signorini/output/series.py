# SPDX-License-Identifier: BSD-3-Clause
"""Fields at the ends of steps and at times asked for, as a series that ParaView opens as an animation."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

from signorini.distributed.ranks import ON_RANKS
from signorini.output.atomic_write import atomic_write
from signorini.output.fields import Fields, State
from signorini.output.vtu import FIELDS, write_bodies, write_surfaces
from signorini.solution.history import History
from signorini.solution.results import StepResult

if TYPE_CHECKING:
    from signorini.output.rank_files import FieldsOnRanks

MIN_TIME_STEP = 1e-6  # of a step: so far apart are times of states at one load, a jump and where it lands


@dataclass(frozen=True, kw_only=True, eq=False)
class Frame:
    """A state of a series.

    Attributes
    ----------
    time : load factor: step k goes from k - 1 to k
    step, number : of the step, and of the state in it, from 1
    state : with its displacement: an instant on the way, or the end of the step
    """

    time: float
    step: int
    number: int
    state: State

    @property
    def last(self) -> bool:
        """Whether it is the end of its step."""
        return isinstance(self.state, StepResult)


def frames(history: History) -> list[Frame]:
    """The states whose displacements are kept, in order, at increasing times; nothing is copied."""
    found: list[Frame] = []
    time = 0.0
    for k, step in enumerate(history.steps, start=1):
        kept = [instant for instant in step.instants[:-1] if instant.deformed]
        states: list[State] = [*kept, step]
        for i, state in enumerate(states, start=1):
            time = max(state.load_factor, time + MIN_TIME_STEP)
            found.append(Frame(time=time, step=k, number=i, state=state))
    return found


def write_series(
    fields: Fields,
    states: Sequence[Frame],
    folder: Path,
    *,
    bodies: str = "solution",
    surfaces: str = "contact",
    done: Collection[str] = (),
    compress: bool = False,
    ranks: FieldsOnRanks | None = None,
) -> list[str]:
    """Write fields of the bodies and of the contact surfaces, and the lists that ParaView opens.

    Stresses are computed and written state by state. ``bodies.pvd`` lists ``bodies_0001.vtu``, ... for the ends of
    steps and ``fields/bodies_0001_0001.vtu``, ... for what is between; ``surfaces.pvd`` lists contact surfaces, all in
    ``fields``. Their times are load factors: step k goes from k - 1 to k.

    Parameters
    ----------
    fields : of the model
    states : of :func:`frames`
    folder : for the lists, and for ``fields``
    bodies, surfaces : how the names of the files begin
    done : names of files that were written before, and are left out
    compress : whether files of bodies are
    ranks : that write the bodies, each its own file, whose index ``bodies_0001.pvtu`` is listed; None: one process does

    Returns
    -------
    Names of the files in the folder, the lists last
    """
    model = fields.model
    touching, shown = bool(model.contacts), []
    lists: dict[str, list[tuple[float, str]]] = {name: [] for name in (bodies, surfaces)[: 1 + touching]}
    if touching or ranks or not all(frame.last for frame in states):
        (folder / FIELDS).mkdir(exist_ok=True)
    for frame in states:
        within = f"{frame.step:04d}_{frame.number:04d}"
        name = f"{bodies}_{frame.step:04d}" if frame.last else f"{FIELDS}/{bodies}_{within}"
        shown += write_state(fields, frame.state, folder, name, done=done, compress=compress, ranks=ranks)
        lists[bodies].append((frame.time, shown[-1]))
        if touching:
            name = f"{FIELDS}/{surfaces}_{within}.vtu"
            if name not in done:
                write_surfaces(model, frame.state.contacts, folder / name)
            lists[surfaces].append((frame.time, name))
    for name, entries in lists.items():
        with atomic_write(folder / f"{name}.pvd") as aside:
            aside.write_text(listed(entries) + "\n", encoding="utf-8")
    return [*shown, *(name for _, name in lists.get(surfaces, ())), *(f"{name}.pvd" for name in lists)]


def write_state(
    fields: Fields,
    state: State,
    folder: Path,
    name: str,
    *,
    done: Collection[str] = (),
    compress: bool = False,
    ranks: FieldsOnRanks | None = None,
) -> list[str]:
    """Write the bodies in one state, unless that was done before; the names of its files, what to open last.

    Parameters
    ----------
    fields, state : of the model, and which one
    folder, name : in which the file is, and how it is called there, without an ending
    done, compress, ranks : as of :func:`write_series`
    """
    if ranks is not None:
        names = ranks.files(f"{name}.pvtu")
        if names[-1] not in done:
            ranks.write(state, folder, f"{name}.pvtu", compress=compress)
        return names
    if f"{name}.vtu" not in done:
        write_bodies(fields.at(state, strained=True), folder / f"{name}.vtu", compress=compress)
    return [f"{name}.vtu"]


def write_pvd(history: History, fields: Fields, path: Path, *, compress: bool = False) -> None:
    """Write a history as a series whose list is ``path``, ``NAME.pvd``, with ``NAME_contact.pvd`` of its contacts.

    Parameters
    ----------
    history, fields : what is written, and the fields of its model
    path, compress : of the list, and whether files of bodies are, see :func:`write_series`

    Raises
    ------
    InputError
        If nothing was solved.
    """
    _ = history.last
    states, names = frames(history), {"bodies": path.stem, "surfaces": f"{path.stem}_contact"}
    write_series(fields, states, path.parent, **names, compress=compress, ranks=with_ranks(history))


def with_ranks(history: History) -> FieldsOnRanks | None:
    """The bodies where several ranks have them, see :func:`signorini.output.rank_files.fields_on_ranks`; or None.

    Parameters
    ----------
    history : of any back end: those of one process import nothing
    """
    if history.backend not in ON_RANKS:
        return None
    from signorini.output.rank_files import fields_on_ranks

    return fields_on_ranks(history)


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
