"""Session files: one zip with a readable `session.json` and the maps, or the JSON alone; pictures carry either.

A zip rather than a folder, so that a session is one thing to copy, and is written whole or not at all. Its members are
stored as they are: any viewer shows the JSON in it.
"""

from __future__ import annotations

import hashlib
import io
import math
import os
import stat
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import IO, Any

import numpy as np

from workbench.core.arrays import Floats, frozen
from workbench.core.errors import WorkbenchError
from workbench.engine.own_formulas import self_contained, with_own_names
from workbench.io.atomic import replacing, utf8
from workbench.io.file_names import relative_name, renamed
from workbench.io.opening import SAMPLE
from workbench.io.png_content import content_of, is_png, with_content
from workbench.io.read import read_bytes
from workbench.session.record import SessionRecord
from workbench.session.session import Session
from workbench.session.text import MOST_PARTS, parsed, part_count, plain_of, readable, record_of

ENDING = ".dwb"
ENDINGS = (ENDING, ".json")
PICTURE = ".png"
LARGEST_CARRIED = 2**24
"""Bytes of a session that a picture carries with its maps; of a larger one it carries the text alone."""
JSON_MEMBER = "session.json"
LARGEST_TEXT = 2**26
LARGEST_ARRAYS = 2**31
EXPANSION = 16
"""Bytes that a byte of a zip may become; in those that are written here it stays one."""
MOST_MEMBERS = 4096
PATH_FIELDS = ("source", "start_file", "carried")
LONGEST_SHOWN = 300
"""Characters of a path in a sentence."""
LONG_AGO = (1980, 1, 1, 0, 0, 0)
"""Date of all members: the same session gives the same bytes."""


def is_session_file(path: str | os.PathLike[str]) -> bool:
    """Whether the ending is that of a session."""
    return Path(path).suffix.lower() in ENDINGS


def write_session(path: str | os.PathLike[str], record: SessionRecord) -> None:
    """Write a session, whole or not at all: with its maps as `.dwb`, without them as `.json`.

    Files are named relative to the folder of the session. Raises `WorkbenchError`.
    """
    path = Path(path)
    if path.suffix.lower() not in ENDINGS:
        raise WorkbenchError(f"{path}: sessions are written as {' or '.join(ENDINGS)}; choose one of these endings.")
    folder = Path(os.path.realpath(path)).parent
    is_bare = path.suffix.lower() != ENDING
    with replacing(path) as part, part.open("wb") as stream:
        _write(stream, record, folder, is_bare)


def picture_with_session(png: bytes, path: str | os.PathLike[str], record: SessionRecord) -> bytes:
    """A PNG, to be written to `path`, that carries the session: `read_session` and the window open it.

    A session of more than `LARGEST_CARRIED` bytes goes without its maps. Raises `WorkbenchError`.
    """
    folder = Path(os.path.realpath(path)).parent
    maps = [record.map, *(leg.positions for leg in record.legs)]
    size = sum(positions.nbytes for positions in maps if positions is not None)
    stream = io.BytesIO()
    _write(stream, record, folder, size > LARGEST_CARRIED)
    return with_content(png, stream.getvalue())


def carries_session(path: str | os.PathLike[str]) -> bool:
    """Whether a file is a picture with a session in it."""
    try:
        data = read_bytes(Path(path)) if Path(path).suffix.lower() == PICTURE else b""
        return is_png(data) and content_of(data) is not None
    except WorkbenchError:
        return False


def _write(stream: IO[bytes], record: SessionRecord, folder: Path, is_bare: bool) -> None:
    if is_bare:
        legs = tuple(replace(leg, positions=None) for leg in record.legs)
        record = replace(record, map=None, legs=legs if legs and legs[0].origin == "start" else ())
    record = _with_choices(record, self_contained)
    record = replace(record, session=_with_paths(record.session, lambda name: relative_name(name, folder)))
    plain, arrays = plain_of(record)
    words = readable(plain) + "\n"
    if record.legs and (len(words) > LARGEST_TEXT or part_count(words) > MOST_PARTS):  # nobody could read that again
        plain, arrays = plain_of(replace(record, legs=()))
        words = readable(plain) + "\n"
    text = utf8(words)
    if is_bare:
        stream.write(text)
        return
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr(zipfile.ZipInfo(JSON_MEMBER, LONG_AGO), text)
        for name, array in arrays.items():
            with archive.open(zipfile.ZipInfo(f"{name}.npy", LONG_AGO), "w", force_zip64=True) as member:
                np.lib.format.write_array(member, np.ascontiguousarray(array, "<f8"), allow_pickle=False)


def _with_choices(record: SessionRecord, change: Callable[[Session], Session]) -> SessionRecord:
    legs = tuple(replace(leg, choices=change(leg.choices)) for leg in record.legs)
    return replace(record, session=change(record.session), legs=legs)


def read_session(path: str | os.PathLike[str]) -> SessionRecord:
    """The session in a file, its paths made absolute; nothing that it names is opened. Raises `WorkbenchError`."""
    path = Path(path)
    try:
        return _record_in(path, read_bytes(path))
    except WorkbenchError as error:
        sentence = error.sentence if str(path) in error.sentence else f"{path}: {error.sentence}"
        raise WorkbenchError(sentence) from None
    except MemoryError:
        raise WorkbenchError(f"{path} asks for more memory than there is; it is damaged, or no session.") from None


