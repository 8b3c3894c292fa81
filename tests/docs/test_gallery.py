"""The gallery: every script runs cell by cell, its number is what it is compared with, and the page says so."""

import json

import matplotlib as mpl
import pytest

from website import gallery

PAGE = (gallery.ROOT / "docs" / "gallery.md").read_text()


def test_every_script_is_shown():
    assert {path.stem for path in gallery.SCRIPTS.glob("*.py")} == set(gallery.WORDS)
    for name in gallery.WORDS:
        assert f"](figures/gallery/{name}.png)" in PAGE
        assert (gallery.ROOT / "docs" / "figures" / "gallery" / f"{name}.png").stat().st_size > 10_000


@pytest.mark.slow
@pytest.mark.parametrize("name", gallery.WORDS)
def test_the_number_is_its_reference(name, capsys):
    mpl.use("agg")
    names = gallery.run(name)
    found, known = float(names["found"]), float(names["known"])
    assert found == pytest.approx(known, rel=names["within"])
    (row,) = (
        line
        for line in PAGE.splitlines()
        if line.startswith("| [") and gallery.WORDS[name] in line and name_of(name) in line
    )
    shown = [float(cell) for cell in row.split("|")[3:5]]
    assert shown == pytest.approx([found, known], rel=1e-3)
    assert "certificate passed" in capsys.readouterr().out
    mpl.pyplot.close("all")


def name_of(name):
    """Title of a problem on the page."""
    return next(gallery.cells(name))[1].split("\n")[0].lstrip("# ")


def test_notebooks_hold_the_cells(tmp_path):
    gallery.write_notebooks(tmp_path)
    for name in gallery.WORDS:
        made = json.loads((tmp_path / f"{name}.ipynb").read_text())
        kinds = [(cell["cell_type"], "".join(cell["source"])) for cell in made["cells"]]
        assert kinds == list(gallery.cells(name))
        assert kinds[0][0] == "markdown"
        assert made["nbformat"] == 4
