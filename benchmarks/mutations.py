# SPDX-License-Identifier: BSD-3-Clause
"""Sound inputs of every kind that the package reads, and ways to damage them that know what they are made of."""

from __future__ import annotations

import io
import json
import random
import re
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import meshio
import numpy as np

import signorini as sg
from signorini.meshing.solid import box
from signorini.meshing.write import write_mesh

ROOT = Path(__file__).parents[1]

DECKS = ("toml", "inp")
MESHES = ("mesh",)
RESULTS = ("state", "archive", "folder")
KINDS = (*DECKS, *MESHES, *RESULTS)
_SHARES = (40, 40, 13, 2, 2, 3)  # of the inputs, per cent

_NUMBERS = (
    *("0", "-1", "1", "2", "3", "1.5", "-0.0", "1e-320", "1e300", "-1e300", "nan", "inf", "-inf", "1e400"),
    *("1000000000", "99999999999999999999", "4294967296", "-2147483649", "0.1", "1e-9", "4097"),
)
_OF_KEYWORDS = (
    *("", "1D3", "abc", "Top", "Base", "*", "**", ",", ",,,", '"', "=", "S1", "P9", "GENERATE", "\u00fc", "\x00"),
    *(" ", "\t", "1 2", "../deck.inp", "/dev/zero", "U", "NEW"),
)
_LINES = (
    *("*NODE", "*ELEMENT, TYPE=CPE4", "*ELEMENT, TYPE=CAX8", "*NSET, NSET=Top", "*END STEP", "*STEP", "*STATIC"),
    *(
        "*BOUNDARY, OP=NEW",
        "CENTRIF",
        "GRAV",
        "*INCLUDE, INPUT=deck.inp",
        "*NSET, NSET=a, GENERATE",
        "1, 1000000000, 1",
        "*PART",
    ),
    *("*EQUATION", "2", "4, 1, 1., 5, 2, -1.", "*RIGID BODY, NSET=Top, REF NODE=99", "*INSTANCE, NAME=x"),
    *("*AMPLITUDE, NAME=A", "*TIE", "*FRICTION", "*CONTACT PAIR", "*SURFACE, NAME=s, TYPE=NODE", "*END PART", "*DLOAD"),
    *("*RIGID BODY, ELSET=E, REF NODE=1", "*DLOAD, OP=NEW", "*STATIC, TIME RESET", "*ELEMENT, TYPE=T3D2, ELSET=s"),
    *("*ORIENTATION, NAME=o", "*COUPLING", "*KINEMATIC", "*MPC", "*CLOAD", "*TIME"),
)
_VALUES = (
    *('""', '"a"', '"free"', '"stick"', '"tied"', '"bottom"', '"\\u0000"', "true", "false", "[]", "{}", "[[]]"),
    *("[0.0]", "[0.0, 0.0]", "[0.0, 0.0, 0.0]", '["a", "b"]', "[[0, 0], [1, 1]]", "{ a = 1 }", "1979-05-27"),
    *("[1e308, -1e308]", '[[["x", "x", 0]]]', "12:00:00", "[nan, 0.0]", '"exact"', '"events"', '"auto"', "'''a\nb'''"),
)


@dataclass(frozen=True, kw_only=True, repr=False)
class Corpus:
    """Sound inputs.

    Attributes
    ----------
    texts : of decks, by kind
    meshes : contents of mesh files by suffix; several of one suffix are numbered before it
    results : a result folder of a small model
    keys, pairs : of TOML decks: all keys, and all lines ``key = value``
    """

    texts: Mapping[str, Sequence[str]]
    meshes: Mapping[str, bytes]
    results: Path
    keys: Sequence[str]
    pairs: Sequence[str]


