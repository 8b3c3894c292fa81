# SPDX-License-Identifier: BSD-3-Clause
"""Files that inputs name: which of them may be read. A deck that somebody else has written names no file of yours."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from signorini.errors import InputError, Where
from signorini.memory import check_memory

_UP = 2
"""Folders above that of a deck: ``../../common/steel.inc`` is usual, more is not."""

_SHOWN = 200  # characters of a name in messages
_NETWORK = re.compile(r"[\\/]{2}|[A-Za-z][A-Za-z0-9+.-]+:[\\/]{2}")  # a share of Windows, a URL


@dataclass(frozen=True, kw_only=True)
class Reach:
    """The files that a deck may name: ordinary ones near it, in no hidden folder, that fit into memory.

    Near are those in the folder of the deck or below, and in what is below the folder two above it, unless that is the
    root of the file system; further ones are read if the user says so. It counts where a file is, not how it is
    spelled: absolute names, ``..`` and links are followed first.

    Parameters
    ----------
    folder : of the deck; names are relative to it
    also : folders in which, and below which, files may be read too
    search : those of them in which a relative name is looked for that the folder of the deck does not have, in turn
    """

    folder: Path
    also: tuple[Path, ...] = ()
    search: tuple[Path, ...] = ()

    @classmethod
    def of(cls, deck: Path, also: Iterable[str | Path] = (), search: Iterable[str | Path] = ()) -> Reach:
        """The reach of a deck, of folders allowed besides, and of folders in which names are looked for too.

        Parameters
        ----------
        deck : file of it
        also : folders that are allowed
        search : folders that are allowed, and in which names are looked for

        Raises
        ------
        InputError
            If what is allowed or searched is no folder.
        """
        allowed, searched = (tuple(Path(name) for name in names) for names in (also, search))
        for folders, option in ((allowed, "--allow"), (searched, "--include")):
            for folder in folders:
                if not folder.is_dir():
                    raise InputError(f"there is no folder '{folder}'", where=(option,))
        return cls(folder=deck.parent, also=allowed + searched, search=searched)

    @property
    def top(self) -> Path:
        """The folder below which files are near."""
        above = [self.folder.resolve(), *self.folder.resolve().parents]
        below_root = [folder for folder in above if folder != folder.parent]
        return below_root[min(_UP, len(below_root) - 1)] if below_root else above[0]

    def file(self, name: str, where: Where = ()) -> Path:
        """A file that is named, which can be read and may be.

        Raises
        ------
        InputError
            Says what the name is instead.

        Examples
        --------
        >>> Reach(folder=Path("decks")).file("https://example.org/mesh.msh")
        Traceback (most recent call last):
        signorini.errors.InputError: 'https://example.org/mesh.msh' is on a network; expected a file on this computer
        """
        shown = _short(name)
        if _NETWORK.match(name):
            raise InputError(f"'{shown}' is on a network; expected a file on this computer", where=where)
        try:
            path = self._found(name)
            self._check_place(shown, path.resolve())
            check_file(path)
        except (OSError, ValueError, RuntimeError) as error:  # names that no file can have
            if isinstance(error, InputError):
                raise error.inside(*where) from error
            why = getattr(error, "strerror", None) or error
            raise InputError(f"'{shown}' is no name of a file: {why}", where=where) from error
        return path

    def _found(self, name: str) -> Path:
        """The file in the folder of the deck; if there is none, the first of that name in a folder that is searched."""
        places = [folder / name for folder in (self.folder, *self.search)]
        return next((place for place in places if os.path.exists(place)), places[0])

    def _check_place(self, shown: str, file: Path) -> None:
        """Refuse a file, without links in its name, that is too far away or hidden."""
        here, top = self.folder.resolve(), self.top
        roots = [folder.resolve() for folder in self.also]
        if file.parent == here:
            roots = [here]
        elif top != top.parent and file.is_relative_to(top):
            roots = [Path(os.path.commonpath([here, file]))]
        held = [file.relative_to(root).parts for root in roots if file.is_relative_to(root)]
        if not held:
            raise InputError(
                f"'{shown}' lies in {file.parent}, not near the deck (below {top}); expected a nearer file, or "
                f"--allow {file.parent}"
            )
        hidden = [part for part in held[0] if part.startswith(".")]
        if hidden:
            raise InputError(f"'{shown}' is hidden, in or as '{hidden[0]}'; expected a file that is not")


def check_file(path: Path) -> None:
    """Refuse what is no ordinary file, as devices and pipes are, or does not fit into memory.

    Raises
    ------
    InputError
        If there is none, or it is something else.
    """
    try:
        found = path.stat()
    except (FileNotFoundError, NotADirectoryError) as error:
        raise InputError(f"there is no file '{path}'") from error
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise InputError(f"'{_short(str(path))}' cannot be read: {why}") from error
    if stat.S_ISDIR(found.st_mode):
        raise InputError(f"'{path}' is a folder; expected a file")
    if not stat.S_ISREG(found.st_mode):
        raise InputError(f"'{path}' is a device or a pipe; expected a file")
    check_memory(found.st_size, f"'{path}'")


def _short(name: str) -> str:
    return name if len(name) <= _SHOWN else name[:_SHOWN] + "..."
