# SPDX-License-Identifier: BSD-3-Clause
"""The API reference: pages made from the signatures and docstrings of what `signorini` exports.

Docstrings of the house say ``name : what it is`` where other readers of docstrings expect a type, because types stand
in the signature; so they are read here.
"""

from __future__ import annotations

import inspect
import re
import types
from collections.abc import Iterator
from typing import Any

import signorini as sg
from signorini.history_moment import HistoryMoment
from signorini.output.result_table import ResultTable
from signorini.prepared import PreparedModel
from signorini.solution.certificate import Certificate
from signorini.solution.results import ContactResult, StepResult
from signorini.study.row import StudyRow
from signorini.study.sweep import Sweep

PAGES = {
    "Models": ("Model", "Body", "Elastic", "Orthotropic", "Plastic", "Step", "SolverSettings", "Fatigue"),
    "Contacts and obstacles": (
        *("Contact", "Closure", "TabularFriction", "Wear", "Plane", "Circle", "Profile", "Sphere", "Cone", "Cylinder"),
        *("Torus", "Surface", "Rigid"),
    ),
    "Loads, supports and links": (
        *("Load", "Support", "Foundation", "Bolt", "RigidBody", "Equation", "CyclicSymmetry", "Formula", "Along"),
        *("ArcLength", "NodeValues", "Scattered"),
    ),
    "Meshes": (
        *("Mesh", "rectangle", "annulus", "half_disk", "quarter_disk", "box", "extruded", "join", "cut", "read_mesh"),
        *("mesh_profile", "mesh_surface", "read_profile", "read_surface", "read_values"),
    ),
    "Solving": (
        *("check", "solve", "threads", "prepare", "PreparedModel", "sweep", "Sweep", "StudyRow", "read", "load"),
        *("natural_modes", "joint_damping"),
    ),
    "Results": ("Solution", "HistoryMoment", "ResultTable", "StepResult", "ContactResult", "Certificate"),
    "Errors": ("SignoriniError", "InputError", "SolveFailed", "Interrupted"),
    "Linear complementarity": ("lcp",),
    "Fatigue criteria": ("fatigue",),
    "The paper's method": ("paper",),
}
"""Title of a page to what it holds; what `signorini` exports and no page names goes onto a last one."""

RETURNED = (
    PreparedModel,
    Certificate,
    ContactResult,
    HistoryMoment,
    ResultTable,
    StepResult,
    StudyRow,
    Sweep,
    sg.Solution,
)
"""Classes that nobody makes but everybody gets."""

INSIDE = {kind.__name__: kind for kind in RETURNED}

SECTIONS = ("Parameters", "Attributes", "Raises", "Returns", "Yields", "Examples", "Notes", "References", "Warns")


def pages() -> dict[str, str]:
    """Markdown of the reference: file name to text."""
    left = sorted(set(sg.__all__) - {"__version__"} - {name for names in PAGES.values() for name in names})
    groups = {**PAGES, **({"Further": tuple(left)} if left else {})}
    places = {name: f"{_file(title)}#{name.lower()}" for title, names in groups.items() for name in names}
    for title, names in groups.items():
        for module in (name for name in names if inspect.ismodule(getattr(sg, name, None))):
            places |= {
                f"{module}.{name}": f"{_file(title)}#{name.lower()}" for name, _ in _members(getattr(sg, module))
            }
    return {
        _file(title): f"# {title}\n\n" + "\n".join(_entry(name, places) for name in names)
        for title, names in groups.items()
    }


def titles() -> dict[str, str]:
    """Title of every page of the reference to its file."""
    left = set(sg.__all__) - {"__version__"} - {name for names in PAGES.values() for name in names}
    return {title: _file(title) for title in (*PAGES, *(["Further"] if left else []))}


def _file(title: str) -> str:
    return re.sub(r"[^a-z]+", "_", title.lower()) + ".md"


def _entry(name: str, places: dict[str, str]) -> str:
    thing = INSIDE.get(name) or getattr(sg, name)
    if isinstance(thing, types.ModuleType):
        members = [_thing(f"{name}.{member}", value, 2, places) for member, value in _members(thing)]
        return prose(inspect.getdoc(thing) or "", places) + "\n\n" + "\n".join(members)
    return _thing(name, thing, 2, places)


def _members(module: types.ModuleType) -> Iterator[tuple[str, Any]]:
    """What a module exports, its own classes and functions where it has no list."""
    names = getattr(module, "__all__", None) or [
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and getattr(value, "__module__", "") == module.__name__ and callable(value)
    ]
    for name in names:
        value = getattr(module, name)
        if callable(value):
            yield name, value