def corpus(folder: Path) -> Corpus:
    """Decks of examples and tests, meshes and results made of them; large examples with coarser meshes.

    Parameters
    ----------
    folder : where meshes and results are made
    """
    tests = ROOT / "tests" / "deck"
    keywords = [path.read_text() for path in sorted((tests / "inp" / "decks").glob("*.inp"))]
    tables = [path.read_text() for path in sorted((tests / "decks").glob("*.toml"))]
    examples = [path.read_text() for path in sorted((ROOT / "examples").glob("*.toml"))]
    tables += [_coarser(text) for text in examples if ".msh" not in text]
    lines = [line for text in tables for line in text.splitlines()]
    pairs = sorted({line for line in lines if re.match(r"[\w.]+ = [^\[{]*$|[\w.]+ = [\[{].*[\]}]$", line)})
    return Corpus(
        texts={"toml": tables, "inp": keywords},
        meshes=dict(_meshes(folder)),
        results=_results(folder / "results"),
        keys=sorted({line.split(" = ")[0] for line in pairs}),
        pairs=pairs,
    )


def _coarser(text: str) -> str:
    """A deck with every fourth of its many grid lines, and a fourth of its many cells."""

    def thin(found: re.Match[str]) -> str:
        values = found[2].replace("\n", " ").split(",")
        values = [value for value in values if value.strip()]
        return f"{found[1]}[{', '.join(value.strip() for value in values[:: 4 if len(values) > 8 else 1])}]"

    text = re.sub(r"(?m)^([xyz] = )\[([^\]]*)\]", thin, text)
    text = re.sub(r"(?m)^(n\w+ = )(\d\d+)", lambda found: f"{found[1]}{int(found[2]) // 4}", text)
    spacing = r"(?m)^(contact_spacing = )([\d.]+)"
    return re.sub(spacing, lambda found: f"{found[1]}{4 * float(found[2]):g}", text) if "fretting" in text else text


def _meshes(folder: Path) -> Iterator[tuple[str, bytes]]:
    """Small meshes in many formats, in the plane and in space."""
    plane = sg.rectangle(nx=2, ny=2, cells="triangle")
    solid = box(x=[0, 1, 2], y=[0, 1], z=[0, 1])
    for number, mesh in enumerate((plane, solid)):
        write_mesh(mesh, folder / "mesh.vtu")
        found = meshio.read(folder / "mesh.vtu")
        yield f"{number}.vtu", (folder / "mesh.vtu").read_bytes()
        ways: dict[str, dict[str, Any]] = {
            **{"a.vtu": {"file_format": "vtu", "binary": False}, "b.vtk": {"file_format": "vtk"}},
            **{"c.vtk": {"file_format": "vtk42", "binary": False}, "d.inp": {"file_format": "abaqus"}},
            **{"e.xdmf": {"file_format": "xdmf", "data_format": "XML"}},
            **{"g.bdf": {"file_format": "nastran"}, "h.mesh": {"file_format": "medit"}},
            **{"i.su2": {"file_format": "su2"}, "k.avs": {"file_format": "avsucd"}, "l.xdmf": {"file_format": "xdmf"}},
        }
        plain = meshio.Mesh(found.points, [(block.type, block.data) for block in found.cells])
        for suffix, way in ways.items():
            target = folder / f"{number}{suffix}"
            try:
                meshio.write(target, plain, **way)
            except Exception:  # a format that cannot hold this mesh
                continue
            yield target.name, target.read_bytes()
        corners = {"quad": (0, 1, 2), "triangle": (0, 1, 2)}
        faces = [block.data[:, corners[block.type]] for block in found.cells if block.type in corners]
        if faces:
            skin = meshio.Mesh(found.points, [("triangle", np.vstack(faces))])
            for suffix, binary in (
                ("m.stl", False),
                ("n.stl", True),
                ("o.ply", False),
                ("p.obj", None),
                ("q.off", None),
            ):
                meshio.write(folder / suffix, skin, **({} if binary is None else {"binary": binary}))
                yield f"{number}{suffix}", (folder / suffix).read_bytes()
        for version, binary in ((2.2, 0), (4.1, 0), (4.1, 1), (2.2, 1)):
            yield f"{number}{version}{binary}.msh", _gmsh(plain, version, bool(binary), folder)
    yield "r.unv", _UNIVERSAL.encode()


