"""Films as files: GIF by Pillow, MP4 by the program ffmpeg; frames are written as they come."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO, Any, Protocol

import numpy as np

from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.figures.film import Film, FilmDrawer, Still
from workbench.figures.film_shading import Pixels
from workbench.io.atomic import replacing

FORMATS = (".gif", ".mp4")
INSTALL = (
    "MP4 needs the program ffmpeg: install it (apt install ffmpeg, brew install ffmpeg), "
    'or in a checkout pip install ".[film]"; a GIF needs neither.'
)
PALETTE_FROM = 6
"""Frames from which the colours of a GIF are taken, all over the film."""
SAMPLE = 120_000
"""Pixels of those frames that are looked at for colours."""
TRANSPARENT = 255
QUALITY = 18
"""Constant rate factor of H.264: no loss is seen."""
WAIT = 60.0
"""Seconds that ffmpeg may take to end."""


class FilmCancelledError(WorkbenchError):
    """The film was cancelled; nothing was written."""


class FilmWriter(Protocol):
    """Takes frames in turn."""

    def write(self, frame: Pixels) -> None: ...
    def close(self) -> None: ...
    def abandon(self) -> None: ...


def check_film_path(path: str | os.PathLike[str]) -> str:
    """The ending of a film's file. Raises `WorkbenchError` unless it can be written here."""
    ending = Path(path).suffix.lower()
    if ending not in FORMATS:
        raise WorkbenchError(f"{path}: films are written as {' or '.join(FORMATS)}; choose one of these endings.")
    if ending == ".mp4" and not ffmpeg():
        raise WorkbenchError(INSTALL)
    return ending


def ffmpeg() -> str:
    """Where the program is: that of the system, else that of the optional `imageio_ffmpeg`; empty where there is none."""
    found = shutil.which("ffmpeg")
    if found:
        return found
    if importlib.util.find_spec("imageio_ffmpeg") is None:
        return ""
    import imageio_ffmpeg

    try:
        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except RuntimeError:
        return ""


def save_film(
    path: str | os.PathLike[str],
    film: Film,
    mesh: Mesh,
    stills: Sequence[Still],
    tell: Callable[[float], None] = lambda share: None,
    cancelled: Callable[[], bool] = lambda: False,
) -> None:
    """Draw and write a film, whole or not at all; `tell` hears what part of it is done, in [0, 1].

    Raises `WorkbenchError` where that cannot be, `FilmCancelledError`. Blocks until done: a window calls it on a thread.
    """
    ending = check_film_path(path)
    film.check(len(stills))
    with replacing(path) as part:
        _look(cancelled)
        drawer = FilmDrawer(film, mesh, stills, lambda: _look(cancelled))
        writer = Mp4Writer(part, film) if ending == ".mp4" else GifWriter(part, film, _palette(drawer, stills, cancelled))
        try:
            for number, still in enumerate(stills):
                _look(cancelled)
                writer.write(drawer.draw(still))
                tell((number + 1) / len(stills))
            writer.close()
        except BaseException:
            writer.abandon()
            raise


def _look(cancelled: Callable[[], bool]) -> None:
    if cancelled():
        raise FilmCancelledError("The film was cancelled; nothing was written.")


# ---------------------------------------------------------------------------------------------- GIF


