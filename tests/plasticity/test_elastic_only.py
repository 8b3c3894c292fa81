# SPDX-License-Identifier: BSD-3-Clause
"""What is for elastic bodies alone says so of bodies that yield, by name."""

import pytest

import signorini as sg
from tests.helpers.columns import column


def test_uniqueness_is_not_examined():
    """A bound on the friction of the elastic bodies proves nothing of plastic flow."""
    found = sg.solve(column(friction=0.3), wellposed=True).wellposedness
    assert found.verdict == "not decided"
    assert found.bound is None
    assert found.words == (
        "not examined: what is known of uniqueness is of elastic bodies, and of this model some may yield"
    )


def test_the_paper_is_refused():
    with pytest.raises(sg.InputError, match=r"^body\[0\].material: 'up' yields; the paper's bodies are elastic$"):
        sg.paper.formulate(column("plane strain", friction=0.3), E_n=1e6, E_tau=1e6)


@pytest.mark.parametrize("kind", ["axisymmetric", "3d"])
def test_an_exact_path_goes_to_first_yield_and_says_where(kind):
    """In space only contacts with facets have one."""
    contact = sg.Contact("up.bottom", "low.top", friction=0.3, facets=8 if kind == "3d" else 0, name="interface")
    below = sg.solve(column(kind, contacts=[contact], steps=[sg.Step(scale={"press": 0.4}, path="exact")]))
    assert below.steps[0].path == "exact"
    with pytest.raises(sg.SolveFailed, match=r"at 50\.000000%: a point yields, and plastic flow has no exact path"):
        sg.solve(column(kind, contacts=[contact], steps=[sg.Step(path="exact")]))
