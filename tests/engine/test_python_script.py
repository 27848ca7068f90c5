"""A session as a Python script: it leads to the same energy, and nothing in the session becomes code."""

from __future__ import annotations

import ast
import math
import runpy
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.core.method import Parameter
from workbench.core.named_formulas import NamedFormula
from workbench.engine.python_script import MOST_INLINE, literal, write_script
from workbench.engine.replay import replay
from workbench.engine.session_file import source_digest
from workbench.io.formula_store import delete_formula, save_formula
from workbench.io.opening import open_source
from workbench.session.journal import Leg
from workbench.session.record import SessionRecord
from workbench.session.session import Session

CORNERS = {
    "anchor_vertices": (0, 48),
    "anchor_targets": ((0.1, -0.2), (1.4, 1.1)),
    "anchor_weights": (math.inf, 30.0),
    "anchor_groups": (-1, -1),
}
NAUGHTY = "it's \"quoted\"\n__import__('os').remove('x')  # \\"


@pytest.fixture
def case(square: Mesh, tmp_path: Path) -> str:
    """A square with a bent start, in a file whose name is no code."""
    bent = square.vertices + 0.05 * np.sin(7 * square.vertices[:, ::-1])
    path = tmp_path / f"{NAUGHTY.replace(chr(10), ';')}.npz"
    with path.open("wb") as stream:
        np.savez(stream, V=square.vertices, S=square.simplices, X0=bent)
    return str(path)


def recorded(record: SessionRecord) -> SessionRecord:
    """The session with the map and the energy that it leads to."""
    session = record.session
    state = replay(record, open_source(session.source, kind=session.kind, fixes=session.fixes)).result.state
    return replace(record, energy=state.energy, sha256=source_digest(session.source))


def story(source: str) -> SessionRecord:
    """Three solvers, a formula with a parameter, hard and soft anchors, a pinned boundary and an equation."""
    formula = Session(source, distortion="lam*mips + (1 - lam)*symmetric_dirichlet", distortion_parameters={"lam": 0.25})
    first = replace(formula, solver="slim", solver_parameters={"safety": 0.6})
    held = replace(formula, solver="l-bfgs", **CORNERS)
    pinned = replace(held, solver="projected-newton", distortion="arap", distortion_parameters={}, fixed_boundary=True)
    bound = replace(pinned, fixed_boundary=False, linear_equations=("1.0*x[24] - 1.0*x[25] = -0.1",))
    legs = [Leg(first, "start", None, 2), Leg(held, "previous", None, 7), Leg(pinned, "previous", None, 2)]
    return recorded(SessionRecord(bound, legs=(*legs, Leg(bound, "previous", None, 3))))


def run_script(path: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, path], cwd="/", capture_output=True, text=True, timeout=120, check=False)


def complaint(path: Path) -> str:
    """What a script has to complain of, run in this process."""
    try:
        runpy.run_path(str(path))
    except SystemExit as error:
        return str(error.code)
    return ""


def written(record: SessionRecord, folder: Path) -> Path:
    session, path = record.session, folder / "again.py"
    write_script(path, record, open_source(session.source, kind=session.kind, fixes=session.fixes))
    return path


def test_the_script_leads_to_the_same_energy(case: str, tmp_path: Path) -> None:
    record = story(case)
    path = written(record, tmp_path)
    told = run_script(path)
    assert told.returncode == 0, told.stderr
    assert f"14 iterations, energy {record.energy:.15g}" in told.stdout
    assert [item.suffix for item in sorted(tmp_path.iterdir())] == [".py", ".npz"], "the script, and the mesh that was there"
    path.write_text(path.read_text().replace(f"RECORDED = {record.energy!r}", f"RECORDED = {record.energy * (1 + 1e-9)!r}"))
    assert "not the one that was recorded" in complaint(path)


