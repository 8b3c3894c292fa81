#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Set up and run: needs nothing but Python 3.11 or later. Everything goes into the folder .venv beside this file.

python3 dev.py example     install the package and run the paper's example
python3 dev.py quick       what takes two minutes: lint, types, fast tests, an example
python3 dev.py test        run every check: lint, types, all tests, all examples, the verification suite
python3 dev.py figures     draw the pictures of README and docs again
python3 dev.py site        build the documentation into out/site
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import venv
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from subprocess import PIPE, STDOUT

ROOT = Path(__file__).resolve().parent
BIN = ROOT / ".venv" / ("Scripts" if os.name == "nt" else "bin")
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
"""Of all programs here: hundreds of processes begin, and each would take a second to compile modules to bytecode."""


def install(extras: str = "") -> None:
    """Make .venv if there is none and install this folder into it."""
    if sys.version_info < (3, 11):
        sys.exit(f"signorini needs Python 3.11 or later; this is {sys.version.split()[0]}")
    if not (BIN / ("python.exe" if os.name == "nt" else "python")).exists():
        say("making .venv")
        venv.create(ROOT / ".venv", with_pip=True)
    say("installing signorini and what it needs into .venv")
    run("python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--editable", f"{ROOT}{extras}")


def run(program: str, *arguments: str, **environment: str) -> None:
    """Run a program of .venv and end with its exit code if it fails."""
    code = subprocess.call([str(BIN / program), *arguments], cwd=ROOT, env={**ENVIRONMENT, **environment})
    if code:
        sys.exit(code)


def side_by_side(*programs: tuple[str, ...]) -> None:
    """Run programs of .venv two at a time, each on one thread, and show in their order what they print.

    None begins after one has failed; then this program ends with that one's exit code.
    """
    environment = {**ENVIRONMENT, "OMP_NUM_THREADS": "1"}

    def output(program: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        command = [str(BIN / program), *arguments]
        return subprocess.run(command, cwd=ROOT, env=environment, stdout=PIPE, stderr=STDOUT, text=True, check=False)

    with ThreadPoolExecutor(2) as pool:
        runs = [pool.submit(output, *program) for program in programs]
        for program, done in zip(programs, runs, strict=True):
            result = done.result()
            say(" ".join(program))
            print(result.stdout, end="", flush=True)
            if result.returncode:
                pool.shutdown(cancel_futures=True)
                sys.exit(result.returncode)


def say(words: str) -> None:
    """Tell what goes on."""
    print(f"-- {words}", flush=True)


def example() -> None:
    """The paper's cylinder: table, files and picture in out/."""
    install()
    run("signorini", "run", "examples/zhu_cylinder.toml", "-o", "out")
    run("signorini", "plot", "out", "--what", "contact", "-o", "out/contact.png")
    say("the same cylinder without friction, beside Hertz and the paper's table 1")
    run("python", "examples/zhu_table1.py")
    say("the contact tractions are drawn in out/contact.png")


def quick() -> None:
    """What most mistakes do not survive, in two minutes on two cores once everything is compiled."""
    lint()
    say("fast tests and doctests, types beside them")
    with tempfile.TemporaryDirectory() as folder:
        found = Path(folder) / "types.txt"
        with found.open("w") as told, subprocess.Popen([str(BIN / "mypy")], cwd=ROOT, stdout=told) as types:
            pytest("not slow and not suite")
            say("examples/zhu_cylinder.toml")
            run("signorini", "run", "examples/zhu_cylinder.toml", "-o", str(Path(folder) / "cylinder"), "--quiet")
        print(found.read_text(), end="")
        if types.returncode:
            sys.exit(types.returncode)
    say("quick checks passed; python3 dev.py test runs the others")


def test() -> None:
    """Everything that must hold before a change lands."""
    lint()
    say("types and examples")
    with tempfile.TemporaryDirectory() as folder:
        decks = sorted((ROOT / "examples").glob("*.toml"))
        picture = str(Path(folder) / "cylinder.png")
        side_by_side(
            ("mypy",),
            *(("signorini", "run", str(deck), "-o", str(Path(folder) / deck.stem), "--quiet") for deck in decks),
            ("python", "examples/zhu_table1.py"),
            ("python", "examples/zhu_figures.py", folder),
            ("python", "examples/zhu_convergence.py"),
            ("python", "examples/fretting.py", folder),
            ("python", "examples/readme_picture.py", picture),
        )
    say("tests and doctests")
    pytest("not suite")
    say("verification suite")
    run("signorini", "verify", "--all")
    say("all checks passed")


def lint() -> None:
    """Install the development tools; lint and format."""
    install("[dev]")
    say("lint and format")
    run("ruff", "check")
    run("ruff", "format", "--check")


def pytest(marks: str) -> None:
    """Run the tests of these marks, two at a time."""
    slowest = "--durations=25"
    run("python", "-m", "pytest", "-n", "2", "--dist", "worksteal", slowest, "-m", marks, OMP_NUM_THREADS="1")


def figures() -> None:
    """The pictures of README and docs."""
    install()
    run("python", "examples/zhu_figures.py")
    run("python", "examples/fretting.py")
    run("python", "examples/readme_picture.py")


def site() -> None:
    """The documentation as pages, every warning an error."""
    install("[dev]")
    run("python", "-m", "website", "out/site")


if __name__ == "__main__":
    commands = {"example": example, "quick": quick, "test": test, "figures": figures, "site": site}
    if len(sys.argv) != 2 or sys.argv[1] not in commands:
        sys.exit(__doc__)
    commands[sys.argv[1]]()
