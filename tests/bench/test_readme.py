# SPDX-License-Identifier: BSD-3-Clause
"""The list of benchmarks is whole."""

import re
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"


@pytest.mark.skipif(not FOLDER.is_dir(), reason="the benchmarks are beside the tests in a checkout only")
def test_every_benchmark_is_listed() -> None:
    there = {path.stem for path in FOLDER.iterdir() if path.suffix == ".py" or (path / "__init__.py").exists()}
    listed = set(re.findall(r"`(\w+)`", (FOLDER / "README.md").read_text(encoding="utf-8")))
    assert there - {"__init__"} <= listed
