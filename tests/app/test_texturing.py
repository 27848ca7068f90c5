"""Patterns and pictures on the views: laid out in the map or in the source, refused with a sentence, there again."""

from __future__ import annotations

import json
import struct
import zlib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QColor, QDropEvent, QImage
from pytestqt.qtbot import QtBot

from tests.app.conftest import WindowMaker, pixels_of
from tests.app.fake_engine import bumpy_mesh, grid_mesh
from workbench.app.document.first_start import why_not_own_start, with_own_start
from workbench.app.main_window import MainWindow
from workbench.app.settings import Settings
from workbench.app.texturing.texturing import Texturing
from workbench.app.views.geometry import Geometry
from workbench.app.views.textures import PATTERNS, TILE, Texture, pattern_image
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh, TextureCoordinates
from workbench.engine.messages import Loaded
from workbench.io.picture import KEPT_SIDE, read_picture
from workbench.session.session import Session


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    """Left half red, right half green; twice as wide as high."""
    image = QImage(80, 40, QImage.Format.Format_RGB32)
    image.fill(QColor("red"))
    for x in range(40, 80):
        for y in range(40):
            image.setPixelColor(x, y, QColor(0, 200, 0))
    image.save(str(tmp_path / "flag.png"))
    return tmp_path / "flag.png"


@pytest.fixture
def usual(window: MainWindow):
    yield window
    window.texturing.choose(size=1.0, degrees=0.0, of_source=False, of_unit=False)
    window.set_source_style("checkerboard")
    window.set_target_style("plain")


def share(pixels: np.ndarray, colour: tuple[int, int, int]) -> float:
    """Part of the pixels that are about of a colour."""
    return float((np.abs(pixels - colour).max(axis=-1) < 40).mean())


def test_every_pattern_is_two_colours_that_meet_at_its_sides() -> None:
    for pattern in PATTERNS[:4]:
        for dark in (False, True):
            tile = pattern_image(pattern, dark).astype(int)
            assert tile.shape == (TILE, TILE, 3)
            assert 0.05 < (tile == tile.reshape(-1, 3).min(axis=0)).all(axis=2).mean() < 0.95
    rings = pattern_image("circles", False)
    assert (rings[0] == rings[0, 0]).all() and (rings == rings.transpose(1, 0, 2)).all()


def test_tiles_are_turned_and_sized_as_they_are_asked_to_be() -> None:
    points = np.array([[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]], np.float32)
    usual = Texture("grid").coordinates(points)
    turned = Texture("grid", size=2.0, degrees=90.0).coordinates(points)
    np.testing.assert_allclose(
        np.linalg.norm(turned - turned[0], axis=1), 0.5 * np.linalg.norm(usual - usual[0], axis=1), rtol=1e-5
    )
    # what is turned counter-clockwise is met in y by what was met in x
    np.testing.assert_allclose(2.0 * turned[2], usual[1], atol=1e-5)
    wide = Texture("picture", picture=np.zeros((40, 80, 3), np.uint8))
    np.testing.assert_allclose(wide.coordinates(points)[0], 0.5)
    np.testing.assert_allclose(np.diff(wide.coordinates(points), axis=0)[0], [0.1, 0.0], atol=1e-6)
    np.testing.assert_allclose(wide.coordinates(points)[2] - 0.5, [0.0, 0.2], atol=1e-6)


