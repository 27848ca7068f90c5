"""Films: frames that stand still but for the map, files that are read back, nothing half-written."""

from __future__ import annotations

import itertools
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageSequence

from tests.app.fake_engine import grid_mesh, solid_mesh
from workbench.core.errors import WorkbenchError
from workbench.core.solid_look.look import VolumeLook
from workbench.figures import film_file
from workbench.figures.colour_scale import INVERTED
from workbench.figures.film import Film, FilmDrawer, Still
from workbench.figures.film_file import FilmCancelledError, changed_part, ffmpeg, save_film
from workbench.figures.film_shading import _ink
from workbench.figures.mesh_pictures import is_inked
from workbench.figures.recipe import CHEQUERED, PLAIN, TEXTURES, Panel, SolidLook

MESH = grid_mesh(9, 7)
MAPS = [MESH.vertices * [1.0 + 0.1 * k, 1.0] for k in range(5)]
WORDS = [f"iteration {k}" for k in range(5)]
TARGET = Panel("map", colour=PLAIN, caption="Target", edges=True)
COLOURED = Panel("map", colour="symmetric-dirichlet", caption="Colours", bar=True)
SMALL = Film((TARGET, COLOURED), 240, 160, 20.0)


def frames_of(path: Path) -> list[np.ndarray]:
    with Image.open(path) as image:
        return [np.asarray(frame.convert("RGB")).astype(int) for frame in ImageSequence.Iterator(image)]


def stills_of(maps: list[np.ndarray], captions: list[str]) -> list[Still]:
    return [Still(lambda x=x: x, caption) for x, caption in zip(maps, captions, strict=True)]


def seconds_of(path: Path) -> float:
    with Image.open(path) as image:
        return sum(frame.info["duration"] for frame in ImageSequence.Iterator(image)) / 1000


def test_a_gif_has_every_frame_its_size_and_its_time(tmp_path: Path) -> None:
    save_film(tmp_path / "a.gif", SMALL, MESH, stills_of(MAPS, WORDS))
    frames = frames_of(tmp_path / "a.gif")
    assert len(frames) == len(MAPS)
    assert all(frame.shape == (160, 240, 3) for frame in frames)
    assert seconds_of(tmp_path / "a.gif") == pytest.approx(len(MAPS) / 20.0)
    assert np.abs(frames[0] - frames[-1]).max() > 100
    with Image.open(tmp_path / "a.gif") as image:
        assert image.info["loop"] == 0


def test_the_film_is_what_was_drawn(tmp_path: Path) -> None:
    stills = stills_of(MAPS, WORDS)
    save_film(tmp_path / "a.gif", SMALL, MESH, stills)
    drawer = FilmDrawer(SMALL, MESH, stills)
    for frame, still in zip(frames_of(tmp_path / "a.gif"), stills, strict=True):
        assert np.abs(frame - drawer.draw(still)).mean() < 3.0  # a GIF has 256 colours


@pytest.mark.parametrize("rate", [30.0, 24.0, 7.0])
def test_rates_that_no_gif_has_are_kept_on_the_average(tmp_path: Path, rate: float) -> None:
    film = Film((TARGET,), 64, 64, rate)
    save_film(tmp_path / "a.gif", film, MESH, stills_of([MESH.vertices] * 31, [str(k) for k in range(31)]))
    assert seconds_of(tmp_path / "a.gif") == pytest.approx(31 / rate, abs=0.0051)


def test_maps_that_are_alike_are_frames_all_the_same(tmp_path: Path) -> None:
    save_film(tmp_path / "a.gif", Film((TARGET,), 64, 64), MESH, stills_of([MESH.vertices] * 4, [""] * 4))
    frames = frames_of(tmp_path / "a.gif")
    assert len(frames) == 4
    assert all(np.array_equal(frame, frames[0]) for frame in frames)


