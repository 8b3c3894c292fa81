# SPDX-License-Identifier: BSD-3-Clause
"""The commands and their options."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any

from signorini._version import __version__
from signorini.model.modes import JOINTS

_PURPOSE = "Frictional elastic contact by finite elements and linear complementarity."
PICTURES = (
    *("contact", "stress", "displacement", "peeq", "mesh", "view", "history", "wear", "fatigue", "accuracy"),
    "escape",
)
"""Of a result folder, see `plot.pictures`, which is too heavy for a parser."""

_EXITS = """exit codes: 0 done (run: solved and certified), 2 the input is wrong, 3 no certified solution,
1 a check failed or an internal error, 130 interrupted"""


def make_parser() -> argparse.ArgumentParser:
    """The parser of ``signorini``; the chosen command is in ``command``."""
    parser = argparse.ArgumentParser(
        prog="signorini",
        description=_PURPOSE,
        epilog=_EXITS,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"signorini {__version__}")
    shared = argparse.ArgumentParser(add_help=False)
    shared.add_argument("--debug", action="store_true", help="show where an internal error happened")
    keywords = _deck_options()
    keywords.add_argument("--fatigue", metavar="FILE", help="ask for the [[fatigue]] tables of a TOML file instead")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    _add_run(commands, [shared, keywords])
    _add_sweep(commands, [shared, keywords])
    _add_modes(commands, [shared, keywords])
    _add_sensitivities(commands, [shared, keywords])

    check = commands.add_parser("check", parents=[shared, keywords], help="say what would be solved, what looks wrong")
    check.add_argument(
        "--wellposed",
        action="store_true",
        help="factorise, and say up to which friction uniqueness is proved",
    )
    check.add_argument("deck", metavar="DECK", help="a TOML file, or an Abaqus or CalculiX deck (.inp)")
    check.add_argument("--quiet", action="store_true", help="print nothing but errors")
    check.add_argument("--json", action="store_true", help="print plain data for other programs")

    convert = commands.add_parser("convert", parents=[shared, keywords], help="write a deck as TOML, its mesh as .vtu")
    convert.add_argument("deck", metavar="DECK", help="a TOML file, or an Abaqus or CalculiX deck (.inp)")
    convert.add_argument("-o", dest="output", metavar="FILE", help="TOML file (default: the deck's name with .toml)")

    diff = commands.add_parser("diff", parents=[shared], help="compare two results; exit code 1 if they differ")
    diff.add_argument("first", metavar="A", help="a folder that 'run' has written, or its archive (.h5)")
    diff.add_argument("second", metavar="B", help="the other")
    diff.add_argument("--tolerance", type=float, default=1e-6, metavar="X", help="of every quantity's size")

    _add_fatigue(commands, [shared])

    _add_plot(commands, [shared])
    _add_words(commands, [shared])
    _add_suites(commands, [shared])
    return parser


def _deck_options() -> argparse.ArgumentParser:
    """Options of all commands that read a deck."""
    keywords = argparse.ArgumentParser(add_help=False)
    keywords.add_argument("--small-strain", action="store_true", help="solve with small displacements despite NLGEOM")
    keywords.add_argument(
        "--increments", choices=("own", "deck"), default="own", help="of an .inp deck (own: as few as are exact)"
    )
    keywords.add_argument(
        "--allow", action="append", default=[], metavar="DIR", help="let the deck name files in DIR and below too"
    )
    keywords.add_argument(
        "--include",
        action="append",
        default=[],
        metavar="DIR",
        help="look for files that the deck names in DIR too, and allow them",
    )
    return keywords


def _add_threads(command: argparse.ArgumentParser) -> None:
    words = "that large models share (default: OMP_NUM_THREADS, or the physical cores); results do not depend on it"
    command.add_argument("--threads", type=int, metavar="N", help=words)


def _add_run(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    run = commands.add_parser("run", parents=parents, help="solve a deck and write the results")
    run.add_argument("deck", metavar="DECK", help="a TOML file, or an Abaqus or CalculiX deck (.inp)")
    run.add_argument("-o", dest="folder", metavar="DIR", help="result folder (default: out/ and the deck's name)")
    run.add_argument(
        "--from", dest="start", metavar="DIR", help="go on from the end of a run: its result folder, or its state.npz"
    )
    run.add_argument("--log", metavar="FILE", help="write what is done, with its time, into a file")
    run.add_argument("--quiet", action="store_true", help="print nothing but errors")
    run.add_argument("--json", action="store_true", help="print the summary as JSON instead of tables")
    run.add_argument(
        "--wellposed", action="store_true", help="ask whether the solution is the only one, and look for others"
    )
    run.add_argument(
        "--accuracy",
        metavar="ERROR",
        help="relative error of the pressures, 0.01 say: the mesh is refined until it is met; '0.01,of=peak "
        "pressure,nodes=50000,memory=4e9,seconds=60': of what, and within which bounds; 'estimate': as it is",
    )
    words = "make large files about half as large, which takes longer than to write them"
    run.add_argument("--compress", action="store_true", help=words)
    words = (
        "of the factorisation, 'iterative', or 'petsc' and 'mumps', which mpiexec runs on several ranks (default: auto)"
    )
    run.add_argument("--backend", default="auto", metavar="NAME", help=words)
    _add_threads(run)


def _add_sweep(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    sweep = commands.add_parser("sweep", parents=parents, help="solve a deck with many values of what it says")
    sweep.add_argument("deck", metavar="DECK", help="a TOML file, or an Abaqus or CalculiX deck (.inp)")
    sweep.add_argument(
        "--set",
        action="append",
        required=True,
        metavar="KEY=VALUES",
        help="FROM:TO:NUMBER, or values between commas; KEY as friction.CONTACT, load.NAME (a factor), E.BODY, or of a "
        "TOML deck any key, as mesh.nx; again for more of them: all combinations",
    )
    sweep.add_argument(
        "-o", dest="folder", metavar="DIR", help="folder; a sweep goes on from what is there (default: out/DECK_sweep)"
    )
    sweep.add_argument("--results", action="store_true", help="write a result folder for each row, too")
    words = "that share the rows (default: 1, and if that takes long the physical cores over the threads)"
    sweep.add_argument("--processes", type=int, metavar="N", help=words)
    sweep.add_argument("--quiet", action="store_true", help="print nothing but errors")
    sweep.add_argument("--json", action="store_true", help="print the rows as JSON instead of a table")
    words = "of the factorisation, 'iterative', or 'petsc' and 'mumps', which take all ranks of mpiexec for one row"
    sweep.add_argument("--backend", default="auto", metavar="NAME", help=words)
    _add_threads(sweep)


def _add_sensitivities(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    words = "the main answers by all that is given, per cent for per cent"
    by_all = commands.add_parser("sensitivities", parents=parents, help=words)
    by_all.add_argument("deck", metavar="DECK", help="a TOML file, or an Abaqus or CalculiX deck (.inp)")
    by_all.add_argument(
        "-o", dest="output", metavar="DIR", help="folder, of results maybe, for sensitivities.json, which reports show"
    )
    by_all.add_argument("--json", action="store_true", help="print plain data for other programs")
    _add_threads(by_all)


def _add_modes(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    modes = commands.add_parser("modes", parents=parents, help="natural frequencies about the end of a deck's steps")
    modes.add_argument("deck", metavar="DECK", help="a TOML file, or an Abaqus or CalculiX deck (.inp)")
    modes.add_argument("-n", dest="number", type=int, metavar="N", help="modes (default: as the deck says, or 6)")
    modes.add_argument(
        "--joint", dest="joints", action="append", choices=JOINTS, help="state of the joints, again for more of them"
    )
    modes.add_argument(
        "--nodal-diameters", type=int, metavar="H", help="waves around the ring that a cyclic sector is of (default: 0)"
    )
    modes.add_argument("--mode", type=int, metavar="K", help="whose loops are followed (default: 1)")
    modes.add_argument(
        "--amplitudes", type=float, nargs="+", metavar="A", help="of the loops: the largest displacement, ascending"
    )
    modes.add_argument("-o", dest="folder", metavar="DIR", help="result folder (default: out/ and the deck's name)")
    modes.add_argument("--log", metavar="FILE", help="write what is done, with its time, into a file")
    modes.add_argument("--quiet", action="store_true", help="print nothing but errors")
    _add_threads(modes)


def _add_fatigue(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    fatigue = commands.add_parser("fatigue", parents=parents, help="ask results for fatigue criteria, solving nothing")
    fatigue.add_argument("results", metavar="DIR", help="a folder that 'run' has written, or its archive (.h5)")
    fatigue.add_argument("asked", metavar="FILE", help="a TOML file with [[fatigue]] tables")
    fatigue.add_argument("-o", dest="folder", metavar="DIR", help="result folder (default: out/ and the file's name)")
    fatigue.add_argument("--quiet", action="store_true", help="print nothing but errors")


def _add_plot(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    plot = commands.add_parser("plot", parents=parents, help="draw the results in a folder")
    plot.add_argument("folder", metavar="DIR", help="a folder that 'run' has written")
    plot.add_argument("--what", choices=PICTURES, default="contact")
    plot.add_argument("--step", metavar="N", help="number of a step, or its name (default: the last one)")
    plot.add_argument("--load", type=float, metavar="X", help="part of the step that is behind, 0 to 1 (default: 1)")
    words = "of a stress: von_mises, principal, least_principal, xx, xy, ...; of a displacement: magnitude, x, y, z"
    plot.add_argument("--component", metavar="NAME", help=words)
    words = "of colours, or of the axis of pressures"
    plot.add_argument("--range", type=float, nargs=2, metavar=("MIN", "MAX"), help=words)
    words = "part that is shown: x from and to, y from and to, in space z; along a contact of the plane from and to"
    plot.add_argument("--zoom", type=float, nargs="+", metavar="X", help=words)
    plot.add_argument("--scale", type=float, metavar="S", help="factor of displacements, 0: undeformed")
    plot.add_argument("-o", dest="file", metavar="FILE", help="PNG, PDF or SVG file (default: WHAT.png in DIR)")

    table = commands.add_parser("table", parents=parents, help="write contacts or the history of results as columns")
    table.add_argument("folder", metavar="DIR", help="a folder that 'run' has written")
    table.add_argument("--what", choices=("contact", "history"), default="contact", help="default: contact")
    table.add_argument("--step", metavar="N", help="contacts at one step, its number or name (default: all)")
    table.add_argument("--load", type=float, metavar="X", help="part of the step that is behind, 0 to 1 (default: 1)")
    table.add_argument("-o", dest="file", metavar="FILE", help="CSV file (default: contact_table.csv, ... in DIR)")
    report = commands.add_parser("report", parents=parents, help="write the results in a folder as one HTML page")
    report.add_argument("folder", metavar="DIR", help="a folder that 'run' has written")
    report.add_argument("-o", dest="file", metavar="FILE", help="HTML file (default: report.html in DIR)")


def _add_words(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    commands.add_parser("schema", parents=parents, help="print the JSON schema of TOML decks, for editors")
    explain = commands.add_parser("explain", parents=parents, help="say what a key or a code means")
    explain.add_argument(
        "word", metavar="WORD", help="a key of decks, with its table or without, a status, an exit code"
    )

    commands.add_parser("doctor", parents=parents, help="say what is found on this machine, and what is missing")
    commands.add_parser("mcp", parents=parents, help="serve agents over standard input and output (an extra)")


def _add_suites(commands: Any, parents: Sequence[argparse.ArgumentParser]) -> None:
    verify = commands.add_parser("verify", parents=parents, help="compare with known answers")
    verify.add_argument("--all", action="store_true", help="the slow cases too")
    verify.add_argument("--json", metavar="FILE", help="write the table as JSON")

    bench = commands.add_parser("bench", parents=parents, help="time contact against one linear solve")
    bench.add_argument("names", nargs="*", metavar="NAME", help="problems (default: all)")
    bench.add_argument("--dofs", type=int, metavar="N", help="size of the problems")
    bench.add_argument("--sample", type=int, metavar="N", help="of the hard set so many problems, spread over it")
    bench.add_argument("--json", metavar="FILE", help="write the table as JSON")
    _add_threads(bench)
