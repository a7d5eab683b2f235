"""The project's file: read, written with its comments, and watched for what others do to it."""

from __future__ import annotations

import os
import tempfile
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit

from fabrication.errors import OutputError
from fabrication.project import read_document
from fabrication.studio.versions import Document, differences, set_value


@dataclass(frozen=True)
class Saved:
    """What the file said when it was last read or written.

    Parameters
    ----------
    text : what a save goes on from.
    seen : what the file says as far as is known: *text*, or what another program wrote over it and
        may be written over; None where it was removed.
    """

    path: Path
    text: str
    seen: str | None

    @property
    def document(self) -> dict[str, Any]:
        """The file as tables."""
        return tomllib.loads(self.text)

    def now(self) -> str | None:
        """What it says now; None where it is gone or cannot be read."""
        try:
            return self.path.read_text(encoding="utf-8-sig")
        except (OSError, UnicodeDecodeError):
            return None

    @property
    def changed(self) -> bool:
        """Whether another program wrote or removed it since."""
        return self.now() != self.seen


def read(path: Path) -> Saved:
    """The file as it is.

    Raises
    ------
    ProjectError
        When it cannot be read or is not TOML.
    """
    text, _ = read_document(path)
    return Saved(path, text, text)


def edited(text: str, document: Document) -> str:
    """*text* with the values of *document*; comments, order and all else stay as they are."""
    made = tomlkit.parse(text)
    for key, value in differences(tomllib.loads(text), document).items():
        if isinstance(value, list) and key in _arrays(document):
            for n, item in enumerate(value):
                set_value(made, f"{key}.{n}", item)
        else:
            set_value(made, key, value)
    return tomlkit.dumps(made)


def _arrays(document: Document, before: str = "") -> Iterator[str]:
    """Keys of arrays of numbers, whose layout and comments are kept."""
    for name, value in document.items():
        if isinstance(value, Mapping):
            yield from _arrays(value, f"{before}{name}.")
        elif isinstance(value, list) and all(isinstance(v, int | float) for v in value):
            yield f"{before}{name}"


def write(saved: Saved, document: Document) -> Saved:
    """Write *document* over the file, unless another program did since.

    Raises
    ------
    OutputError
        When the file was changed or removed meanwhile, or cannot be written.
    """
    if saved.changed:
        raise OutputError(
            "The project file was changed by another program since it was read",
            where=str(saved.path),
            advice="load it, or save under another name",
        )
    return _written(saved.path, edited(saved.text, document))


def write_copy(saved: Saved, name: str, document: Document) -> Saved:
    """Write *document* as a new file *name* in the same folder; never over another file.

    Raises
    ------
    OutputError
        For a name with a folder in it or without .toml, one that is taken, or a folder that cannot
        be written.
    """
    path = saved.path.parent / name
    if Path(name).name != name or not name.endswith(".toml") or name.startswith("."):
        raise OutputError(
            "A project is saved in its own folder, as a file that ends in .toml",
            where=str(saved.path.parent),
            value=name or "no name",
            advice="a name such as roof-62.toml",
        )
    if path.exists():
        raise OutputError("The file is there already", where=str(path), advice="another name")
    return _written(path, edited(saved.text, document))


def _written(path: Path, text: str) -> Saved:
    """Write beside, then move: the file is either as it was or complete."""
    draft = None
    try:
        with tempfile.NamedTemporaryFile(
            "w",
            encoding="utf-8",
            newline="",
            dir=path.parent,
            prefix=f".{path.name}-",
            delete=False,
        ) as file:
            draft = Path(file.name)
            file.write(text)
        if path.exists():
            os.chmod(draft, path.stat().st_mode & 0o777)
        else:
            os.chmod(draft, 0o644)
        os.replace(draft, path)
    except OSError as error:
        if draft is not None:
            draft.unlink(missing_ok=True)
        raise OutputError(
            "The project cannot be saved",
            where=str(path),
            value=error.strerror or type(error).__name__,
        ) from None
    return Saved(path, text, text)


def outside(document: Document, folder: Path) -> str | None:
    """The first file the project names that lies outside *folder*, with its key; None for none."""
    root = folder.resolve()
    for key, name in _files(document):
        if not (folder / name).resolve().is_relative_to(root):
            return f"{key} = {name!r}"
    return None


def _files(document: Any, before: str = "") -> Iterator[tuple[str, str]]:
    if isinstance(document, Mapping):
        for name, value in document.items():
            if name == "file" and isinstance(value, str):
                yield f"{before}{name}", value
            else:
                yield from _files(value, f"{before}{name}.")
    elif isinstance(document, list):
        for n, value in enumerate(document):
            yield from _files(value, f"{before}{n}.")
