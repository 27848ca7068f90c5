"""A picture that is laid over a mesh, from a file."""

from __future__ import annotations

import stat
import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from workbench.core.errors import WorkbenchError

PICTURE_ENDINGS = (".png", ".jpg", ".jpeg")
LARGEST_FILE = 64 << 20
"""Bytes of a file that is looked into at all."""
LARGEST_SIDE = 20_000
"""Pixels of a side of a picture that is decoded."""
MOST_PIXELS = 120_000_000
"""Of a picture that is decoded."""
KEPT_SIDE = 2048
"""Pixels of the longer side that are kept: more is not seen on a mesh."""


def is_picture(path: str) -> bool:
    """Whether a file is one by its ending."""
    return Path(path).suffix.lower() in PICTURE_ENDINGS


def read_picture(path: str) -> NDArray[np.uint8]:
    """The colours (height, width, 3) of a PNG or JPEG, the first row at the top; transparent parts are white.

    Raises `WorkbenchError` for a file that is missing, too large, or no such picture.
    """
    from PIL import Image, ImageOps, UnidentifiedImageError

    try:
        status = Path(path).stat()
    except (OSError, ValueError) as error:
        raise WorkbenchError(f"{path}: {getattr(error, 'strerror', '') or error}; choose another picture.") from None
    if not stat.S_ISREG(status.st_mode):
        raise WorkbenchError(f"{path} is not an ordinary file; choose a picture.")
    if status.st_size > LARGEST_FILE:
        megabytes, most = status.st_size >> 20, LARGEST_FILE >> 20
        raise WorkbenchError(f"{path} has {megabytes} MB, and {most} MB are the most; make the picture smaller.")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # there are bounds of our own below
            image = Image.open(path, formats=("PNG", "JPEG"))
        with image:
            width, height = image.size
            if max(width, height) > LARGEST_SIDE or width * height > MOST_PIXELS:
                raise WorkbenchError(_too_large(path, f"{width} x {height}"))
            image.draft("RGB", (KEPT_SIDE, KEPT_SIDE))
            upright = _in_colours(ImageOps.exif_transpose(image))
            upright.thumbnail((KEPT_SIDE, KEPT_SIDE), Image.Resampling.BOX)
            return np.array(upright)
    except Image.DecompressionBombError:
        raise WorkbenchError(_too_large(path, "far more")) from None
    except UnidentifiedImageError:
        if _begins_like_one(path):
            raise WorkbenchError(f"{path} cannot be read: it is damaged or cut short. Choose another picture.") from None
        raise WorkbenchError(f"{path} is no PNG and no JPEG; choose such a picture.") from None
    except (OSError, ValueError, SyntaxError, EOFError) as error:
        raise WorkbenchError(f"{path} cannot be read: {error}. Choose another picture.") from None


def _too_large(path: str, size: str) -> str:
    return f"{path} has {size} pixels; {LARGEST_SIDE} a side are the most, and {MOST_PIXELS // 10**6} million in all."


def _begins_like_one(path: str) -> bool:
    with Path(path).open("rb") as stream:
        return stream.read(8).startswith((b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff"))


def _in_colours(image):  # type: ignore[no-untyped-def]
    """Red, green and blue, over white where the picture is transparent."""
    from PIL import Image

    if image.mode.startswith("I"):  # sixteen bits of grey
        return Image.fromarray((np.asarray(image) >> 8).astype(np.uint8)).convert("RGB")
    if "A" not in image.getbands() and "transparency" not in image.info:
        return image.convert("RGB")
    clear = image.convert("RGBA")
    return Image.alpha_composite(Image.new("RGBA", clear.size, (255, 255, 255, 255)), clear).convert("RGB")