def _thing(name: str, thing: Any, level: int, places: dict[str, str]) -> str:
    """Heading, signature and docstring of a class or function, and of a class its methods and properties."""
    short = name.rsplit(".", 1)[-1]
    lines = [f"{'#' * level} {name} {{ #{short.lower()} }}", ""]
    shown = f"signorini.{name}" if name.split(".")[0] in sg.__all__ else short
    made = not inspect.isclass(thing) or not (thing in RETURNED or issubclass(thing, Exception))
    if made and (signature := _signature(thing)):
        lines += ["```python", f"{shown}{signature}", "```", ""]
    lines += [prose(inspect.getdoc(thing) or "", places), ""]
    for base in thing.__mro__[1:] if inspect.isclass(thing) else ():
        inherited = inspect.getdoc(base) or ""
        if base.__module__.startswith("signorini.solution") and "Attributes\n---" in inherited:
            lines += [prose(inherited[inherited.index("Attributes\n") :], places), ""]
    if inspect.isclass(thing):
        lines += [_method(short, member, value, level + 1, places) for member, value in _own(thing)]
    return "\n".join(lines)


def _own(kind: type) -> list[tuple[str, Any]]:
    """Public methods and properties of a class and of its bases in this package, with docstrings."""
    found: dict[str, Any] = {}
    for base in kind.__mro__:
        if base.__module__.startswith("signorini"):
            for member, value in vars(base).items():
                written = inspect.isroutine(value) or isinstance(value, property | classmethod | staticmethod)
                written = written or type(value).__name__ == "cached_property"
                if written and not member.startswith("_") and inspect.getdoc(value):
                    found.setdefault(member, value)
    return list(found.items())


def _method(owner: str, name: str, value: Any, level: int, places: dict[str, str]) -> str:
    anchor = f"{owner}.{name}".lower()
    bare = value.__func__ if isinstance(value, classmethod | staticmethod) else value
    call = f"`{name}{_signature(bare, own=True)}`" if inspect.isroutine(bare) else f"`{name}`"
    head = f"{'#' * level} {owner}.{name} {{ #{anchor} }}"
    return f"{head}\n\n{call}\n\n{prose(inspect.getdoc(value) or '', places)}\n"


def _signature(thing: Any, *, own: bool = False) -> str:
    """Parameters with their types, one a line where they are many; ``own``: of a method, without its first one."""
    try:
        signature = inspect.signature(thing)
    except (TypeError, ValueError):
        return ""
    given = [
        parameter.replace(annotation=str(parameter.annotation).strip("'\""))
        if parameter.annotation is not inspect.Parameter.empty
        else parameter
        for parameter in signature.parameters.values()
    ]
    signature = signature.replace(parameters=given[1:] if own else given)
    words = re.sub(r"<factory>", "...", str(signature))
    words = re.sub(r"(?<=: )'([^']*)'", r"\1", re.sub(r"-> '([^']*)'", r"-> \1", words))
    words = words.replace(" -> None", "")
    if own or len(words) < 80:
        return words
    end = words.rindex(")")
    parts = re.split(r", (?=\*?\*?\w+(?:[:=,]|$)|\*,)", words[1:end])
    return "(\n" + "".join(f"    {part},\n" for part in parts) + words[end:]


def prose(docstring: str, places: dict[str, str]) -> str:
    """Markdown of a docstring: sections as lists, examples as code, roles as links."""
    blocks = re.split(rf"^({'|'.join(SECTIONS)})\n-+\n", docstring, flags=re.MULTILINE)
    words = [_plain(blocks[0], places)]
    for title, text in zip(blocks[1::2], blocks[2::2], strict=True):
        if title == "Examples":
            words.append(f"**Example**\n\n```pycon\n{text.rstrip()}\n```")
        elif title in ("Parameters", "Attributes", "Raises"):
            items = [f"- {_item(head, rest, places)}" for head, rest in _items(text)]
            words.append(f"**{title}**\n\n" + "\n".join(items))
        else:
            words.append(f"**{title}**\n\n{_plain(text, places)}")
    return "\n\n".join(part.strip("\n") for part in words if part.strip())


def _items(text: str) -> Iterator[tuple[str, str]]:
    """Entries of a section, each a line and what is indented below it."""
    for entry in re.split(r"\n(?=\S)", text.strip("\n")):
        head, _, rest = entry.partition("\n")
        yield head, " ".join(line.strip() for line in rest.splitlines())


def _item(head: str, rest: str, places: dict[str, str]) -> str:
    names, colon, said = head.partition(" : ")
    marked = ", ".join(f"`{name.strip()}`" for name in names.split(","))
    return f"{marked}: {_plain(' '.join(part for part in (said if colon else '', rest) if part), places)}"


def _plain(text: str, places: dict[str, str]) -> str:
    """Prose with the marks of docstrings as those of Markdown, and names of the reference as links."""

    def link(found: re.Match[str]) -> str:
        name = found[1].removeprefix("signorini.")
        near = next((key for key in (name, name.rsplit(".", 1)[-1]) if key in places), "")
        return f"[`{name.rsplit('.', 1)[-1]}`]({places[near]})" if near else f"`{name.rsplit('.', 1)[-1]}`"

    text = re.sub(r"``(.+?)``", r"`\1`", text, flags=re.DOTALL)
    text = re.sub(r":\w+:`([^`]+)`", link, text)
    # indented continuations of lists in prose would be code
    return re.sub(r"(?<=\n)\n((?: {4}\S.*\n?)+)", lambda found: f"\n```text\n{inspect.cleandoc(found[1])}\n```\n", text)
