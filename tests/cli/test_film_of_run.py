"""`solve --film`: the maps of a run as frames, and what is refused before anything is solved."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from workbench.cli import main
from workbench.cli.filming import Filming
from workbench.figures import film_file


def test_every_map_of_a_run_is_a_frame(tmp_path: Path) -> None:
    history, film = tmp_path / "history.csv", tmp_path / "map.gif"
    options = ["--iterations", "4", "--quiet", "--history", str(history), "--film", str(film)]
    assert main(["solve", "sample:bumpy-disc", "--out", str(tmp_path / "map.obj"), *options]) == 0
    with Image.open(film) as image:
        assert image.n_frames == len(history.read_text().splitlines()) - 1
        first = np.asarray(image.convert("RGB")).astype(int)
        image.seek(image.n_frames - 1)
        assert np.abs(np.asarray(image.convert("RGB")).astype(int) - first).max() > 60


@pytest.mark.parametrize("name", ["map.avi", "none/map.gif", "map.obj"])
def test_films_that_cannot_be_are_refused_first(tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    film = str(tmp_path / name)
    assert main(["solve", "sample:bumpy-disc", "--out", str(tmp_path / "map.obj"), "--quiet", "--film", film]) == 2
    assert len(capsys.readouterr().err) > 30
    assert not list(tmp_path.iterdir())


def test_a_film_that_fails_costs_nothing_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "ffmpeg"
    program.write_text("#!/bin/sh\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setattr(film_file, "ffmpeg", lambda: str(program))
    out, film = tmp_path / "map.obj", tmp_path / "map.mp4"
    assert main(["solve", "sample:bumpy-disc", "--out", str(out), "--iterations", "1", "--quiet", "--film", str(film)]) == 1
    assert out.is_file()
    assert not film.exists()


def test_of_a_long_run_maps_stay_evenly(monkeypatch: pytest.MonkeyPatch) -> None:
    class State:
        energy = 1.0

        def __init__(self, iteration: int) -> None:
            self.iteration, self.positions = iteration, np.zeros((3, 2))

    monkeypatch.setattr("workbench.cli.filming.MOST", 10)
    filming = Filming("a.gif", None)  # type: ignore[arg-type]
    for iteration in range(101):
        filming.take(State(iteration))  # type: ignore[arg-type]
    kept = [item.iteration for item in filming._kept]
    assert len(set(np.diff(kept))) == 1
    assert 5 < len(kept) <= 10
    assert kept[0] == 0
    assert filming._last is not None
    assert filming._last.iteration == 100
