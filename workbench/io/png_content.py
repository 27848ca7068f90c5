"""What a PNG carries beside its picture: bytes in an ancillary chunk of our own, which viewers pass over.

Layout of chunks after the PNG specification (ISO/IEC 15948): length, type, data, CRC.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator

from workbench.core.errors import WorkbenchError

SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHUNK = b"wbSn"
"""Ancillary, private, and safe to copy: whoever edits the picture may leave it in."""
MOST_CHUNKS = 1_000_000


def is_png(data: bytes) -> bool:
    """Whether the bytes begin as those of a PNG do."""
    return data[: len(SIGNATURE)] == SIGNATURE


def with_content(png: bytes, content: bytes) -> bytes:
    """The same picture, carrying `content` in place of what it carried. Raises `WorkbenchError` where it is no PNG."""
    parts = [SIGNATURE]
    for kind, start, end in _chunks(png):
        if kind == b"IEND":
            body = CHUNK + content
            parts.append(struct.pack(">I", len(content)) + body + struct.pack(">I", zlib.crc32(body)))
        if kind != CHUNK:
            parts.append(png[start:end])
    return b"".join(parts)


def content_of(png: bytes) -> bytes | None:
    """What a picture carries; None where that is nothing. Raises `WorkbenchError` where it is damaged."""
    found: bytes | None = None
    for kind, start, end in _chunks(png):
        if kind != CHUNK:
            continue
        if found is not None:
            raise WorkbenchError("It carries two sessions.")
        if zlib.crc32(png[start + 4 : end - 4]) != struct.unpack(">I", png[end - 4 : end])[0]:
            raise WorkbenchError("The session in it is damaged.")
        found = png[start + 8 : end - 4]
    return found


def _chunks(png: bytes) -> Iterator[tuple[bytes, int, int]]:
    """(type, begin, end) of each chunk up to the last one, which has to be there."""
    if not is_png(png):
        raise WorkbenchError("It is no PNG.")
    position = len(SIGNATURE)
    for _ in range(MOST_CHUNKS):
        if position + 12 > len(png):
            break
        length, kind = struct.unpack(">I4s", png[position : position + 8])
        end = position + 12 + length
        if end > len(png):
            break
        yield kind, position, end
        if kind == b"IEND":
            return
        position = end
    raise WorkbenchError("It is cut short, or no PNG.")
