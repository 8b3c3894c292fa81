# SPDX-License-Identifier: BSD-3-Clause
"""What a thousand ranks would take, on paper: from messages, bytes and operations that PETSc counts on a few.

Two cubes whose meshes do not match are solved on 2 and 4 ranks, and what ``-log_view`` counts is taken apart: of an
iteration of conjugate gradients, and of a change of the springs of the pairs. How far a share reaches into those of
others is counted in a cut into 64. Needs petsc4py, mpi4py and mpiexec.

usage: python -m benchmarks.ranks_on_paper [--small] [--room] [--dry]
"""

from __future__ import annotations

import json
import math
import pickle
from collections.abc import Iterable
from typing import Any

import numpy as np

import signorini as sg
from benchmarks import command, page
from benchmarks.distributed import PAGE, on_ranks
from signorini.distributed.partition import owners
from signorini.distributed.ranks import Team, the_team
from signorini.engine.examine import examine
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cubes import cubes

# what is assumed: a node of 48 cores, a rank on each, with 200 GB/s of memory and a network of 25 GB/s
LATENCY = 2e-6  # seconds a message, to begin it and until it is there
NETWORK = 25e9 / 48  # bytes a second of a rank
MEMORY = 200e9 / 48  # bytes a second of a rank
AN_ENTRY = 12.0  # bytes of a sparse matrix: a number and its column
BYTES_A_FLOP = AN_ENTRY / 2.0  # an entry is read for two operations
TO_ONE = 12.5e9  # bytes a second that the first rank sends or takes in: half of the network of its node
AT_ONCE = 64  # ranks into which a mesh is cut to count neighbours
PAPER = ((1e7, 10), (1e8, 100), (1e9, 1000))  # unknowns and ranks
ROOMS = ((1e7, 16), (1e7, 64))  # nodes and ranks whose memory is told
BOTH_ENDS = 2.0  # PETSc counts a message where it starts and where it ends
KINDS = ("KSPSolve", "PCSetUp", "MatMult", "MatMultAdd", "MatMultTranspose")
NUMBERS = ("count", "flops", "numMessages", "messageLength", "numReductions")
COUNTED: dict[str, Any] = {"iterations": 0, "changes": 0, "solves": 0.0, "springs": 0.0, "exchanged": 0}


def so_far() -> Any:
    """(kinds, numbers) What PETSc has counted on this rank."""
    from petsc4py import PETSc

    found = [PETSc.Log.Event(kind).getPerfInfo() for kind in KINDS]
    return np.array([[float(one[name]) for name in NUMBERS] for one in found])


def count(team: Team) -> None:
    """Count from now on what cycles take on this rank, and what the first one sends and is sent."""
    from petsc4py import PETSc

    from signorini.distributed.multigrid import SpringCycle

    PETSc.Log.begin()
    changing = PETSc.Log.Event("springs change")
    solved, under, everywhere = SpringCycle.solved, SpringCycle.under, Team.everywhere

    def counted_solve(self: SpringCycle, springs: Any, g: Any, residual: float) -> tuple[Any, int]:
        before = so_far()
        x, iterations = solved(self, springs, g, residual)
        COUNTED["solves"] += so_far() - before
        COUNTED["iterations"] += iterations
        held = [*self._grids.K, *self._grids.P, *self._A, *self._springs, *self._seen]
        COUNTED["levels"] = [K.getSize()[0] for K in self._grids.K]
        COUNTED["held"] = sum(AN_ENTRY * one.getInfo(PETSc.Mat.InfoType.LOCAL)["nz_allocated"] for one in held)
        return x, iterations

    def counted_change(self: SpringCycle, springs: Any) -> None:
        changing.begin()
        under(self, springs)
        changing.end()
        found = changing.getPerfInfo()
        COUNTED["springs"] = np.array([float(found[name]) for name in NUMBERS])

    def counted_words(self: Team, work: Any, *given: Any, pieces: Iterable[Any] | None = None) -> list[Any]:
        def weighed(parts: Iterable[Any]) -> Iterable[Any]:
            for rank, part in enumerate(parts):
                COUNTED["exchanged"] += len(pickle.dumps(part)) if rank else 0
                yield part

        result = everywhere(self, work, *given, pieces=None if pieces is None else weighed(pieces))
        COUNTED["exchanged"] += len(pickle.dumps(result[1:]))
        return result

    SpringCycle.solved = counted_solve  # type: ignore[method-assign]
    SpringCycle.under = counted_change  # type: ignore[method-assign]
    if team.first:
        Team.everywhere = counted_words  # type: ignore[method-assign]


