# SPDX-License-Identifier: BSD-3-Clause
"""The picture of bodies that run away says which, and what its colours are."""

import signorini as sg


def test_the_body_that_runs_is_named_beside_what_the_colours_mean():
    steel = sg.Elastic(E=100.0, nu=0.3)
    bed, pad = sg.rectangle(width=2.0, origin=(0, -1)), sg.rectangle(origin=(0.5, 0))
    model = sg.Model(
        sg.join({"bed": bed, "pad": pad}),
        bodies=[sg.Body("bed", steel), sg.Body("pad", steel)],
        supports=[sg.Support("bed.bottom", u=(0, 0))],
        loads=[sg.Load("pad.top", pressure=-1.0)],
        contacts=[sg.Contact("pad.bottom", "bed.top", friction=0.3)],
    )
    figure = sg.solve(model, raise_on_failure=False).plot_escape()
    assert figure.get_suptitle().splitlines()[-1] == "no equilibrium: the loads carry 'pad' away"
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert words == ["where they are", "where they go", "the motion, whatever its size"]
