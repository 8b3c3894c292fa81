# SPDX-License-Identifier: BSD-3-Clause
"""What is shipped: sdist and wheel are whole and work on their own, recipes ask for the same packages."""

import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import venv
import zipfile
from pathlib import Path

import pytest

from signorini import __version__
from signorini.cli import main

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
BARE = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}


def run(*command, cwd):
    ended = subprocess.run([str(part) for part in command], cwd=cwd, env=BARE, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return ended.stdout


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The sdist, and the wheel that is built from it."""
    pytest.importorskip("hatchling")
    folder = tmp_path_factory.mktemp("dist")
    run(sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", folder, cwd=ROOT)
    (sdist,) = folder.glob("*.tar.gz")
    shutil.unpack_archive(sdist, folder)
    run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder, cwd=folder / sdist.name[:-7])
    (wheel,) = folder.glob("*.whl")
    return sdist, wheel


@pytest.mark.slow
def test_archives_hold_everything(built):
    sdist, wheel = built
    with tarfile.open(sdist) as archive:
        packed = {name.partition("/")[2] for name in archive.getnames()}
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True).stdout.split()
    here = [name for name in tracked if (ROOT / name).is_file()]  # of a change that is under way too
    left_out = {name for name in here if name not in packed}
    assert {name.split("/")[0] for name in left_out} <= {".ci", ".dockerignore", ".github"}
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        metadata = archive.read(next(name for name in names if name.endswith("METADATA"))).decode()
    modules = {name.removeprefix("src/") for name in here if name.startswith("src/")}
    assert modules <= set(names)
    assert {"signorini/py.typed", "signorini/report/page.css", "signorini/report/page.js"} <= set(names)
    assert sum(name.endswith("LICENSE") for name in names) == 2
    assert f"Version: {__version__}" in metadata
    assert not any(name.startswith(("tests/", "benchmarks/", "website/")) for name in names)


@pytest.mark.slow
def test_the_wheel_works_in_an_empty_environment(built, tmp_path):
    """Of ours there is the wheel alone; the packages that it asks for are those that are installed here."""
    _, wheel = built
    venv.create(tmp_path / "venv", with_pip=False)
    python = tmp_path / "venv" / ("Scripts" if os.name == "nt" else "bin") / "python"
    install = ["install", "--quiet", "--no-deps", "--no-index", "--no-compile", "--disable-pip-version-check", wheel]
    run(sys.executable, "-m", "pip", "--python", python, *install, cwd=tmp_path)
    (own,) = {
        Path(line) for line in run(python, "-c", "import signorini; print(signorini.__file__)", cwd=tmp_path).split()
    }
    assert own.is_relative_to(tmp_path)
    others = Path(pytest.__file__).parents[1]  # a line of a .pth file: .pth files in there are not read
    (own.parents[1] / "others.pth").write_text(f"{others}\n")
    program = python.with_name("signorini")
    assert run(program, "--version", cwd=tmp_path).strip() == f"signorini {__version__}"
    deck = ROOT / "examples" / "zhu_cylinder_frictionless.toml"
    # solved here, where loops are compiled: there that would take a minute
    assert main(["run", str(deck), "-o", str(tmp_path / "out"), "--quiet"]) == 0
    run(program, "report", "out", cwd=tmp_path)
    assert "<svg" in (tmp_path / "out" / "report.html").read_text()


def pairs(lines):
    """Package to its least version, without what conda-forge calls otherwise."""
    found = (re.match(r"([\w-]+?)(?:-base)? ?>=([\d.]+)", line.strip(" -")) for line in lines)
    return {match[1].lower(): match[2] for match in found if match}


def test_the_recipe_asks_for_the_same_packages():
    recipe = (ROOT / "packaging" / "conda" / "recipe.yaml").read_text()
    asked = pairs(recipe.split("  run:\n")[1].split("\n\n")[0].splitlines())
    assert asked.pop("python") == PROJECT["requires-python"].removeprefix(">=")
    assert asked == pairs(PROJECT["dependencies"])
    assert f'version: "{__version__}"' in recipe
    assert f"license: {PROJECT['license']}" in recipe
    assert all(name in recipe for name in PROJECT["license-files"])


def test_versions_agree():
    citation = (ROOT / "CITATION.cff").read_text()
    assert f'version: "{__version__}"' in citation
    assert f"\n## {__version__}\n" in (ROOT / "CHANGELOG.md").read_text()
    dockerfile = (ROOT / "packaging" / "Dockerfile").read_text()
    tested = re.findall(r"Python :: (3\.\d+)", " ".join(PROJECT["classifiers"]))
    assert re.search(r"FROM python:(3\.\d+)", dockerfile)[1] in tested


def test_rattler_build_understands_the_recipe():
    """Its own parser renders it, without any channel; what is built would need one."""
    rattler_build = pytest.importorskip("rattler_build")
    recipe = rattler_build.Stage0Recipe.from_file(str(ROOT / "packaging" / "conda" / "recipe.yaml"))
    (variant,) = recipe.render(rattler_build.VariantConfig(), rattler_build.RenderConfig())
    found = variant.recipe.to_dict()
    assert found["package"] == {"name": "signorini", "version": __version__}
    assert found["build"]["noarch"] == "python"
    assert len(found["requirements"]["run"]) == 1 + len(PROJECT["dependencies"])
    assert all((ROOT / name).is_file() for name in found["about"]["license_file"])
