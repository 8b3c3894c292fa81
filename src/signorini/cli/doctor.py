# SPDX-License-Identifier: BSD-3-Clause
"""``signorini doctor``: what the package finds on this machine, and how what is missing is installed."""

from __future__ import annotations

import argparse
import os
import platform
import re
import shutil
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path
from typing import NamedTuple

import signorini
from signorini._version import __version__
from signorini.cores import number_of_threads, physical_cores
from signorini.engine.first_run import compiled
from signorini.errors import InputError
from signorini.memory import available_memory
from signorini.output.table import align

EXTRAS = {
    "gmsh": "geometries as meshes: *.geo, *.step, *.brep",
    "mkl": "the back end 'pardiso'",
    "pandas": "results as data frames",
    "view": "signorini plot --what view, solution.view",
    "jax": "derivatives as functions of JAX",
    "torch": "derivatives as functions of PyTorch",
    "mcp": "signorini mcp, a server for agents",
    "petsc": "the back ends 'petsc' and 'mumps': bodies on the ranks of mpiexec",
}
"""What every extra is for; the packages that it asks for stand in the metadata of this one."""

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
_REQUIREMENT = re.compile(r"""([\w.-]+) *>= *([\d.]+)(?: *; *extra *== *['"](\w+)['"])?""")


class _Package(NamedTuple):
    """A package that is asked for in a least version, and the version that is installed; empty: none."""

    name: str
    least: str
    version: str

    @property
    def fits(self) -> bool:
        return bool(self.version) and _numbers(self.version) >= _numbers(self.least)

    @property
    def state(self) -> str:
        if not self.version:
            return "not installed"
        return self.version if self.fits else f"{self.version}, expected at least {self.least}"


def doctor(options: argparse.Namespace) -> int:
    """Print the machine, packages and extras; 0 unless a package that nothing works without is missing or too old.

    Raises
    ------
    InputError
        If the package is not installed, but imported from its source.
    """
    del options
    print("\n".join(_machine()))
    found = _packages()
    print("\n".join(["", "packages", *align([(one.name, one.state) for one in found[""]])]))
    extras = {extra: found[extra] for extra in EXTRAS if extra in found}
    rows = [
        (extra, "; ".join(f"{one.name} {one.state}" for one in packages), EXTRAS[extra])
        for extra, packages in extras.items()
    ]
    print("\n".join(["", "extras", *align(rows)]))
    if lacking := [extra for extra, packages in extras.items() if not all(one.fits for one in packages)]:
        print(f"\nfor more: pip install 'signorini[{','.join(lacking)}]'")
    broken = [f"'{one.name}>={one.least}'" for one in found[""] if not one.fits]
    if broken:
        print(f"\nnothing works before: pip install {' '.join(broken)}")
    return 1 if broken else 0


def _machine() -> Iterator[str]:
    """Versions, cores, memory, and whether the first solve still has to compile."""
    threads = "".join(f", {name}={os.environ[name]}" for name in _THREADS if name in os.environ)
    yield f"signorini {__version__} in {Path(signorini.__file__).parent}"
    yield f"Python {platform.python_version()} on {platform.system()} {platform.machine()}"
    yield f"{physical_cores()} of {os.cpu_count()} cores{threads}; large models share {number_of_threads()} threads"
    yield f"{available_memory() / 1e9:.3g} GB of memory are free"
    starter = shutil.which("mpiexec")
    yield (
        f"{starter} starts ranks" if starter else "there is no mpiexec: the back ends 'petsc' and 'mumps' have one rank"
    )
    yield "loops are compiled" if compiled() else "loops are not compiled: the first solve does that, once"


def _packages() -> dict[str, list[_Package]]:
    """Extra to packages that it asks for; "" to those that nothing works without."""
    try:
        asked = metadata.requires("signorini") or []
    except metadata.PackageNotFoundError as error:
        raise InputError("the package is not installed, so what it needs is unknown; expected pip install") from error
    found: dict[str, list[_Package]] = {}
    for match in filter(None, map(_REQUIREMENT.match, asked)):
        try:
            version = metadata.version(match[1])
        except metadata.PackageNotFoundError:
            version = ""
        found.setdefault(match[3] or "", []).append(_Package(match[1], match[2], version))
    return found


def _numbers(version: str) -> list[int]:
    return [int(part) for part in re.findall(r"\d+", version)]