def _gmsh(mesh: meshio.Mesh, version: float, binary: bool, folder: Path) -> bytes:
    """A Gmsh file with physical groups and entities."""
    tags = [np.full(len(block.data), block.dim + 1) for block in mesh.cells]
    grouped = meshio.Mesh(
        mesh.points,
        mesh.cells,
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={f"group {block.dim}": np.array([block.dim + 1, block.dim]) for block in mesh.cells},
    )
    if version > 4:
        dimension = max(block.dim for block in mesh.cells)
        at = np.tile([dimension, dimension + 1], (len(mesh.points), 1))
        grouped.point_data["gmsh:dim_tags"] = at
    file = folder / "gmsh.msh"
    meshio.write(file, grouped, file_format="gmsh" if version > 4 else "gmsh22", binary=binary)
    return file.read_bytes()


_UNIVERSAL = """    -1
  2411
         1         1         1        11
   0.0D+00   0.0D+00   0.0D+00
         2         1         1        11
   1.0D+00   0.0D+00   0.0D+00
         3         1         1        11
   1.0D+00   1.0D+00   0.0D+00
         4         1         1        11
   0.0D+00   1.0D+00   0.0D+00
    -1
    -1
  2412
         1        44         2         1         7         4
         1         2         3         4
         2        11         2         1         7         2
         0         1         1
         1         2
    -1
    -1
  2467
         1         0         0         0         0         0         0         1
block
         8         1         0         0
         2         0         0         0         0         0         0         1
bottom
         8         2         0         0
    -1
"""


def small_model() -> sg.Model:
    """A block on a plane with friction, two steps: what results are made of."""
    return sg.Model(
        sg.rectangle(nx=3, ny=2),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("left", u=(0, None))],
        loads=[sg.Load("top", traction=(0.2, -1.0))],
        contacts=[sg.Contact("bottom", mortar=sg.Plane(point=(0, 0), normal=(0, 1)), friction=0.3)],
        steps=[sg.Step(name="a", increments=2), sg.Step(name="b", scale={"top": 0.5})],
    )


def _results(folder: Path) -> Path:
    """What a run leaves."""
    from signorini.clock import Clock
    from signorini.output.folder import Publisher, open_folder

    made = Publisher(folder=open_folder(folder), deck="deck.toml", clock=Clock(), started=0.0, prints=None)
    made.publish(sg.solve(small_model()))
    return folder


def damage(sound: Corpus, chance: random.Random, folder: Path, kind: str = "") -> tuple[str, Path]:
    """Write one damaged input into a folder; its kind, by chance if none is given, and where it is."""
    kind = kind or chance.choices(KINDS, _SHARES)[0]
    if kind in DECKS:
        path = folder / f"deck.{kind}"
        text = (damaged_keywords if kind == "inp" else damaged_tables)(sound, chance)
        path.write_bytes(text.encode("utf-8", "surrogateescape"))
        return kind, path
    if kind == "mesh":
        name = chance.choice(sorted(sound.meshes))
        path = folder / f"mesh{Path(name).suffix}"
        path.write_bytes(_damaged_bytes(sound.meshes[name], chance))
        if path.suffix == ".xdmf" and (sound.results.parent / f"{Path(name).stem}.h5").is_file():
            shutil.copy(sound.results.parent / f"{Path(name).stem}.h5", folder)
        return kind, path
    if kind == "state":
        path = folder / "state.npz"
        path.write_bytes(_damaged_state((sound.results / "state.npz").read_bytes(), chance))
        return kind, path
    if kind == "archive":
        path = folder / "solution.h5"
        path.write_bytes((sound.results / "solution.h5").read_bytes())
        _damage_archive(path, chance)
        return kind, path
    path = folder / "results"
    shutil.copytree(sound.results, path, dirs_exist_ok=True)
    file = path / chance.choice(("summary.json", "solution.h5"))
    content = file.read_bytes()
    if file.suffix == ".json" and chance.random() < 0.7:
        content = json.dumps(_damaged_json(json.loads(content), chance)).encode()
    else:
        content = _damaged_bytes(content, chance)
    file.write_bytes(content)
    return kind, path


