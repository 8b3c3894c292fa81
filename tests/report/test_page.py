# SPDX-License-Identifier: BSD-3-Clause
"""The report: one file with the numbers of the results, which asks for nothing, escapes names, works in a browser."""

import json
import re
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.plot.picture_data import PictureData
from signorini.plot.style import STATUS_INK
from signorini.report.charts import ChartData, Line, chart
from signorini.report.contact_map import contact_maps
from signorini.report.page import report
from tests.helpers.lifted_block import DECK

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
NASTY = "</script><img src=x onerror=alert(1)>&\"'$title"


def two_steps(**more):
    """A block that is pressed and rubbed to and fro."""
    block = sg.rectangle(width=4.0, nx=8, ny=2)
    given = {
        "bodies": [sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        "supports": [sg.Support("top", u=(0.02, -0.01), name="hand")],
        "contacts": [sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), friction=0.3, name="sole")],
        "steps": [sg.Step(name="rub", scale={"hand": [1, -1]}), sg.Step(name="back", scale={"hand": 1})],
        "units": "mm, N, MPa",
    }
    return sg.Model(block, **{**given, **more})


@pytest.fixture(scope="module")
def plane():
    return sg.solve(two_steps(title=NASTY))


@pytest.fixture(scope="module")
def solid():
    model = sg.Model(
        sg.box(x=[0, 1, 2], y=[0, 1], z=[0, 1]),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.01, 0, -0.02))],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0, 0), normal=(0, 0, 1)), friction=0.3)],
        title="cube",
    )
    return sg.solve(model)


def charts_of(page):
    found = re.findall(r'<figure class="chart">.*?<script type="application/json">(.*?)</script>', page, re.DOTALL)
    return [json.loads(text) for text in found]


def test_numbers_are_those_of_the_results(plane):
    page = report(plane)
    contact = plane.last.contacts[0]
    profile, forces, work, loop = charts_of(page)[:4]
    assert [group["name"] for group in profile["groups"]] == ["end of step 1, rub", "end of step 2, back"]
    pressure, friction = profile["groups"][-1]["lines"]
    order = np.argsort(contact.points[:, 0])
    np.testing.assert_allclose(pressure["y"], contact.pressure[order], rtol=1e-5)
    np.testing.assert_allclose(friction["y"], contact.traction[order], rtol=1e-5)
    np.testing.assert_allclose(forces["groups"][0]["lines"][0]["y"][-1], contact.normal_force[1], rtol=1e-5)
    dissipated = sum(step.dissipation for step in plane.steps)
    np.testing.assert_allclose(work["groups"][0]["lines"][0]["y"][-1], dissipated, rtol=1e-5)
    assert loop["x"] == "mean slip, mm"
    for words in ("solved and certified", f"{contact.pressure.max():.5g}", "pressure and friction, MPa", "work, N mm"):
        assert words in page
    assert f"{max(step.certificate.equilibrium for step in plane.steps):.1e}" in page  # the worst of all steps
    assert f"{len(plane.steps[0].events) + len(plane.steps[1].events)} events" in page


def test_names_are_escaped_and_nothing_is_asked_for(plane):
    page = report(plane)
    assert "<img src=x" not in page
    assert "$title" in page  # a name is no place of the template
    assert not re.search(r'(?:src|href)="(?!data:|#)', page)
    assert "default-src 'none'" in page
    assert page.count("<script") == page.count("</script>")


def test_a_step_chosen_is_one_group_of_lines():
    x = np.arange(5.0)
    groups = {name: [Line(name="p", x=x, y=k * x, colour=0)] for k, name in enumerate(("first", "second<"))}
    text = chart(ChartData(title="a", x="x", y="y", groups=groups))
    assert text.count('class="group" hidden') == 1
    assert 'type="range" min="0" max="1" value="1"' in text
    assert "second&lt;" in text
    assert "second\\u003c" in text
    still = chart(ChartData(title="a", x="x", y="y", groups={"": [Line(name="p", x=x, y=0 * x, colour=0)]}))
    assert "range" not in still  # and a curve that is zero everywhere has an axis


