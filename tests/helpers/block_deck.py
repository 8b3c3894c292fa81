# SPDX-License-Identifier: BSD-3-Clause
"""A small TOML deck, solved in milliseconds: a block of two cells that rests on a plane."""

import json

PRESS = {"force": [0.0, -3.0]}


def block_deck(*loads, steps=(), friction=0.0, title="A block on a plane", name=None):
    """The text of the deck.

    Parameters
    ----------
    loads : keys of each load on the top, `PRESS` alone where none is given
    steps : keys of each step
    friction : of the contact
    title : of the deck
    name : of contact, support, loads and steps that have none; None leaves them without
    """
    every = {} if name is None else {"name": name}
    loads = [{"on": "top", **every, **load} for load in loads or (PRESS,)]
    steps = [{**every, **step} for step in steps]
    plane = {"point": [0.0, 0.0], "normal": [0.0, 1.0]}
    parts = [
        f"title = {json.dumps(title)}\n",
        '[mesh]\ngenerator = "rectangle"\nnx = 2\n[material.soft]\nE = 100.0\nnu = 0.0\n',
        _tables("body", {"name": "block", "material": "soft"}),
        _tables("contact", {**every, "nonmortar": "bottom", "plane": plane, "friction": friction}),
        _tables("support", {**every, "on": "left", "u": [0.0, "free"]}),
        _tables("load", *loads),
        _tables("step", *steps),
    ]
    return "".join(parts)


def _tables(kind, *tables):
    return "".join(
        f"[[{kind}]]\n" + "".join(f"{key} = {_text(value)}\n" for key, value in table.items()) for table in tables
    )


def _text(value):
    """A value of TOML: strings, numbers and lists are those of JSON."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_text(entry)}" for key, entry in value.items()) + "}"
    return json.dumps(value)