def counted(team: Team) -> dict[str, Any]:
    """What this rank has counted."""
    del team
    return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in COUNTED.items()}


def measured(lower: int, upper: int) -> dict[str, Any]:
    """What an iteration and a change of springs take of a rank, the most of all ranks."""
    model, team = cubes(lower, upper), the_team()
    prepared = prepare(model, backend="petsc")
    team.everywhere(count)
    history = solve_prepared(prepared)
    exchanged = COUNTED["exchanged"]
    found = team.everywhere(counted)
    iterations = found[0]["iterations"]
    solves = np.array([each["solves"] for each in found]) / iterations
    springs = np.array([each["springs"] for each in found])
    whole, made = solves[:, 0, 1:], solves[:, 1, 1:]  # without what a change leaves to the next solve
    halo = solves[:, 2:, 1:].sum(axis=1)
    levels = found[0]["levels"]
    return {
        "unknowns": model.number_of_dofs,
        "pairs": history.pairs,
        "nodes": len(model.mesh.points),
        "deep": reach((lower, upper), team.size)[1],
        "ranks": team.size,
        "rounds": history.last.trace[0][-1].iterations,
        "iterations": iterations,
        "levels": levels,
        "flops": float((whole - made)[:, 0].max()),
        "messages": float((whole - made)[:, 1].max() / BOTH_ENDS),
        "halo": float(halo[:, 1].max() / BOTH_ENDS),
        "bytes": float((whole - made)[:, 2].max() / BOTH_ENDS),
        "sums": float((whole - made)[:, 3].max()),
        "changes": float(springs[0, 0]),
        "change messages": float(((springs[:, 2] + iterations * made[:, 1]) / springs[0, 0]).max() / BOTH_ENDS),
        "change bytes": float(((springs[:, 3] + iterations * made[:, 2]) / springs[0, 0]).max() / BOTH_ENDS),
        "change flops": float(((springs[:, 1] + iterations * made[:, 0]) / springs[0, 0]).max()),
        "held": max(each["held"] for each in found),
        "exchanged": exchanged,
    }


def reach(size: tuple[int, int], parts: int) -> tuple[int, float]:
    """The most ranks beside one, and nodes of others that it sees, over the power 2/3 of its own."""
    examined = examine(cubes(*size))
    mesh = examined.space.mesh
    owner = owners(examined.space, examined.interface.B, parts)
    own = np.bincount(owner, minlength=parts)
    beside, deep = 0, 0.0
    for rank in range(parts):
        near = [cells[(owner[cells] == rank).any(axis=1)].ravel() for cells in mesh.cells.values()]
        seen = np.unique(np.concatenate(near))
        others = owner[seen][owner[seen] != rank]
        beside, deep = max(beside, len(np.unique(others))), max(deep, len(others) / own[rank] ** (2 / 3))
    return beside, deep


