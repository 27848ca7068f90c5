"""What `workbench.api` gives a notebook: opening, solving, measuring, writing, without the command line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from workbench import api
from workbench.core.mesh import Mesh


def test_a_solid_is_opened_solved_measured_and_written(tmp_path: Path, cube: Mesh) -> None:
    np.savez(tmp_path / "cube.npz", V=cube.vertices, S=cube.simplices)
    opened = api.open_source(str(tmp_path / "cube.npz"))
    assert opened.kind == "volume"
    held = np.array([0, 2, 24])
    targets = opened.mesh.vertices[held] * [1.5, 1.0, 1.2]
    problem = api.Problem.create(opened.mesh, "volume", api.Distortion.resolve("arap-barrier"), api.Anchors(held, targets))
    result = api.run(api.solver("slim", safety=0.9), problem, opened.mesh.vertices, iterations=50)
    positions = result.state.positions
    assert result.state.status.name in repr(result) and len(repr(result)) < 200, "a notebook shows it as a line"
    np.testing.assert_allclose(positions[held], targets, atol=1e-9)
    measured = api.measure_map(opened.mesh, positions)
    assert measured["inverted"] == 0
    assert api.local_injectivity(opened.mesh, positions).holds
    assert api.global_injectivity(opened.mesh, positions).holds
    volumes = api.simplex_table(opened.mesh, positions)["source_volume"]
    arap = api.simplex_table(opened.mesh, positions)["arap"]
    assert arap @ volumes == pytest.approx(result.state.energy, rel=1e-12)
    for ending in ("vtu", "msh", "npz"):
        api.write_map(str(tmp_path / f"map.{ending}"), opened.mesh, positions, "volume")
        np.testing.assert_array_equal(api.map_from_file(str(tmp_path / f"map.{ending}"), cube, "volume"), positions)


def test_what_there_is_not_is_refused_with_a_sentence() -> None:
    with pytest.raises(api.WorkbenchError, match="no-such-solver"):
        api.solver("no-such-solver")
    with pytest.raises(api.WorkbenchError, match="speed"):
        api.solver("slim", speed=3)


def test_a_formula_is_analysed_in_both_dimensions() -> None:
    mips = api.Distortion.resolve("mips")
    assert api.analyse(mips, 2).symmetric.holds is True
    assert api.analyse(mips, 3).symmetric.holds is False


def test_every_name_that_is_offered_is_there() -> None:
    assert len(set(api.__all__)) == len(api.__all__)
    assert all(hasattr(api, name) for name in api.__all__)