def _palette(drawer: FilmDrawer, stills: Sequence[Still], cancelled: Callable[[], bool]) -> Any:
    """One palette for all frames, so that no colour changes by itself: an image whose colours it are."""
    from PIL import Image

    rows = np.unique(np.linspace(0, len(stills) - 1, PALETTE_FROM).astype(int))
    frames = []
    for row in rows:
        _look(cancelled)
        frames.append(drawer.draw(stills[row]))
    kept = np.rint(255 * drawer.colours).astype(np.uint8)
    step = max(1, round((sum(frame.size // 3 for frame in frames) / SAMPLE) ** 0.5))
    montage = Image.fromarray(np.concatenate([frame[::step, ::step].reshape(-1, 1, 3) for frame in frames]))
    found = montage.quantize(TRANSPARENT - len(kept), method=Image.Quantize.MEDIANCUT).getpalette() or []
    colours = kept.ravel().tolist() + found
    image = Image.new("P", (1, 1))
    image.putpalette((colours + colours[:3] * 256)[: 3 * TRANSPARENT] + [0, 0, 0])
    return image


class GifWriter:
    """Each frame holds what has changed since the one before; its time is exact on the average, to hundredths of a second."""

    def __init__(self, path: Path, film: Film, palette: Any) -> None:
        from PIL import GifImagePlugin, Image

        self._plugin, self._image = GifImagePlugin, Image
        self._palette = palette
        self._colours = palette.getpalette()
        self._film = film
        self._count = 0
        self._before: Pixels | None = None
        self._file: IO[bytes] = path.open("wb")

    def write(self, frame: Pixels) -> None:
        none = self._image.Dither.NONE
        indices = np.array(self._image.fromarray(frame).quantize(palette=self._palette, dither=none))
        # Pillow takes a colour that is near: the ground shall be what it is, and still
        indices[(frame == np.array(self._colours[:3], dtype=np.uint8)).all(axis=2)] = 0
        left, top, part = 0, 0, indices
        if self._before is None:
            self._begin(indices)
        else:
            left, top, part = changed_part(self._before, indices)
        rate, number = self._film.rate, self._count
        hundredths = round(100 * (number + 1) / rate) - round(100 * number / rate)
        settings: dict[str, Any] = {"duration": 10 * hundredths, "disposal": 1}
        if self._before is not None:
            settings["transparency"] = TRANSPARENT
        for data in self._plugin.getdata(self._coloured(part), offset=(left, top), **settings):
            self._file.write(data)
        self._before = indices
        self._count += 1

    def _begin(self, indices: Pixels) -> None:
        info: dict[str, Any] = {"optimize": False, "duration": 10}
        if self._film.repeats:
            info["loop"] = 0
        for data in self._plugin.getheader(self._coloured(indices), info=info)[0]:
            self._file.write(data)

    def _coloured(self, indices: Pixels) -> Any:
        image = self._image.fromarray(np.ascontiguousarray(indices))
        image.putpalette(self._colours)
        return image

    def close(self) -> None:
        self._file.write(b";")
        self._file.close()

    def abandon(self) -> None:
        self._file.close()


def changed_part(before: Pixels, now: Pixels) -> tuple[int, int, Pixels]:
    """Left and upper end of the part of a picture (h, w) that has changed, and that part, transparent where nothing has.

    It has one pixel at least: a frame of a GIF is never empty.
    """
    differs = before != now
    rows, columns = np.flatnonzero(differs.any(axis=1)), np.flatnonzero(differs.any(axis=0))
    if not len(rows):
        return 0, 0, now[:1, :1]
    part = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return int(columns[0]), int(rows[0]), np.where(differs[part], now[part], np.uint8(TRANSPARENT))


# ---------------------------------------------------------------------------------------------- MP4


class Mp4Writer:
    """Frames go to ffmpeg through a pipe."""

    def __init__(self, path: Path, film: Film) -> None:
        size = f"{film.width}x{film.height}"
        command = [ffmpeg(), "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
        command += ["-s", size, "-r", f"{film.rate:g}", "-i", "-", "-an"]
        command += ["-c:v", "libx264", "-crf", str(QUALITY), "-pix_fmt", "yuv420p", "-movflags", "+faststart", str(path)]
        self._said = tempfile.TemporaryFile()  # noqa: SIM115  # closed with the writer
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=self._said)

    def write(self, frame: Pixels) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(np.ascontiguousarray(frame).tobytes())
        except OSError:
            raise self._fault() from None

    def close(self) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.close()
            if self._process.wait(WAIT) != 0:
                raise self._fault()
        except (OSError, subprocess.TimeoutExpired):
            raise self._fault() from None
        self._said.close()

    def abandon(self) -> None:
        self._kill()
        self._said.close()

    def _kill(self) -> None:
        self._process.kill()
        self._process.wait()
        with suppress(OSError):  # what was not written yet has nobody to go to
            assert self._process.stdin is not None
            self._process.stdin.close()

    def _fault(self) -> WorkbenchError:
        self._kill()
        self._said.seek(0)
        lines = self._said.read().decode(errors="replace").strip().splitlines()
        words = lines[-1] if lines else "it ended by itself"
        return WorkbenchError(f"ffmpeg could not write the film: {words}. A GIF needs no other program.")
