"""Write beside, then move: an output folder is either as it was or complete.

Files are made in a draft folder next to the target. At the end they replace, one by one, the files
of the same name; what an earlier run left and this one does not make goes; everything else in the
folder stays, and a folder in the place of a file, or a file in the place of a folder, is an error.
When a move fails, the moves before it are taken back.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from fabrication.errors import OutputError


@contextmanager
def draft_folder(out: Path, *, names: Sequence[str] = ()) -> Iterator[Path]:
    """A fresh folder beside *out*, gone afterwards whatever happens.

    Folders above *out* that had to be made go again unless *out* itself is there in the end.

    Parameters
    ----------
    out : the folder to be filled.
    names : files that are known to come, relative to *out*.

    Raises
    ------
    OutputError
        When *out* is a file, or it or the folder above it cannot be written, or something else
        stands where one of *names* must be.
    """
    if out.exists() and not out.is_dir():
        raise OutputError(
            "The output folder is a file", where=str(out), advice="another name after --out"
        )
    _require_places(out, [Path(name) for name in names])
    made = [parent for parent in (out.absolute().parents) if not parent.exists()]
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        draft = Path(tempfile.mkdtemp(prefix=f".{out.name}-", dir=out.parent))
        if out.is_dir():
            Path(tempfile.mkdtemp(prefix=".probe-", dir=out)).rmdir()
    except OSError as error:
        _remove(made)
        raise _cannot_write(out, error) from None
    try:
        yield draft
    finally:
        shutil.rmtree(draft, ignore_errors=True)
        if not out.exists():
            _remove(made)


def move_in(draft: Path, out: Path, *, stale: Sequence[str]) -> None:
    """Move all files of *draft* into *out*.

    Parameters
    ----------
    draft, out : on one file system.
    stale : patterns, relative to *out*, of files that go when this run did not make them.

    Raises
    ------
    OutputError
        When a file cannot be moved, or a folder stands in its place. *out* is then as it was, as
        it is after an interrupt.
    """
    fresh = [path.relative_to(draft) for path in sorted(draft.rglob("*")) if path.is_file()]
    _require_places(out, fresh)
    old = [
        path.relative_to(out)
        for pattern in stale
        for path in sorted(out.glob(pattern))
        if not path.is_dir()
    ]
    aside = Path(tempfile.mkdtemp(prefix=".old-", dir=draft))
    done: list[tuple[Path, Path]] = []
    wanted = [out, *sorted({(out / name).parent for name in fresh})]
    made = [folder for folder in wanted if not folder.exists()]
    try:
        for name in dict.fromkeys([*old, *fresh]):
            if (out / name).exists():
                _move(out / name, aside / name, done)
        for name in fresh:
            _move(draft / name, out / name, done)
    except BaseException as error:
        for source, target in reversed(done):
            if target.exists():
                target.replace(source)
        _remove(made[::-1])
        if isinstance(error, OSError):
            raise _cannot_write(out, error) from None
        raise


def _require_places(out: Path, names: Sequence[Path]) -> None:
    """Refuse folders where files of *names* must be, and files where their folders must be."""
    for name in names:
        folder = next((out / above for above in name.parents if _is_no_folder(out / above)), None)
        if folder is not None or (out / name).is_dir():
            kind, other = ("folder", "file") if folder is None else ("file", "folder")
            raise OutputError(
                f"The output folder cannot be written: a {kind} is where a {other} must be",
                where=str(folder or out / name),
                advice="move it elsewhere, or another name after --out",
            )


def _is_no_folder(path: Path) -> bool:
    return path.exists() and not path.is_dir()


def _move(source: Path, target: Path, done: list[tuple[Path, Path]]) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    done.append((source, target))
    try:
        source.replace(target)
    except OSError:
        done.pop()
        raise


def _remove(folders: Sequence[Path]) -> None:
    """Remove empty *folders*, innermost first."""
    for folder in folders:
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()


def _cannot_write(out: Path, error: OSError) -> OutputError:
    return OutputError(
        "The output folder cannot be written",
        where=str(out),
        value=error.strerror or type(error).__name__,
        advice="a folder you may write to",
    )