def test_a_dropped_picture_lies_on_the_view_below_the_mouse(usual: MainWindow, qtbot: QtBot, picture: Path) -> None:
    window = usual
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(picture))])
    target = window.target.view
    place = target.mapTo(window, QPoint(target.width() // 2, target.height() // 2))
    buttons, keys = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    window.dropEvent(QDropEvent(QPointF(place), Qt.DropAction.CopyAction, data, buttons, keys))
    assert window.colouring.style_of(window.target) == "picture"
    assert window.colouring.style_of(window.source) == "checkerboard"
    qtbot.wait(60)
    left, right = np.array_split(pixels_of(target), 2, axis=1)
    assert share(left, (255, 0, 0)) > 0.1 and share(right, (0, 200, 0)) > 0.1, "the picture is upright and not mirrored"
    assert share(left, (0, 200, 0)) < 0.05 and share(right, (255, 0, 0)) < 0.05
    window.texturing.choose(degrees=180.0)
    qtbot.wait(60)
    assert share(np.array_split(pixels_of(target), 2, axis=1)[0], (0, 200, 0)) > 0.1


def test_a_pattern_that_is_even_in_the_source_goes_with_the_map(usual: MainWindow, qtbot: QtBot) -> None:
    window = usual
    window.set_target_style("stripes")
    window.document.pin(np.array([0, 272]))
    window.document.move_anchor(272, window.document.mesh.vertices[272] + [0.3, 0.4], False)
    qtbot.waitUntil(lambda: np.abs(window.document.positions[272] - window.document.mesh.vertices[272]).min() > 0.2)
    source, target = (pane.view for pane in (window.source, window.target))
    for of_source, even in ((False, target), (True, source)):
        window.texturing.choose(of_source=of_source)
        # a place and its image carry the same mark
        qtbot.waitUntil(lambda: np.array_equal(source.surface._texture_points, target.surface._texture_points))
        laid = np.diff(target.surface._texture_points, axis=0)
        steps = np.diff(even.geometry_shown.points[:, :2], axis=0)
        factor = laid[0, 0] / steps[0, 0]
        np.testing.assert_allclose(laid, factor * steps, atol=1e-3)


def test_a_picture_may_lie_on_the_unit_square_of_u_and_v(usual: MainWindow, qtbot: QtBot, picture: Path) -> None:
    window = usual
    window.texturing.take_picture(str(picture))
    window.texturing.choose(of_unit=True)
    window.set_source_style("picture")
    source = window.source.view.surface

    def follows() -> bool:
        return np.allclose(source._texture_points, window.document.positions, atol=1e-4)

    qtbot.waitUntil(follows)
    window.document.pin(np.array([0, 272]))
    window.document.move_anchor(272, window.document.mesh.vertices[272] + [0.3, 0.4], False)
    qtbot.waitUntil(lambda: np.abs(window.document.positions[272] - window.document.mesh.vertices[272]).min() > 0.2)
    qtbot.waitUntil(follows)
    window.texturing.choose(of_unit=False)
    assert not follows()


def test_a_pattern_is_fitted_to_another_mesh_anew_and_does_not_swim_in_one() -> None:
    mesh = grid_mesh()
    views = SimpleNamespace(geometry_shown=None)
    texturing = Texturing(views, views)  # type: ignore[arg-type]

    def middle() -> np.ndarray:
        places = texturing.texture("checkerboard").points()
        return 0.5 * (places.min(axis=0) + places.max(axis=0))

    for place in (0.0, 3.0, -7.0):
        views.geometry_shown = Geometry(mesh.vertices + place, mesh.simplices)
        views.geometry_shown.points[:, 0] += 0.3 + 0.1 * place  # somebody had moved it before it had a pattern
        np.testing.assert_allclose(middle(), 0.0, atol=1e-5)
        views.geometry_shown.points[:, :2] += [0.1, 0.4]
        np.testing.assert_allclose(middle()[:2], [0.1, 0.4], atol=1e-5)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "no PNG"),
        (b"GIF89a" + bytes(40), "no PNG"),
        (b"\x89PNG\r\n\x1a\n" + bytes(200), "cannot be read"),
        (None, "choose another"),
    ],
)
def test_what_is_no_picture_is_refused_with_a_sentence(
    usual: MainWindow, tmp_path: Path, content: bytes | None, words: str
) -> None:
    path = tmp_path / "broken.png"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(WorkbenchError, match=words):
        read_picture(str(path))
    before = usual.texturing.layout
    usual.open(str(path))
    assert usual.error_bar.isVisible() and usual.texturing.layout == before


def test_large_pictures_are_made_smaller_and_bombs_are_refused(tmp_path: Path) -> None:
    QImage(KEPT_SIDE + 952, 30, QImage.Format.Format_RGB32).save(str(tmp_path / "wide.png"))
    assert read_picture(str(tmp_path / "wide.png")).shape[1] == KEPT_SIDE

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", 10**6, 10**6, 8, 2, 0, 0, 0)
    bomb = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(1000))) + chunk(b"IEND", b"")
    (tmp_path / "bomb.png").write_bytes(bomb)
    with pytest.raises(WorkbenchError, match="a side are the most"):
        read_picture(str(tmp_path / "bomb.png"))