def on_paper(
    unknowns: float, ranks: int, small: dict[str, Any], found: dict[str, Any], beside: int, deep: float
) -> list[float]:
    """Seconds of an iteration by their reasons, of all iterations, of changes, and of what the first rank hands on."""
    sizes = found["levels"][::-1]  # the finest first
    coarsening = sizes[0] / sizes[1]
    levels = 1 + max(1, math.ceil(math.log(unknowns / sizes[-1]) / math.log(coarsening)))
    steepness = math.log(found["iterations"] / small["iterations"]) / math.log(found["unknowns"] / small["unknowns"])
    iterations = found["iterations"] * (unknowns / found["unknowns"]) ** max(steepness, 0.0)
    share = unknowns / ranks
    # the coarsest level is solved with on every rank, by two dense factors
    dense = 4.0 * sizes[-1] ** 2
    per_unknown = (found["flops"] - dense) * found["ranks"] / found["unknowns"]
    exchanges = found["halo"] / (found["ranks"] - 1)  # everyone is beside everyone
    a_level = (exchanges - 1.0) / (len(sizes) - 1)
    streamed = per_unknown * share * BYTES_A_FLOP / MEMORY
    waited = (1.0 + a_level * (levels - 1)) * beside * LATENCY
    surface = (share / (found["unknowns"] / found["ranks"])) ** (2 / 3)
    carried = found["bytes"] * surface * deep / found["deep"] / NETWORK
    summed = found["sums"] * 2.0 * math.log2(ranks) * LATENCY
    coarsest = (ranks - 1) * LATENCY + dense / 2.0 * 8.0 / MEMORY
    each = streamed + waited + carried + summed + coarsest
    pairs = (unknowns / found["unknowns"]) ** (2 / 3) / ranks * found["ranks"]
    copied = 2.0 * found["held"] * found["ranks"] / found["unknowns"] * share / MEMORY
    change = found["change messages"] / (found["ranks"] - 1) * beside * LATENCY + copied
    change += (found["change bytes"] / NETWORK + found["change flops"] * BYTES_A_FLOP / MEMORY) * pairs
    elsewhere = (1.0 - 1.0 / ranks) / (1.0 - 1.0 / found["ranks"])
    handed = found["exchanged"] / found["unknowns"] * unknowns * elsewhere / TO_ONE
    talk = (waited + carried + summed + (ranks - 1) * LATENCY) / each
    parts = [1e3 * part for part in (streamed, waited, carried, summed, coarsest, each)]
    return [iterations, levels, *parts, 100 * talk, iterations * each, found["changes"] * change, handed]


def assumptions(beside: int, deep: float) -> str:
    """What times on paper stand on."""
    words = f"""
- {LATENCY * 1e6:g} microseconds a message, and of every rank {NETWORK / 1e9:.2f} GB/s of the network and
  {MEMORY / 1e9:.1f} GB/s of memory: nodes of 48 cores with 25 and 200 GB/s. Matrices are read from memory,
  {BYTES_A_FLOP:g} bytes an operation; nothing overlaps.
- A rank exchanges with {beside} others, the most in a cut into {AT_ONCE}, and of their nodes it sees {deep:.1f} m^(2/3)
  where it has m; on every level as many exchanges as were counted, and as many bytes a node that is seen.
- A sum of all ranks takes twice the binary logarithm of their number in messages. Of the coarsest level one
  rank sends to all others, one by one, and each solves it by dense factors.
- Conjugate gradients grow by the power of the unknowns that they grow by between the first and the last mesh
  above, changes of springs not; pairs by the power 2/3 of the unknowns, shared evenly.
- What the first rank sends and is sent while it solves, at {TO_ONE / 1e9:g} GB/s, grows with the unknowns.
"""
    return words.lstrip() + "\n"


def last_lines(name: str, number: int) -> list[list[str]]:
    """Cells of the last lines of a table on the page."""
    begin, end = page.markers(name)
    written = PAGE.read_text(encoding="utf-8").partition(begin)[2].partition(end)[0]
    return [[cell.strip() for cell in line.strip("| ").split("|")] for line in written.strip().splitlines()[-number:]]


