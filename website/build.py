# SPDX-License-Identifier: BSD-3-Clause
"""Pages of README, docs/ and docstrings, collected into one folder and made a site by Zensical in strict mode."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from signorini.deck.schema import deck_schema
from website import gallery, reference

ROOT = Path(__file__).parents[1]
SETTINGS = ROOT / "website" / "zensical.toml"

NAVIGATION: dict[str, list[str]] = {
    "Start": ["index.md", "start.md", "other_programs.md"],
    "How to": [
        *(
            "howto/gmsh.md",
            "howto/keyword_decks.md",
            "howto/arrays.md",
            "howto/report.md",
            "howto/paraview.md",
            "howto/computing.md",
            "howto/archive.md",
            "howto/sweeps.md",
        ),
        *("howto/restart.md", "howto/own_solver.md", "howto/batch.md", "howto/agents.md"),
    ],
    "Decks": ["deck.md", "inp.md", "security.md"],
    "Features": [
        *("contact_surfaces.md", "elements_and_loads.md", "three_dimensions.md", "exact_paths.md", "sliding.md"),
        *(
            "joints.md",
            "plasticity.md",
            "wear.md",
            "fatigue.md",
            "modes.md",
            "derivatives.md",
            "choosing_an_lcp_method.md",
        ),
    ],
    "Gallery": ["gallery.md"],
    "Theory": ["theory.md", "method.md", "robust_friction.md", "budgets.md"],
    "Evidence": ["verification.md", "performance.md", "distributed.md", "lcp_benchmark.md"],
    "Reference": [],
    "Project": ["glossary.md", "design.md", "site.md", "contributing.md", "changelog.md"],
}
"""Title of a part to its pages; what no part names goes to the features, what docstrings make to the reference."""


def collect(folder: Path) -> dict[str, list[str]]:
    """Write the pages of the site and what they show; returns its navigation."""
    shutil.copytree(ROOT / "docs", folder)
    shutil.copytree(ROOT / "examples", folder / "examples", ignore=shutil.ignore_patterns("__pycache__", "out"))
    for page, source in (("index", "README"), ("contributing", "CONTRIBUTING"), ("changelog", "CHANGELOG")):
        (folder / f"{page}.md").write_text((ROOT / f"{source}.md").read_text().replace("](docs/", "]("))
    (folder / "glossary.md").write_text(glossary((ROOT / "docs" / "design.md").read_text()))
    for page in folder.rglob("*.md"):
        page.write_text(inside(page.read_text()))
    (folder / "examples" / "deck.schema.json").write_text(json.dumps(deck_schema(), indent=1))
    gallery.write_notebooks(folder / "notebooks")
    (folder / "reference").mkdir()
    for name, text in reference.pages().items():
        (folder / "reference" / name).write_text(text)
    known = {page for pages in NAVIGATION.values() for page in pages}
    found = {page.relative_to(folder).as_posix() for page in folder.rglob("*.md")}
    parts = {title: list(pages) for title, pages in NAVIGATION.items()}
    parts["Reference"] = [f"reference/{name}" for name in reference.titles().values()]
    parts["Features"] += sorted(found - known - set(parts["Reference"]))
    return parts


def inside(text: str) -> str:
    """Markdown of a page whose links into the repository lead into the site."""
    return re.sub(r"\]\((?:\.\./)+(examples/|README\.md|CHANGELOG\.md)", _moved, text)


def _moved(found: re.Match[str]) -> str:
    return "](" + {"README.md": "index.md", "CHANGELOG.md": "changelog.md"}.get(found[1], found[1])


def glossary(design: str) -> str:
    """The page of words, from the table of the design, in the order of the alphabet."""
    table = design.split("\n## Words\n")[1].split("\n## ")[0]
    rows = [line.strip("| ").split(" | ", 1) for line in table.splitlines() if line.startswith("| ")][1:]
    rows.sort(key=lambda row: row[0].lower())
    return "# Glossary\n\nOne word for a thing, one thing for a word.\n\n" + "\n\n".join(
        f"{word}\n:   {meaning.rstrip(' |')}" for word, meaning in rows
    )


def title_of(page: Path) -> str:
    """First heading of a page."""
    return next(line for line in page.read_text().splitlines() if line.startswith("# ")).removeprefix("# ")


def build(target: Path) -> None:
    """Make the site in a folder, which is replaced.

    Raises
    ------
    SystemExit
        If Zensical warns of anything, a link that leads nowhere, say, with what it said.
    """
    with tempfile.TemporaryDirectory() as name:
        project = Path(name)
        parts = collect(project / "pages")
        (project / "zensical.toml").write_text(settings(project / "pages", parts))
        command = [sys.executable, "-m", "zensical", "build", "--strict", "--clean"]
        ended = subprocess.run(command, cwd=project, capture_output=True, text=True)
        if ended.returncode:
            raise SystemExit(re.sub(r"\x1b\[[\d;]*m", "", ended.stdout + ended.stderr))
        for page in (project / "pages").rglob("*.md"):
            shutil.copyfile(page, project / "site" / page.relative_to(project / "pages"))
        (project / "site" / "llms.txt").write_text(overview(project / "pages", parts))
        if target.exists():
            shutil.rmtree(target)
        shutil.copytree(project / "site", target)


def settings(pages: Path, parts: dict[str, list[str]]) -> str:
    """Zensical's settings with the folder of the pages and the navigation."""
    entries = [
        f"  {{ {quoted(title)} = ["
        + ", ".join(f"{{ {quoted(_short(pages / page))} = '{page}' }}" for page in names)
        + "] },"
        for title, names in parts.items()
    ]
    own = "\n".join(["docs_dir = 'pages'", "site_dir = 'site'", "nav = [", *entries, "]"])
    return SETTINGS.read_text().replace("[project]\n", f"[project]\n{own}\n", 1)


def _short(page: Path) -> str:
    return "Overview" if page.name == "index.md" else title_of(page)


def quoted(words: str) -> str:
    """Words as a string of TOML."""
    return '"' + words.replace("\\", "\\\\").replace('"', '\\"') + '"'


def overview(pages: Path, parts: dict[str, list[str]]) -> str:
    """The file llms.txt: what the package is, and every page's Markdown with its first sentence."""
    readme = (pages / "index.md").read_text()
    lines = ["# signorini", "", "> " + " ".join(readme.split("\n\n")[1].split()), ""]
    for title, names in parts.items():
        lines += [f"## {title}", ""]
        lines += [f"- [{title_of(pages / name)}]({name}){_said(pages / name)}" for name in names]
        lines.append("")
    return "\n".join(lines)


def _said(page: Path) -> str:
    """First sentence of a page's prose, behind a colon."""
    blocks = [block for block in page.read_text().split("\n\n")[1:] if re.match(r"[A-Za-z`*]", block)]
    words = re.sub(r"\[([^]]+)\]\([^)]*\)", r"\1", " ".join(blocks[0].split())) if blocks else ""
    sentence = re.match(r".+?[.:](?= |$)", words)
    return f": {sentence[0].rstrip(':')}" if sentence else ""