def test_a_line_with_gaps_is_drawn_in_pieces():
    y = np.array([1.0, np.nan, 3.0, 4.0])
    text = chart(ChartData(title="a", x="x", y="y", groups={"": [Line(name="p", x=np.arange(4.0), y=y, colour=0)]}))
    way = re.search(r'class="line c0" d="([^"]*)"', text)[1]
    assert (way.count("M"), way.count("L")) == (2, 1)
    assert '"y":[1.0,null,3.0,4.0]' in text


def test_a_failed_run_says_why_and_what_was_solved(tmp_path):
    torn = sg.Model(
        sg.rectangle(),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
        supports=[sg.Support("left", u=(0, None))],
        loads=[sg.Load("top", pressure=-3.0)],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)))],
    )
    failed = sg.solve(torn, raise_on_failure=False)
    failed.report(tmp_path / "r.html")
    page = (tmp_path / "r.html").read_text()
    assert 'class="verdict failed"' in page
    assert "no_equilibrium" in page
    with pytest.raises(sg.InputError, match=r"'r\.txt'; expected a name that ends in \.html"):
        failed.report("r.txt")


def test_the_command_writes_the_page_of_a_folder(tmp_path, capsys):
    deck = tmp_path / "press.toml"
    deck.write_text(DECK.replace("[0.0, 1.0]}]\ncontact", "[0.0, -7.8]}]\ncontact"))
    assert main(["run", str(deck), "-o", str(tmp_path / "out"), "--quiet"]) == 0
    assert main(["report", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().out.strip() == str(tmp_path / "out" / "report.html")
    assert "(0, 7.8)" in (tmp_path / "out" / "report.html").read_text()
    assert main(["report", str(tmp_path / "out"), "-o", str(tmp_path / "a" / "b.html")]) == 2
    assert main(["run", str(deck), "-o", str(tmp_path / "out"), "--quiet"]) == 0
    assert not (tmp_path / "out" / "report.html").exists()  # of the earlier run


PROBE = """<script>
window.addEventListener("load", () => setTimeout(() => {
  const found = { wide: document.documentElement.scrollWidth <= innerWidth };
  const figure = document.querySelector(".chart");
  if (figure) {
    const slider = figure.querySelector("input[type=range]");
    figure.querySelector("svg").dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", cancelable: true }));
    found.told = figure.querySelector("output").textContent;
    if (slider) {
      slider.value = 0; slider.dispatchEvent(new Event("input"));
      found.hidden = [...figure.querySelectorAll(".group")].map((group) => getComputedStyle(group).display === "none");
    }
  }
  const map = document.querySelector(".map");
  if (map) {
    const fills = () => [...map.querySelectorAll(".faces path")].map((path) => path.getAttribute("fill"));
    const what = map.querySelector("select"), pressed = fills();
    map.querySelector("svg").dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", cancelable: true }));
    found.node = map.querySelector("output").textContent;
    what.value = 3; what.dispatchEvent(new Event("change"));
    found.fills = [pressed, fills()]; found.states = map.querySelector(".legend").textContent;
  }
  const table = [...document.querySelectorAll("main table")].find((one) => one.textContent.includes("penetration"));
  const head = table.querySelectorAll("th button")[0];
  head.click(); head.click();
  found.sorted = [...table.tBodies[0].rows].map((row) => row.cells[0].textContent);
  const canvas = document.querySelector("canvas");
  if (canvas) {
    const seen = () => { const gl = canvas.getContext("webgl2"), got = new Uint8Array(4 * canvas.width * canvas.height);
      gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, got); return got; };
    const before = seen();
    found.painted = before.filter((value, k) => k % 4 === 3 && value > 0).length / (canvas.width * canvas.height);
    canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", cancelable: true }));
    found.turned = seen().some((value, k) => value !== before[k]);
  }
  const told = document.createElement("pre");
  told.id = "probe"; told.textContent = JSON.stringify(found); document.body.append(told);
}, 100));
</script></body>"""


def in_browser(page, folder, width):
    """What a browser finds on a page, and what it says on its console."""
    file = folder / f"probe_{width}.html"
    file.write_text(page.replace("</body>", PROBE))
    flags = ["--headless", "--no-sandbox", "--disable-dev-shm-usage", "--enable-logging=stderr", "--hide-scrollbars"]
    flags += ["--enable-unsafe-swiftshader", "--use-angle=swiftshader", f"--window-size={width},900"]
    flags += ["--virtual-time-budget=3000", f"--user-data-dir={folder}", "--dump-dom", file.as_uri()]
    ended = subprocess.run([CHROMIUM, *flags], capture_output=True, text=True, timeout=120)
    console = [line for line in ended.stderr.splitlines() if "CONSOLE" in line]
    return json.loads(re.search(r'<pre id="probe">(.*?)</pre>', ended.stdout)[1].replace("&amp;", "&")), console


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium: apt-get install chromium")
def test_it_works_in_a_browser_without_a_word_on_its_console(plane, tmp_path):
    found, console = in_browser(report(plane), tmp_path, 500)  # headless Chromium has no narrower window
    assert console == []
    assert found["wide"]  # no page to push about sideways
    assert re.match(r"x along 'sole'.*: 0;  pressure [\d.]+;  friction", found["told"])
    assert found["hidden"] == [False, True]


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium: apt-get install chromium")
def test_bodies_in_space_turn_in_a_browser(solid, tmp_path):
    found, console = in_browser(report(solid), tmp_path, 1200)
    assert console == []
    assert found["wide"]
    assert 0.1 < found["painted"] < 0.9
    pressed, states = found["fills"]
    assert len(pressed) == len(states) == 2
    assert set(pressed) & set(states) == set()
    assert set(states) <= set(STATUS_INK.values())
    assert re.match(r"\([-\d., ]+\):  pressure [\d.]+;  friction [\d.]+;  slip [\d.e-]+;  (slip|stick)$", found["node"])
    assert found["states"] in ("stick", "slip", "stickslip")
    assert found["sorted"] == ["tension", "penetration", "equilibrium", "cone", "complementarity"]
    assert found["turned"]


def test_the_map_of_a_contact_holds_its_numbers_at_every_step():
    """Unrolled and flat contacts alike: places of the chart, values of the nodes."""
    grid = np.array([0.0, 1.0, 2.0])
    model = sg.Model(
        sg.box(x=grid, y=grid, z=[0, 1]),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.01, 0, -0.02), name="hand")],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0, 0), normal=(0, 0, 1)), friction=0.3, name="</script>")],
        steps=[sg.Step(name="half", scale={"hand": 0.5}), sg.Step(name="whole", scale={"hand": 1})],
        units="mm, N, MPa",
    )
    solution = sg.solve(model)
    (text,) = contact_maps(PictureData(solution))
    assert text.count("</script>") == 1
    assert text.count("<path fill=") == 4
    found = json.loads(re.search(r'<script type="application/json">(.*?)</script>', text)[1])
    assert found["names"] == ["pressure, MPa", "friction, MPa", "slip, mm"]
    assert [step["name"] for step in found["steps"]] == ["end of step 1, half", "end of step 2, whole"]
    contact = solution.last.contacts[0]
    at = [found["at"].index(f"({', '.join(f'{x:.6g}' for x in point)})") for point in contact.points.tolist()]
    given = (contact.pressure, np.linalg.norm(contact.traction, axis=1), contact.slipped)
    for values, own in zip(found["steps"][1]["values"], given, strict=True):
        np.testing.assert_allclose(np.array(values)[at], own, rtol=1e-4)
    np.testing.assert_allclose(found["tops"][0], contact.pressure.max())
    x, y = np.array(found["x"])[at], np.array(found["y"])[at]
    scale = np.ptp(x) / np.ptp(contact.points[:, 0])
    np.testing.assert_allclose(x - x[0], scale * (contact.points[:, 0] - contact.points[0, 0]), atol=0.2)
    np.testing.assert_allclose(y - y[0], -scale * (contact.points[:, 1] - contact.points[0, 1]), atol=0.2)


def test_a_large_skin_is_left_out_of_the_page(solid, monkeypatch):
    from signorini.report import scene

    monkeypatch.setattr(scene, "_MOST_PIECES", 4)
    page = report(solid)
    assert "too many for a page" in page
    assert "<canvas" not in page


def test_a_history_that_goes_on_has_a_report():
    first = sg.solve(two_steps(steps=[sg.Step(name="rub", scale={"hand": 1})]))
    model = replace(first.model, steps=[sg.Step(name="back", scale={"hand": 0.5})])
    assert ">1 back<" in report(sg.solve(model, start=first))