def test_maps_and_many_anchors_stand_in_a_file_beside_it(square: Mesh, case: str, tmp_path: Path) -> None:
    vertices = tuple(range(MOST_INLINE + 1))
    targets = tuple(map(tuple, (1.1 * square.vertices[: len(vertices)]).tolist()))
    session = Session(case, solver="projected-newton", anchor_vertices=vertices, anchor_targets=targets)
    turned = square.vertices * [1.2, 0.8]
    path = written(recorded(SessionRecord(session, legs=(Leg(session, "map", turned, 5),))), tmp_path)
    assert "[1.2" not in path.read_text()
    with np.load(path.with_name("again-arrays.npz")) as arrays:
        np.testing.assert_array_equal(arrays["leg_1"], turned)
        assert arrays["anchors_1_vertices"].tolist() == list(vertices)
    assert not complaint(path)


@pytest.mark.parametrize(
    "session",
    [
        Session("sample:bumpy-disc", solver="fast", distortion="symmetric-dirichlet", iterations=20),
        Session("sample:bumpy-disc", initializer="lscm", match_area=False, solver="aqp", iterations=5),
    ],
    ids=["fast", "lscm"],
)
def test_a_session_without_a_story_is_solved_from_its_start(session: Session, tmp_path: Path) -> None:
    assert not complaint(written(recorded(SessionRecord(session)), tmp_path))


def test_a_map_of_a_hand_is_measured(square: Mesh, case: str, tmp_path: Path) -> None:
    record = recorded(SessionRecord(Session(case, distortion="dirichlet"), map=square.vertices * [1.5, 0.8]))
    assert record.energy == pytest.approx(1.5**2 + 0.8**2)
    assert not complaint(written(record, tmp_path))


def test_a_formula_of_the_users_own_stands_in_the_script(case: str, tmp_path: Path) -> None:
    blend = NamedFormula("Of a script", "lam*mips + (1 - lam)*arap", (Parameter("lam", float, 0.25, "", 0.0, 1.0),))
    id = save_formula(blend)
    try:
        path = written(recorded(SessionRecord(Session(case, distortion=id, solver="slim", iterations=4))), tmp_path)
    finally:
        delete_formula(id)
    assert id not in path.read_text()
    assert not complaint(path)


def test_a_script_never_writes_over_its_mesh(square: Mesh, tmp_path: Path) -> None:
    mesh = tmp_path / "again-arrays.npz"
    np.savez(mesh, V=square.vertices, S=square.simplices)
    before = mesh.read_bytes()
    with pytest.raises(WorkbenchError, match="another name"):
        written(SessionRecord(Session(str(mesh)), map=square.vertices), tmp_path)
    assert mesh.read_bytes() == before and not (tmp_path / "again.py").exists()


def test_another_mesh_is_told(case: str, tmp_path: Path) -> None:
    assert "another than when" in complaint(written(replace(story(case), sha256="0" * 64), tmp_path))


def test_texts_of_a_session_are_literals(case: str, tmp_path: Path) -> None:
    """Every string of the session is a string in the script, and calls are of the few names that belong there."""
    tree = ast.parse(written(story(case), tmp_path).read_text())
    strings = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    assert Path(case).name in strings
    called = {ast.unparse(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    known = {
        "Anchors",
        "Anchors.none",
        "Distortion.resolve",
        "Path",
        "Path(__file__).resolve",
        "SystemExit",
        "abs",
        "float",
        "load",
        "max",
    }
    assert called <= known | {"np.array", "np.load", "print", "result.problem.inverted", "solve", "solver"}


@pytest.mark.parametrize(
    "value", [NAUGHTY, "\ud800\u2028", -0.0, 1e-320, True, None, (1,), (), [NAUGHTY], {NAUGHTY: [1.5, (2,)]}]
)
def test_a_literal_is_the_value(value: object) -> None:
    text = literal(value)
    assert ast.literal_eval(text) == value
    assert text.isprintable()


def test_infinity_is_a_literal_and_an_object_is_none() -> None:
    assert literal(-math.inf) == "float('-inf')"
    assert literal(np.float64(0.1)) == "0.1"
    with pytest.raises(TypeError):
        literal(object())
