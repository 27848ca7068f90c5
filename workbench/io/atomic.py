"""Files that are whole or not there: written beside their place and renamed."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from workbench.core.errors import WorkbenchError


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A path beside `path`, of the same ending, to write to; it takes the place of `path` when the block ends well.

    Raises `WorkbenchError` where the file cannot be written; what was there before stays.
    """
    target = Path(os.path.realpath(path))
    part = target.with_name(f".{target.stem[:80]}-{secrets.token_hex(4)}{target.suffix}")
    try:
        with _faults_told(path):
            if target.is_dir():
                raise WorkbenchError(f"{path} is a folder; name a file to write.")
            _check_parent(target)
            yield part
            os.replace(part, target)
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)


@contextmanager
def filling(folder: str | os.PathLike[str]) -> Iterator[Path]:
    """A folder beside `folder` to write files into; when the block ends well they go to `folder`, which is made if need be.

    Other files in `folder` stay. Raises `WorkbenchError` where that cannot be; then nothing has been written.
    """
    target = Path(os.path.realpath(folder))
    part = target.with_name(f".{target.name[:80]}-{secrets.token_hex(4)}")
    try:
        with _faults_told(folder):
            check_folder(folder)
            part.mkdir()
            yield part
            if target.exists():
                _move_files(part, target)
            else:
                os.replace(part, target)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def check_folder(folder: str | os.PathLike[str]) -> None:
    """Raises `WorkbenchError` unless `folder` can be filled."""
    target = Path(os.path.realpath(folder))
    if target.exists() and not target.is_dir():
        raise WorkbenchError(f"{folder} is a file; name a folder to write into.")
    _check_parent(target)
    if not all(os.access(place, os.W_OK) for place in (target.parent, target) if place.is_dir()):
        raise WorkbenchError(f"{folder} may not be written (permission denied); name another place.")


def _check_parent(target: Path) -> None:
    if not target.parent.is_dir():
        raise WorkbenchError(f"There is no folder {target.parent}; make it first, or name another place.")


def _move_files(source: Path, target: Path) -> None:
    """Every file below `source` to the same place below `target`."""
    for file in sorted(path for path in source.rglob("*") if path.is_file()):
        place = target / file.relative_to(source)
        place.parent.mkdir(parents=True, exist_ok=True)
        os.replace(file, place)


@contextmanager
def _faults_told(path: str | os.PathLike[str]) -> Iterator[None]:
    """What the operating system refuses is said in a sentence about `path`."""
    try:
        yield
    except PermissionError:
        raise WorkbenchError(f"{path} may not be written (permission denied); name another place.") from None
    except OSError as error:
        raise WorkbenchError(f"{path} cannot be written: {error.strerror or error}.") from None


def write_bytes(path: str | os.PathLike[str], data: bytes) -> None:
    """Writes `data`, whole or not at all."""
    with replacing(path) as part:
        part.write_bytes(data)


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Writes `text` as UTF-8, whole or not at all."""
    write_bytes(path, utf8(text))


def utf8(text: str) -> bytes:
    r"""`text` as bytes; what names of files have that is no text stands as `\udcff` does, which JSON and Python read back."""
    return text.encode("utf-8", errors="backslashreplace")
