# SPDX-License-Identifier: BSD-3-Clause
"""The site is built without a warning, asks no other host, and holds everything that the package exports."""

import re
from pathlib import Path
from urllib.parse import urlsplit

import pytest

import signorini as sg
from website import build, reference

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    pytest.importorskip("zensical")
    target = tmp_path_factory.mktemp("site") / "site"
    build.build(target)
    return target


@pytest.fixture(scope="module")
def pages():
    return reference.pages()


@pytest.mark.slow
def test_every_page_is_in_the_navigation_and_has_its_markdown(site):
    written = {page.with_suffix("").relative_to(site).as_posix() for page in site.rglob("*.html")} - {"404"}
    assert {
        page.with_suffix("").relative_to(ROOT / "docs").as_posix() for page in (ROOT / "docs").rglob("*.md")
    } <= written
    listed = {name.removesuffix(".md") for name in re.findall(r"\]\((\S+?)\)", (site / "llms.txt").read_text())}
    assert listed == written
    assert all((site / f"{name}.md").is_file() for name in written)
    links = set(re.findall(r'href="(\S+?)\.html"', (site / "index.html").read_text()))
    assert written <= {link.removeprefix("./") for link in links} | {"index"}


@pytest.mark.slow
def test_no_page_asks_another_host(site):
    for page in site.rglob("*.html"):
        loaded = re.findall(r'<(?:script|img|link|iframe)\b[^>]*?\b(?:src|href)="?([^" >]+)', page.read_text())
        assert {urlsplit(place).netloc for place in loaded} == {""}, page


@pytest.mark.slow
def test_a_link_that_leads_nowhere_stops_the_build(tmp_path, monkeypatch):
    pytest.importorskip("zensical")
    source = tmp_path / "source"
    (source / "website").mkdir(parents=True)
    (source / "website" / "zensical.toml").write_text(build.SETTINGS.read_text())
    (source / "docs").mkdir()
    (source / "examples").mkdir()
    (source / "docs" / "design.md").write_text(
        "# Design\n\n## Words\n\n| word | is |\n|---|---|\n| gap | none |\n\n## End\n"
    )
    for name in ("README", "CONTRIBUTING", "CHANGELOG"):
        (source / f"{name}.md").write_text("# Page\n\nSee [there](docs/nowhere.md).\n")
    monkeypatch.setattr(build, "ROOT", source)
    monkeypatch.setattr(build, "NAVIGATION", {"All": ["index.md"], "Features": [], "Reference": []})
    with pytest.raises(SystemExit, match=r"nowhere\.md"):
        build.build(tmp_path / "site")


def test_the_reference_holds_all_that_is_exported(pages):
    text = "\n".join(pages.values())
    modules = {name for name in sg.__all__ if name in ("fatigue", "lcp", "paper")}
    headings = set(re.findall(r"^## ([\w.]+) \{", text, re.MULTILINE))
    assert set(sg.__all__) - modules - {"__version__"} <= headings
    assert {
        f"{module}.{name}"
        for module in ("fatigue", "lcp")
        for name in getattr(sg, module).__all__
        if callable(getattr(getattr(sg, module), name))
    } <= headings


def test_docstrings_are_read_as_they_are_meant(pages):
    solving, models = pages["solving.md"], pages["contacts_and_obstacles.md"]
    assert "- `model`: the problem\n" in solving
    assert "signorini.solve(\n    model: Model,\n    *,\n" in solving
    assert "- `normal_compliance`, `tangential_compliance`: of the interface" in models
    assert "[`Plane`](contacts_and_obstacles.md#plane)" in models
    assert ">>> sg.solve(model).contact" in solving
    assert ":class:" not in "".join(pages.values())
    assert "- `status`: SOLVED" in pages["results.md"]  # of the class that Solution is a kind of


def test_the_glossary_is_the_table_of_the_design():
    words = build.glossary(
        "\n## Words\n\nText.\n\n| word | is |\n|---|---|\n| slip | motion |\n| gap | none |\n\n## Next\n"
    )
    assert words.endswith("gap\n:   none\n\nslip\n:   motion")
