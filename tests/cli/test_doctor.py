# SPDX-License-Identifier: BSD-3-Clause
"""``signorini doctor``: every extra is told of, and what is missing or too old is named with what mends it."""

import tomllib
from importlib import metadata
from pathlib import Path

import pytest

from signorini.cli import main
from signorini.cli.doctor import EXTRAS

PROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]


@pytest.fixture
def asked(monkeypatch):
    """The metadata that an installation of this source has."""
    extras = PROJECT["optional-dependencies"].items()
    words = [*PROJECT["dependencies"], *(f"{name}; extra == '{extra}'" for extra, names in extras for name in names)]
    monkeypatch.setattr(metadata, "requires", lambda name: words if name == "signorini" else None)


def test_every_extra_is_known():
    assert set(EXTRAS) == set(PROJECT["optional-dependencies"]) - {"dev"}


@pytest.mark.usefixtures("asked")
def test_a_machine_in_order(capsys):
    assert main(["doctor"]) == 0
    said = capsys.readouterr().out
    assert all(name.partition(">")[0] in said for name in PROJECT["dependencies"])
    assert all(f"\n  {extra} " in said for extra in EXTRAS)
    assert f"  numpy       {metadata.version('numpy')}" in said
    assert "GB of memory are free" in said


@pytest.mark.usefixtures("asked")
def test_what_is_missing_or_too_old(monkeypatch, capsys):
    version = metadata.version

    def other(name):
        if name == "vtk":
            raise metadata.PackageNotFoundError(name)
        return "0.9.1" if name == "h5py" else "1.0" if name == "pyvista" else version(name)

    monkeypatch.setattr(metadata, "version", other)
    assert main(["doctor"]) == 1
    said = capsys.readouterr().out
    assert "h5py        0.9.1, expected at least 3.10" in said
    assert "nothing works before: pip install 'h5py>=3.10'" in said
    assert "pyvista 1.0; vtk not installed" in said
    assert "signorini[" in said.partition("for more: ")[2].splitlines()[0]


def test_a_package_that_is_not_installed(monkeypatch, capsys):
    def nothing(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "requires", nothing)
    assert main(["doctor"]) == 2
    assert "expected pip install" in capsys.readouterr().err