def test_layout_and_picture_are_there_again(make_window: WindowMaker, tmp_path: Path, picture: Path) -> None:
    settings = Settings(tmp_path / "window.ini")
    kept = {"size": 2.0, "degrees": 30.0, "of_source": True, "of_unit": True, "picture": str(picture)}
    settings._store.setValue("views", json.dumps({"pattern": kept, "views": {"source": "picture"}}))
    settings.sync()
    window = make_window()
    assert window.texturing.has_picture and window.colouring.style_of(window.source) == "picture"
    assert window.texturing.kept() == kept
    window.texturing.take_kept(
        {"size": "huge", "degrees": 1e9, "of_source": 1, "of_unit": "yes", "picture": str(tmp_path / "gone.png")}
    )
    assert window.texturing.kept() == {"picture": str(picture)}, "nothing but what is unusual, and can be"


NO_EDGES = np.empty((0, 2), np.int64)


def test_a_surface_begins_with_the_map_of_its_file() -> None:
    mesh, flat = bumpy_mesh(), grid_mesh().vertices

    def begun(texture: TextureCoordinates | None, kind: str = "parameterize", source: str = "mesh.obj") -> Session:
        with_texture = Mesh(mesh.vertices, mesh.simplices, texture=texture)
        loaded = Loaded(1, with_texture, kind, (), np.empty((0, 2), np.int64), source)  # type: ignore[arg-type]
        return with_own_start(loaded, Session(source=source))

    whole = TextureCoordinates(flat, mesh.simplices)
    assert (begun(whole).initializer, begun(whole).start_file) == ("file", "mesh.obj")
    assert begun(whole, source="sample:bumpy-disc").initializer == ""
    assert begun(None).initializer == ""
    assert begun(TextureCoordinates(0.0 * flat, mesh.simplices)).initializer == "", "a map without area is none"
    folded = flat.copy()
    folded[22] += [1.5, 0.0]  # an inner vertex beyond its neighbours
    assert begun(TextureCoordinates(folded, mesh.simplices)).initializer == "", "no solver goes on from that"
    told = Loaded(1, replace(mesh, texture=TextureCoordinates(folded, mesh.simplices)), "parameterize", (), NO_EDGES, "m.obj")
    assert "triangles over" in why_not_own_start(told, Session(source="m.obj"))
    assert why_not_own_start(told, Session(source="m.obj", initializer="tutte")) == "", "somebody chose another one"
    told = Loaded(1, replace(mesh, texture=whole), "parameterize", (), NO_EDGES, "m.obj")
    assert why_not_own_start(told, Session(source="m.obj")) == ""
    assert begun(TextureCoordinates(flat * [1, -1], mesh.simplices)).initializer == "file", "face down throughout"
    seam = np.array(mesh.simplices)
    seam[0, 0] = len(flat)
    torn = TextureCoordinates(np.vstack([flat, [[9.0, 9.0]]]), seam)
    assert begun(torn).initializer == "", "a seam that the source has not"


def test_a_solid_has_its_pattern_through_and_through(solid_window: MainWindow, qtbot: QtBot) -> None:
    window, view = solid_window, solid_window.source.view
    for side in range(3):
        axes = np.roll(np.eye(3), side, axis=0)
        view.turn(replace(view.camera, axes=axes))
        tones = {}
        for style in ("checkerboard", "plain"):
            window.set_source_style(style)
            qtbot.wait(40)
            middle = pixels_of(view)[view.height() // 2, view.width() // 4 : -view.width() // 4]
            tones[style] = middle.mean(axis=1)
        # edges of triangles are fainter than the fields of a board, which change along every side
        assert np.ptp(np.quantile(tones["checkerboard"], (0.2, 0.8))) > 40, f"side {side}"
        assert np.ptp(np.quantile(tones["plain"], (0.2, 0.8))) < 20, f"side {side}"
    window.set_source_style("checkerboard")


def test_the_button_of_the_start_says_whose_map_it_is(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    document, button = window.document, window.panel.file_button
    source = document.session.source
    long = str(tmp_path / f"{60 * 'long'}.obj")
    for start, words in ((source, "UVs of the mesh"), ("/there/other.obj", "other.obj"), (long, "long"), ("", "Choose")):
        document.choose(initializer="file", start_file=start)
        window.panel.show_session()
        assert words in button.text() and button.isVisibleTo(window.panel)
        assert button.sizeHint().width() < 260 and start in button.toolTip()
    document.choose(initializer="", start_file="")
    assert not button.isVisibleTo(window.panel)