def _record_in(path: Path, data: bytes) -> SessionRecord:
    arrays: Mapping[str, Floats] = {}
    if is_png(data):
        carried = content_of(data)
        if carried is None:
            raise WorkbenchError("It is a picture that carries no session.")
        data = carried
    if data[:2] == b"PK":
        text, arrays = _unpacked(data)
    elif len(data) > LARGEST_TEXT:
        raise WorkbenchError(f"It has {len(data) / 2**20:.0f} MiB of text, too much for a session.")
    else:
        text = data
    try:
        plain = parsed(text.decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise WorkbenchError("It is no session: neither a zip nor text in UTF-8.") from None
    record = _with_choices(record_of(plain, arrays), with_own_names)
    folder = Path(os.path.abspath(path)).parent
    return replace(record, session=_with_paths(record.session, lambda name: os.path.normpath(folder / name)))


def _unpacked(data: bytes) -> tuple[bytes, dict[str, Floats]]:
    """The text of a zip, and its arrays by name; nothing is written anywhere."""
    text: bytes | None = None
    arrays: dict[str, Floats] = {}
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
            if len(members) > MOST_MEMBERS or sum(member.file_size for member in members) > EXPANSION * len(data):
                raise WorkbenchError("Unpacked it would be too large for a session.")
            for member in members:
                name = member.filename
                if stat.S_ISLNK(member.external_attr >> 16) or Path(name).name != name or "\\" in name:
                    raise WorkbenchError(f"It has a member {name[:60]!r} that leads elsewhere; a session has none.")
                if name == JSON_MEMBER and text is None:
                    text = _bounded(archive, member, LARGEST_TEXT)
                elif name.endswith(".npy") and name.removesuffix(".npy") not in arrays:
                    arrays[name.removesuffix(".npy")] = _array_in(name, _bounded(archive, member, LARGEST_ARRAYS))
                else:
                    raise WorkbenchError(f"It has a member {name[:60]!r} that a session does not have, or has it twice.")
    except (zipfile.BadZipFile, zipfile.LargeZipFile, NotImplementedError, RuntimeError, EOFError, OSError, ValueError):
        raise WorkbenchError("It is damaged or cut short, or packed in a way that is not known.") from None
    except Exception as error:
        if isinstance(error, WorkbenchError | MemoryError):
            raise
        raise WorkbenchError("It is damaged.") from None  # the unpacker's own faults
    if text is None:
        raise WorkbenchError(f"It has no {JSON_MEMBER}, so it is no session.")
    return text, arrays


def _bounded(archive: zipfile.ZipFile, member: zipfile.ZipInfo, most: int) -> bytes:
    """The bytes of a member; what it says about its size need not be true."""
    if member.file_size > most:
        raise WorkbenchError(f"Its {member.filename} would be too large for a session.")
    with archive.open(member) as stream:
        data = stream.read(member.file_size + 1)
    if len(data) != member.file_size:
        raise WorkbenchError(f"Its {member.filename} is not as long as it says.")
    return data


def _array_in(name: str, data: bytes) -> Floats:
    """A map (n, 2|3) out of the bytes of an npy file: plain finite numbers, never pickled, no longer than the bytes."""
    stream: IO[bytes] = io.BytesIO(data)
    shape: tuple[int, ...]
    try:
        if np.lib.format.read_magic(stream) != (1, 0):  # type: ignore[arg-type]
            raise ValueError
        shape, by_columns, dtype = np.lib.format.read_array_header_1_0(stream)
    except (ValueError, TypeError, SyntaxError, RecursionError):
        raise WorkbenchError(f"Its {name} is no array of numbers.") from None
    content = data[stream.tell() :]
    if dtype != np.dtype("<f8") or by_columns or len(shape) != 2 or shape[1] not in (2, 3):
        raise WorkbenchError(f"Its {name} is no map: rows of two or three numbers are needed.")
    if math.prod(shape) * 8 != len(content):
        raise WorkbenchError(f"Its {name} is not as long as it says.")
    found = frozen(np.frombuffer(content, dtype="<f8").reshape(shape))
    if not np.isfinite(found).all():
        raise WorkbenchError(f"Its {name} has a number that is not finite.")
    return found


# ---------------------------------------------------------------------------------------------- files


def _with_paths(session: Session, change: Callable[[str], str]) -> Session:
    """The session with the names of its files changed; samples stay."""
    changes: dict[str, Any] = {field: renamed(getattr(session, field), change) for field in PATH_FIELDS}
    return replace(session, **changes)


def source_digest(source: str) -> str:
    """sha256 of the file of a source; empty for a sample, and where there is no such file."""
    if not source or source.startswith(SAMPLE):
        return ""
    try:
        return hashlib.sha256(read_bytes(Path(source))).hexdigest()
    except WorkbenchError:
        return ""


def _is_file(source: str) -> bool:
    try:
        return Path(source).is_file()
    except (OSError, ValueError):  # a name that no file can have, or a folder that may not be looked into
        return False


def source_trouble(record: SessionRecord) -> str:
    """Why the source of a session cannot be used as it was, in a sentence; empty where it can."""
    source = record.session.source
    if not source or source.startswith(SAMPLE):
        return "" if source else "The session names no mesh."
    if not _is_file(source):
        shown = source if len(source) <= LONGEST_SHOWN else f"…{source[-LONGEST_SHOWN:]}"
        return f"The mesh of the session is not at {shown}."
    if record.sha256 and source_digest(source) != record.sha256:
        return f"The mesh {source} is another than when the session was saved."
    return ""