def _words(text: str, chance: random.Random, others: Sequence[str]) -> str:
    return chance.choice(others) if chance.random() < 0.5 else chance.choice(_NUMBERS) if text else ""


def _damaged_lines(lines: list[str], decks: Sequence[str], chance: random.Random, new: Sequence[str]) -> list[str]:
    """Lines lost, added, taken from another deck, exchanged or repeated."""
    at, kind = chance.randrange(len(lines)), chance.randrange(5)
    if kind == 0:
        del lines[at : at + chance.randint(1, 4)]
    elif kind == 1:
        lines[at:at] = [chance.choice(new)]
    elif kind == 2:
        other = chance.choice(decks).split("\n")
        start = chance.randrange(len(other))
        lines[at:at] = other[start : start + chance.randint(1, 12)]
    elif kind == 3:
        other_at = chance.randrange(len(lines))
        lines[at], lines[other_at] = lines[other_at], lines[at]
    else:
        lines[at:at] = lines[at : at + chance.randint(1, 6)]
    return lines or [""]


def _spliced(line: str, word: str, chance: random.Random) -> str:
    """A line in which a word stands instead of up to two characters."""
    place = chance.randrange(len(line) + 1)
    return line[:place] + word + line[place + chance.randrange(3) :]


def damaged_keywords(sound: Corpus, chance: random.Random) -> str:
    """One of the decks of keywords with one to three changes."""
    decks = sound.texts["inp"]
    lines = chance.choice(decks).split("\n")
    for _ in range(chance.randint(1, 3)):
        at, kind = chance.randrange(len(lines)), chance.randrange(10)
        if kind < 5:
            lines = _damaged_lines(lines, decks, chance, _LINES)
        elif kind == 5:
            lines[at] = _spliced(lines[at], chance.choice(_OF_KEYWORDS + _NUMBERS), chance)
        else:
            words = lines[at].split(",")
            words[chance.randrange(len(words))] = chance.choice(_OF_KEYWORDS + _NUMBERS)
            lines[at] = ",".join(words)
    return "\n".join(lines)


def damaged_tables(sound: Corpus, chance: random.Random) -> str:
    """One of the TOML decks with one to three changes."""
    decks = sound.texts["toml"]
    lines = chance.choice(decks).split("\n")
    for _ in range(chance.randint(1, 3)):
        at, kind = chance.randrange(len(lines)), chance.randrange(12)
        pairs = [i for i, line in enumerate(lines) if " = " in line]
        if kind < 3:
            lines = _damaged_lines(lines, decks, chance, sound.pairs)
        elif kind == 3:
            lines[at] = _spliced(lines[at], chance.choice(_NUMBERS + _VALUES), chance)
        elif not pairs:
            continue
        else:
            at = chance.choice(pairs)
            key, _, value = lines[at].partition(" = ")
            if kind == 4:
                key = chance.choice(sound.keys)
            elif kind == 5:
                value = chance.choice(sound.pairs).partition(" = ")[2]
            elif kind < 9 and re.search(r"[\d.]", value):
                spots = list(re.finditer(r"-?\d[\d.e+-]*|\"[^\"]*\"", value))
                spot = chance.choice(spots) if spots else None
                if spot:
                    value = value[: spot.start()] + chance.choice(_NUMBERS + _VALUES) + value[spot.end() :]
            else:
                value = chance.choice(_NUMBERS + _VALUES)
            lines[at] = f"{key} = {value}"
    return "\n".join(lines)