def test_nothing_flickers(tmp_path: Path) -> None:
    """Titles, colour bars and the ground are the same in all frames, and so is what does not move: each to the last bit."""
    held = [MESH.vertices.copy() for _ in range(5)]
    for k, positions in enumerate(held):
        positions[MESH.vertices[:, 0] > 1.5, 0] += 0.1 * k
    save_film(tmp_path / "a.gif", SMALL, MESH, stills_of(held, [""] * 5))
    frames = frames_of(tmp_path / "a.gif")
    page = FilmDrawer(SMALL, MESH, stills_of(held, [""] * 5)).page
    for box in page.boxes:
        still = np.s_[box.top : box.top + box.height, box.left : box.left + box.width // 3]
        assert len(np.unique(frames[0][still].reshape(-1, 3), axis=0)) > 1, "something is drawn there"
        assert all(np.array_equal(frame[still], frames[0][still]) for frame in frames)
    outside = np.ones((160, 240), bool)
    for box in page.boxes:
        outside[box.top : box.top + box.height, box.left : box.left + box.width] = False
    assert all(np.array_equal(frame[outside], frames[0][outside]) for frame in frames)
    assert np.array_equal(frames[0][0, 0], [255, 255, 255])


def test_a_colour_stands_for_one_value_all_along() -> None:
    """The range is that of all frames: the least distorted frame does not fill the scale by itself."""
    film = Film((COLOURED,), 200, 160, has_captions=False)
    drawer = FilmDrawer(film, MESH, stills_of(MAPS, WORDS))
    box = drawer.page.boxes[0]
    row, column = box.top + box.height // 2, box.left + box.width // 2
    lightness = [int(drawer.draw(still)[row, column].astype(int).sum()) for still in stills_of(MAPS, WORDS)]
    assert all(later < earlier for earlier, later in itertools.pairwise(lightness))


def test_the_picture_holds_all_of_the_motion() -> None:
    film = Film((Panel("map", colour=PLAIN, caption=""),), 160, 120, has_captions=False)
    far = [MESH.vertices, MESH.vertices + [5.0, 3.0]]
    drawer = FilmDrawer(film, MESH, stills_of(far, ["", ""]))
    areas = []
    for still in stills_of(far, ["", ""]):
        frame = drawer.draw(still)
        seen = (frame != 255).any(axis=2)
        assert not (seen[0].any() or seen[-1].any() or seen[:, 0].any() or seen[:, -1].any())
        areas.append(seen.sum())
    assert areas[0] == pytest.approx(areas[1], rel=0.1)
    assert areas[0] > 50


def test_inverted_triangles_are_yellow_above_all_others() -> None:
    folded = MESH.vertices.copy()
    folded[MESH.vertices[:, 0] > 1.4, 0] = 2.8 - folded[MESH.vertices[:, 0] > 1.4, 0]
    yellow = (np.abs(FilmDrawer(Film((COLOURED,), 160, 120), MESH, stills_of([folded], [""])).draw(Still(lambda: folded))
              - np.array(INVERTED) * 255) < 2).all(axis=2)  # fmt: skip
    assert yellow.sum() > 200


def test_solids_textures_and_grounds() -> None:
    solid = solid_mesh((3, 2, 2))
    panels = (Panel("source", colour=CHEQUERED, caption="Source"), Panel("map", colour="det", caption="Determinant"))
    for ground, light in (("white", 255), ("dark", 30), ("light", 240)):
        film = Film(panels, 200, 120, ground=ground)
        still = Still(lambda: solid.vertices * [1.0, 1.2, 1.0], "words", (0, 5))
        frame = FilmDrawer(film, solid, [still]).draw(still).astype(int)
        assert abs(int(frame[0, 0].max()) - light) < 16
        assert len(np.unique(frame.reshape(-1, 3), axis=0)) > 50


@pytest.mark.parametrize("texture", TEXTURES)
def test_textures_are_those_of_figures(texture: str) -> None:
    places = np.random.default_rng(2).uniform(-4, 4, (3000, 3))
    for columns in (2, 3):
        ours = [_ink(place, TEXTURES.index(texture)) for place in places[:, :columns]]
        assert np.array_equal(np.array(ours, dtype=bool), is_inked(places[:, :columns], texture))
        assert 0.05 < np.mean(ours) < 0.95


def test_a_solid_is_looked_into_as_the_panel_says() -> None:
    solid = solid_mesh((4, 2, 2))
    panel = Panel("map", colour="det", caption="")
    cut = SolidLook(VolumeLook(only_marked=True, ghost=0.0), marked=tuple(range(6)))
    still = Still(lambda: solid.vertices)
    seen = []
    for look in (None, cut):
        frame = FilmDrawer(Film((replace(panel, look=look),), 160, 120), solid, [still]).draw(still)
        seen.append((frame != 255).any(axis=2).sum())
    assert 0 < seen[1] < 0.6 * seen[0]


def test_what_is_gone_of_a_solid_leaves_a_veil() -> None:
    """Also where all of it is peeled off, as before anything moves: such a frame is not empty."""
    solid = solid_mesh((4, 2, 2))
    still = Still(lambda: solid.vertices)
    seen = []
    for ghost in (0.0, 0.3):
        look = SolidLook(VolumeLook(threshold=7.0, ghost=ghost))
        panel = Panel("map", colour="det", caption="", look=look)
        frame = FilmDrawer(Film((panel,), 160, 120), solid, [still]).draw(still)
        seen.append((frame < 250).any(axis=2))
    whole = FilmDrawer(Film((replace(panel, look=None),), 160, 120), solid, [still]).draw(still)
    assert not seen[0].any()
    assert abs(int(seen[1].sum()) - int((whole < 250).any(axis=2).sum())) < 60, "the veil covers what the solid did"


@pytest.mark.skipif(not ffmpeg(), reason="there is no ffmpeg here")
def test_an_mp4_is_read_back(tmp_path: Path) -> None:
    save_film(tmp_path / "a.mp4", SMALL, MESH, stills_of(MAPS, WORDS))
    command = [ffmpeg(), "-loglevel", "error", "-i", str(tmp_path / "a.mp4"), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    raw = subprocess.run(command, capture_output=True, check=True).stdout
    frames = np.frombuffer(raw, np.uint8).reshape(-1, 160, 240, 3).astype(int)
    assert len(frames) == len(MAPS)
    drawer = FilmDrawer(SMALL, MESH, stills_of(MAPS, WORDS))
    for frame, still in zip(frames, stills_of(MAPS, WORDS), strict=True):
        assert np.abs(frame - drawer.draw(still)).mean() < 6.0
    assert np.abs(frames[0] - frames[-1]).max() > 100


def test_what_is_cancelled_leaves_nothing_and_harms_nothing(tmp_path: Path) -> None:
    path = tmp_path / "a.gif"
    path.write_bytes(b"what was there")
    done: list[float] = []
    with pytest.raises(FilmCancelledError):
        save_film(path, SMALL, MESH, stills_of(MAPS, WORDS), done.append, lambda: len(done) >= 2)
    assert done[-1] == pytest.approx(2 / 5)
    assert path.read_bytes() == b"what was there"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("film", "name"),
    [
        (Film((), 64, 64), "a.gif"),
        (Film((TARGET,), 65, 64), "a.gif"),
        (Film((TARGET,), 64, 10_000), "a.gif"),
        (Film((TARGET,), 64, 64, 0.0), "a.gif"),
        (Film((TARGET,), 64, 64, ground="pink"), "a.gif"),
        (Film((TARGET,), 64, 64), "a.avi"),
        (Film((TARGET,), 64, 64), "none/a.gif"),
        (Film((Panel("map", colour="no-such-measure"),), 64, 64), "a.gif"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(tmp_path: Path, film: Film, name: str) -> None:
    with pytest.raises(WorkbenchError) as refused:
        save_film(tmp_path / name, film, MESH, stills_of(MAPS[:1], WORDS[:1]))
    assert len(refused.value.sentence) > 20
    assert not list(tmp_path.iterdir())


def test_without_ffmpeg_it_is_said_how_to_get_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(film_file, "ffmpeg", lambda: "")
    with pytest.raises(WorkbenchError, match=r"\[film\]"):
        save_film(tmp_path / "a.mp4", SMALL, MESH, stills_of(MAPS, WORDS))


def test_a_program_that_fails_is_told_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "ffmpeg"
    program.write_text("#!/bin/sh\necho 'Unknown encoder libx264' >&2\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setattr(film_file, "ffmpeg", lambda: str(program))
    with pytest.raises(WorkbenchError, match="Unknown encoder"):
        save_film(tmp_path / "a.mp4", SMALL, MESH, stills_of(MAPS * 20, WORDS * 20))
    assert list(tmp_path.iterdir()) == [program]


def test_only_what_changed_is_written() -> None:
    before = np.zeros((6, 8), np.uint8)
    now = before.copy()
    now[2, 3], now[4, 6] = 7, 9
    left, top, part = changed_part(before, now)
    whole = before.copy()
    inside = whole[top : top + part.shape[0], left : left + part.shape[1]]
    inside[part != film_file.TRANSPARENT] = part[part != film_file.TRANSPARENT]
    assert np.array_equal(whole, now)
    assert part.shape == (3, 4)
