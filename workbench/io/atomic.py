"""Files that are whole or not there: written beside their place and renamed."""

from __future__ import annotations

import os
import secrets
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
        if target.is_dir():
            raise WorkbenchError(f"{path} is a folder; name a file to write.")
        if not target.parent.is_dir():
            raise WorkbenchError(f"There is no folder {target.parent}; make it first, or name another place.")
        yield part
        os.replace(part, target)
    except PermissionError:
        raise WorkbenchError(f"{path} may not be written (permission denied); name another place.") from None
    except OSError as error:
        raise WorkbenchError(f"{path} cannot be written: {error.strerror or error}.") from None
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Writes `text` as UTF-8, whole or not at all."""
    with replacing(path) as part:
        part.write_bytes(text.encode("utf-8"))
