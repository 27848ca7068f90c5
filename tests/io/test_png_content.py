"""Bytes that ride in a PNG: the picture stays the same, and damage is told."""

import io
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from workbench.core.errors import WorkbenchError
from workbench.io.png_content import CHUNK, content_of, is_png, with_content


def picture(seed: int = 0) -> bytes:
    stream = io.BytesIO()
    pixels = np.random.default_rng(seed).integers(0, 256, (7, 5, 3), dtype=np.uint8)
    Image.fromarray(pixels).save(stream, "PNG", dpi=(300, 300))
    return stream.getvalue()


@given(st.binary(max_size=2000), st.binary(max_size=200))
def test_what_is_put_in_comes_out_and_the_picture_stays(content: bytes, other: bytes) -> None:
    plain = picture()
    assert content_of(plain) is None
    carrying = with_content(with_content(plain, other), content)
    assert content_of(carrying) == content
    assert len(carrying) == len(plain) + len(content) + 12
    before, after = Image.open(io.BytesIO(plain)), Image.open(io.BytesIO(carrying))
    after.load()
    assert np.array_equal(np.asarray(before), np.asarray(after))
    assert after.info["dpi"] == before.info["dpi"]


@given(st.integers(0, 400), st.integers(0, 255), st.integers(0, 400))
def test_damage_is_told_or_leaves_the_content_alone(place: int, value: int, length: int) -> None:
    whole = with_content(picture(), b"all that was chosen")
    bad = bytearray(whole)
    bad[place % len(bad)] = value
    for data in (bytes(bad), whole[: length % len(whole)]):
        try:
            assert content_of(data) in (b"all that was chosen", None)
        except WorkbenchError:
            pass


def test_two_contents_and_lengths_that_lie_are_refused() -> None:
    whole = with_content(picture(), b"one")
    begin = whole.index(CHUNK) - 4
    chunk = whole[begin : begin + 15]
    with pytest.raises(WorkbenchError, match="two"):
        content_of(whole[:begin] + chunk + whole[begin:])
    with pytest.raises(WorkbenchError, match="cut short"):
        content_of(whole[:begin] + struct.pack(">I", 2**31) + whole[begin + 4 :])
    with pytest.raises(WorkbenchError, match="damaged"):
        content_of(whole[: begin + 8] + b"two" + whole[begin + 11 :])
    assert not is_png(b"GIF89a")
