"""Pictures for meshes: colours as the file has them, upright, over white where they are transparent."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from workbench.core.errors import WorkbenchError
from workbench.io.picture import KEPT_SIDE, read_picture

RAMP = np.dstack(np.meshgrid(np.arange(0, 200, 10), np.arange(0, 240, 20))).astype(np.uint8)
COLOURS = np.dstack([RAMP, np.full(RAMP.shape[:2], 90, np.uint8)])


@pytest.mark.parametrize("mode", ["RGB", "RGBA", "P", "L", "I;16", "1", "CMYK"])
def test_colours_are_those_of_the_file(tmp_path: Path, mode: str) -> None:
    path = tmp_path / ("a.jpg" if mode == "CMYK" else "a.png")
    if mode == "I;16":
        Image.fromarray(COLOURS[..., 0].astype(np.uint16) * 257).save(path)
        wanted = np.repeat(COLOURS[..., :1], 3, axis=2)
    else:
        image = Image.fromarray(COLOURS).convert(mode)
        image.save(path, **({"quality": 100, "subsampling": 0} if mode == "CMYK" else {}))
        wanted = np.asarray(image.convert("RGB"))
    found = read_picture(str(path))
    assert found.shape == COLOURS.shape and found.dtype == np.uint8
    np.testing.assert_allclose(found.astype(int), wanted.astype(int), atol=8 if mode == "CMYK" else 0)


def test_what_is_transparent_is_white_and_turned_photographs_stand_upright(tmp_path: Path) -> None:
    clear = Image.fromarray(COLOURS).convert("RGBA")
    clear.putalpha(0)
    clear.save(tmp_path / "clear.png")
    assert (read_picture(str(tmp_path / "clear.png")) == 255).all()
    exif = Image.Exif()
    exif[0x0112] = 6  # as a camera held upright writes it
    Image.fromarray(COLOURS).save(tmp_path / "turned.png", exif=exif)
    np.testing.assert_array_equal(read_picture(str(tmp_path / "turned.png")), np.rot90(COLOURS, -1))


def test_large_ones_are_made_smaller_in_shape(tmp_path: Path) -> None:
    Image.new("RGB", (3 * KEPT_SIDE, KEPT_SIDE), "red").save(tmp_path / "large.jpg")
    found = read_picture(str(tmp_path / "large.jpg"))
    assert found.shape[1] == KEPT_SIDE and found.shape[0] == pytest.approx(KEPT_SIDE / 3, abs=1)


@pytest.mark.skipif(os.name != "posix", reason="there are no pipes among files")
def test_what_is_no_file_is_refused_and_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.png")
    (tmp_path / "folder.png").mkdir()
    for name in ("pipe.png", "folder.png"):
        with pytest.raises(WorkbenchError, match="ordinary"):
            read_picture(str(tmp_path / name))