def rooms() -> list[list[object]]:
    """GB of the first rank and of the others, from the last lines of the tables of memory and counts on the page."""
    lines, (counts,) = last_lines("memory of ranks", 2), last_lines("counts of ranks", 1)
    (few, many), columns = (int(line[1]) for line in lines), [[cell.split(", ") for cell in line[2:]] for line in lines]
    kept = 1e3 * float(counts[COUNTS.index("kB an unknown in PETSc")])
    rows: list[list[object]] = []
    for nodes, ranks in (*ROOMS, *((unknowns / 3, ranks) for unknowns, ranks in PAPER)):
        cells = []
        for one, other in zip(*columns, strict=True):
            slope = max(float(one[0]) - float(other[0]), 0.0) / (1 / few - 1 / many)
            first = max(float(other[0]) - slope / many, 0.0) + slope / ranks
            cells += [held * 1e3 * nodes / 1e9 for held in (first, float(one[1]) * few / ranks)]
        shown = [f"{first:.3g}, {others:.2g}" for first, others in zip(cells[::2], cells[1::2], strict=True)]
        rows.append([f"{nodes:.2g}", ranks, *shown, f"{kept * 3 * nodes / ranks / 1e9:.2g}"])
    return rows


COUNTS = ["unknowns", "pairs", "ranks", "conjugate gradients", "levels", "Mflop", "messages", "kB", "sums"]
COUNTS += ["changes of springs", "Mflop a change", "messages a change", "kB a change", "kB an unknown in PETSc"]
COUNTS += ["bytes an unknown by the first rank"]
TIMES = ["unknowns", "ranks", "conjugate gradients", "levels", "ms: memory", "messages", "bytes", "sums", "coarsest"]
TIMES += ["in all", "% communication", "s of all", "s of changes", "s through the first rank"]
ROOM = ["nodes", "ranks", "bodies and pieces", "most up to there", "most while it is solved", "the history"]
ROOM += ["most beside it for the files", "PETSc"]


def count_row(found: dict[str, Any]) -> list[object]:
    """A line of the table of what was counted."""
    an_iteration = [found["flops"] / 1e6, found["messages"], found["bytes"] / 1e3, found["sums"]]
    a_change = [found["change flops"] / 1e6, found["change messages"], found["change bytes"] / 1e3]
    kept = found["held"] * found["ranks"] / found["unknowns"]
    return [
        *(found[name] for name in ("unknowns", "pairs", "ranks", "iterations")),
        " ".join(map(str, found["levels"][::-1])),
        *(f"{number:.3g}" for number in an_iteration),
        f"{found['changes']:.0f}",
        *(f"{number:.3g}" for number in a_change),
        f"{kept / 1e3:.2f}",
        f"{found['exchanged'] / found['unknowns']:.0f}",
    ]


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--small", action="store_true", help="sizes that take seconds")
    parser.add_argument("--room", action="store_true", help="memory alone, from the tables on the page")
    parser.add_argument("--one", nargs=2, type=int, metavar="N", help="count cubes of so many cells on these ranks")
    options = parser.parse_args()
    if options.one:
        with sg.ranks() as first:
            if first:
                print(json.dumps(measured(*options.one)))
        return
    if options.room:
        command.publish(options, "room on paper", page.table(ROOM, rooms()), PAGE)
        return
    sizes = ((5, 4), (8, 7)) if options.small else ((10, 9), (14, 12), (18, 16))
    found = [on_ranks(ranks, size, module="benchmarks.ranks_on_paper") for size in sizes for ranks in (2, 4)]
    command.publish(options, "counts of ranks", page.table(COUNTS, [count_row(one) for one in found]), PAGE)
    beside, deep = reach((12, 11) if options.small else (24, 22), AT_ONCE)
    words = assumptions(beside, deep)
    rows = []
    for unknowns, ranks in PAPER:
        numbers = on_paper(unknowns, ranks, found[1], found[-1], beside, deep)
        rows.append([f"{unknowns:.0e}", ranks, *(f"{number:.3g}" for number in numbers)])
    command.publish(options, "ranks on paper", words + page.table(TIMES, rows), PAGE)
    command.publish(options, "room on paper", page.table(ROOM, rooms()), PAGE)


if __name__ == "__main__":
    main()