def _damaged_bytes(content: bytes, chance: random.Random) -> bytes:
    """Contents of a file with one to four changes: numbers and words of texts, bytes, parts lost or repeated."""
    for _ in range(chance.randint(1, 4)):
        kind = chance.randrange(8)
        at = chance.randrange(len(content) + 1)
        if kind < 4:
            spots = list(re.finditer(rb"-?\d[\d.e+-]*", content[at : at + 4000]))
            if spots:
                spot = chance.choice(spots)
                new = chance.choice(_NUMBERS + _OF_KEYWORDS).encode()
                content = content[: at + spot.start()] + new + content[at + spot.end() :]
        elif kind == 4:
            content = content[:at]
        elif kind == 5:
            lines = content.split(b"\n")
            line = chance.randrange(len(lines))
            lines[line : line + chance.randint(0, 3)] = lines[line : line + 1] * chance.randint(0, 3)
            content = b"\n".join(lines)
        elif kind == 6:
            size = chance.choice((1, 1, 2, 4, 8))
            content = content[:at] + chance.randbytes(size) + content[at + size :]
        else:
            content = content[:at] + b"\xff" * 8 + content[at + 8 :]
    return content


def _damaged_array(array: Any, chance: random.Random) -> Any:
    """Another shape, another type, or another value."""
    ways: tuple[Callable[[], Any], ...] = (
        lambda: array.ravel()[: array.size // 2],
        lambda: np.concatenate([array.ravel(), array.ravel()]),
        lambda: array[None],
        lambda: array.astype(str),
        lambda: np.where(np.arange(array.size).reshape(array.shape) % 3 == 0, np.nan, 0.0),
        lambda: np.full(array.shape, chance.choice((-1, 10**9, 2**62))),
        lambda: np.full(array.shape, chance.choice((np.inf, 1e300, -1e-300))),
        lambda: np.array("x"),
        lambda: np.zeros(0),
    )
    return chance.choice(ways)()


def _damaged_state(content: bytes, chance: random.Random) -> bytes:
    """An archive of NumPy: damaged bytes, or a sound file of damaged arrays."""
    if chance.random() < 0.3:
        return _damaged_bytes(content, chance)
    with np.load(io.BytesIO(content)) as file:
        parts = {name: file[name] for name in file.files}
    name = chance.choice(sorted(parts))
    if chance.random() < 0.2:
        del parts[name]
    else:
        parts[name] = _damaged_array(parts[name], chance)
    made = io.BytesIO()
    np.savez(made, **parts)
    return made.getvalue()


def _damage_archive(path: Path, chance: random.Random) -> None:
    """An archive of a history: damaged bytes, a damaged structure, or damaged data sets; in place."""
    kind = chance.random()
    if kind < 0.3:
        path.write_bytes(_damaged_bytes(path.read_bytes(), chance))
        return
    with h5py.File(path, "r+") as file:
        names: list[str] = []
        file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        data = [name for name in names if name != "structure"]
        if kind < 0.8 or not data:
            seal, _, text = file["structure"].asstr()[()].partition("\n")
            plain = _damaged_json(json.loads(text), chance)
            del file["structure"]
            file.create_dataset("structure", data=f"{seal}\n{json.dumps(plain)}")
            return
        name = chance.choice(data)
        array = file[name][...]
        del file[name]
        if chance.random() < 0.8:
            new = _damaged_array(array, chance)
            file.create_dataset(name, data=new.astype("S") if new.dtype.kind == "U" else new)


def _damaged_json(value: Any, chance: random.Random) -> Any:
    """Plain data with one of its parts exchanged, lost or repeated."""
    holders: list[Any] = []

    def gather(part: Any) -> None:
        if isinstance(part, dict | list) and part:
            holders.append(part)
            for inner in part.values() if isinstance(part, dict) else part:
                gather(inner)

    gather(value)
    for _ in range(chance.randint(1, 2)):
        holder = chance.choice(holders)
        if not holder:
            continue
        key = chance.choice(sorted(holder, key=str)) if isinstance(holder, dict) else chance.randrange(len(holder))
        if chance.random() < 0.2:
            del holder[key]
        else:
            new = (None, True, 0, -1, 10**9, 1e308, "", "x", [], {}, [None], {"$": "class"}, holder[key])
            holder[key] = chance.choice(new)
    return value
