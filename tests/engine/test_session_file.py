"""Session files: what was written is read, and whatever is amiss is refused with a sentence and touches nothing."""

from __future__ import annotations

import io
import json
import math
import os
import pickle
import sys
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image

from workbench.core.errors import WorkbenchError
from workbench.core.method import Parameter
from workbench.core.named_formulas import NamedFormula
from workbench.engine import session_file
from workbench.engine.session_file import (
    carries_session,
    picture_with_session,
    read_session,
    source_trouble,
    write_session,
)
from workbench.io.formula_store import delete_formula, save_formula
from workbench.io.png_content import with_content
from workbench.session.journal import Leg
from workbench.session.record import SessionRecord
from workbench.session.session import Session
from workbench.session.text import FORMAT, VERSION, part_count

HEAD = {"format": FORMAT, "version": VERSION, "source": {"path": "sample:bar"}}
FINITE = st.floats(-1e9, 1e9)
PARAMETERS = st.dictionaries(st.text("abc", min_size=1, max_size=3), FINITE, max_size=3)


@st.composite
def records(draw: st.DrawFn) -> SessionRecord:
    vertices = draw(st.lists(st.integers(0, 10**6), unique=True, max_size=5))
    count = len(vertices)

    def each(values: st.SearchStrategy) -> tuple:
        return tuple(draw(st.lists(values, min_size=count, max_size=count)))

    session = Session(
        source=draw(st.sampled_from(["sample:bar", "sample:cube"])),
        kind=draw(st.sampled_from(["auto", "plane", "volume"])),
        fixes=draw(st.sampled_from([(), ("cut",), ("seams", "cut")])),
        distortion=draw(st.text("abc +*^", min_size=1, max_size=20)),
        distortion_parameters=draw(PARAMETERS),
        solver_parameters=draw(st.dictionaries(st.sampled_from(["a", "b"]), st.one_of(FINITE, st.booleans(), st.text("xy")))),
        fixed_boundary=draw(st.booleans()),
        anchor_vertices=tuple(vertices),
        anchor_targets=each(st.tuples(FINITE, FINITE)),
        anchor_weights=each(st.one_of(st.just(math.inf), st.floats(0.001, 1e6))),
        anchor_groups=each(st.integers(-1, 5)),
        anchors_off=frozenset(draw(st.lists(st.sampled_from(vertices)))) if vertices else frozenset(),
        iterations=draw(st.integers(0, 10**6)),
        time_limit=draw(st.one_of(st.just(math.inf), st.floats(0, 1e6))),
    )
    positions = draw(st.one_of(st.none(), st.just(np.arange(10.0).reshape(5, 2) / 7)))
    first = Leg(
        replace(
            session.in_force, solver="slim", anchor_vertices=(), anchor_targets=(), anchor_weights=(), anchor_groups=(),
            linear_equations=draw(st.sampled_from([(), ("x[1] = 0.5",)])), tolerance=draw(st.sampled_from([1e-6, 1e-9])),
            fixed_boundary=draw(st.booleans()), allow_inversions=draw(st.booleans()), distortion_parameters=draw(PARAMETERS),
        ), "start"
    )  # fmt: skip
    legs = (replace(first, iterations=3), Leg(session.in_force, "previous", None, 7)) if draw(st.booleans()) else ()
    return SessionRecord(session, draw(st.sampled_from(["", "0" * 64])), positions, legs, draw(st.one_of(st.none(), FINITE)))


@pytest.mark.skipif(os.name != "posix" or sys.platform == "darwin", reason="names of files are text there")
def test_the_name_of_a_mesh_need_not_be_text(tmp_path: Path) -> None:
    mesh = tmp_path / os.fsdecode(b"a\xff.obj")
    mesh.write_text("v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n")
    for name in ("s.dwb", "s.json"):
        write_session(tmp_path / name, SessionRecord(Session(source=str(mesh))))
        assert read_session(tmp_path / name).session.source == str(mesh)
    with pytest.raises(WorkbenchError, match="distortion"):
        (tmp_path / "s.json").write_text(json.dumps(HEAD | {"distortion": "sum(sigma\ud800)"}))
        read_session(tmp_path / "s.json")


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(records())
def test_what_is_written_is_read(tmp_path: Path, record: SessionRecord) -> None:
    path = tmp_path / "s.dwb"
    write_session(path, record)
    found = read_session(path)
    assert found.session == record.session
    assert (found.sha256, found.energy) == (record.sha256, record.energy)
    assert [(leg.choices, leg.origin, leg.iterations) for leg in found.legs] == [
        (leg.choices, leg.origin, leg.iterations) for leg in record.legs
    ]
    if record.map is None:
        assert found.map is None
    else:
        np.testing.assert_array_equal(found.map, record.map)
    first = path.read_bytes()
    write_session(path, found)
    assert path.read_bytes() == first


def test_a_formula_of_the_users_own_goes_along_and_is_called_by_its_name_where_it_has_one(tmp_path: Path) -> None:
    blend = NamedFormula("Of a session", "lam*mips + (1 - lam)*arap", (Parameter("lam", float, 0.25, "", 0.0, 1.0),))
    id = save_formula(blend)
    path = tmp_path / "s.json"
    try:
        session = Session(source="sample:bar", distortion=id, distortion_parameters={"lam": 0.5})
        write_session(path, SessionRecord(session, legs=(Leg(session, "start", None, 3),)))
        at_home = read_session(path)
        assert at_home.session == session and at_home.legs[0].choices.distortion == id
    finally:
        delete_formula(id)
    elsewhere = read_session(path).session
    assert (elsewhere.distortion, elsewhere.distortion_parameters) == (blend.formula, {"lam": 0.5})


def test_only_what_differs_from_the_defaults_is_written(tmp_path: Path) -> None:
    write_session(tmp_path / "s.json", SessionRecord(Session(source="sample:bar", solver="slim")))
    assert json.loads((tmp_path / "s.json").read_text()) == {**HEAD, "solver": "slim"}


def test_a_way_too_long_to_be_read_is_left_out_and_the_map_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    count = 40
    held = {"anchor_vertices": tuple(range(count)), "anchor_weights": (math.inf,) * count, "anchor_groups": (-1,) * count}
    sessions = [Session(source="sample:bar", anchor_targets=((x, 0.0),) * count, **held) for x in (1.0, 2.0, 3.0)]
    legs = tuple(Leg(session, "previous" if i else "start", None, 5) for i, session in enumerate(sessions))
    record = SessionRecord(sessions[-1], map=np.ones((5, 2)), legs=legs, energy=4.0)
    monkeypatch.setattr("workbench.session.text.MOST_PARTS", 4 * count)
    monkeypatch.setattr(session_file, "MOST_PARTS", 4 * count)
    write_session(tmp_path / "s.dwb", record)
    found = read_session(tmp_path / "s.dwb")
    assert found.session == record.session and not found.legs and found.energy == 4.0
    np.testing.assert_array_equal(found.map, record.map)


def test_the_mesh_is_named_relative_to_the_session_and_known_by_its_bytes(tmp_path: Path) -> None:
    mesh = tmp_path / "meshes" / "m.obj"
    mesh.parent.mkdir()
    mesh.write_text("v 0 0 0\n")
    (tmp_path / "a").mkdir()
    from workbench.engine.session_file import source_digest

    record = SessionRecord(Session(source=str(mesh)), source_digest(str(mesh)))
    write_session(tmp_path / "a" / "s.json", record)
    assert json.loads((tmp_path / "a" / "s.json").read_text())["source"]["path"] == "../meshes/m.obj"
    moved = tmp_path / "elsewhere"
    moved.mkdir()
    (tmp_path / "a").rename(moved / "a")
    (tmp_path / "meshes").rename(moved / "meshes")
    found = read_session(moved / "a" / "s.json")
    assert found.session.source == str(moved / "meshes" / "m.obj") and not source_trouble(found)
    (moved / "meshes" / "m.obj").write_text("v 0 0 1\n")
    assert "another" in source_trouble(found)
    (moved / "meshes" / "m.obj").unlink()
    assert "not at" in source_trouble(found)


# ---------------------------------------------------------------------------------------------- hostile text


HOSTILE_VALUES: list[dict[str, Any]] = [
    {"distortion": 7},
    {"distortion": "x" * 100_000},
    {"distortion": "a\u0000b"},
    {"distortion_parameters": [1, 2]},
    {"distortion_parameters": {"lam": "1; import os"}},
    {"distortion_parameters": {"lam": 1e300}},
    {"solver": None},
    {"solver_parameters": {"a": {"b": 1}}},
    {"solver_parameters": {"a": 2**70}},
    {"kind": "plan"},
    {"kind": ["plane"]},
    {"fixes": "cut"},
    {"fixes": ["cut"] * 1000},
    {"match_area": 1},
    {"iterations": 10**30},
    {"iterations": -1},
    {"iterations": 1.5},
    {"iterations": True},
    {"tolerance": -1},
    {"time_limit": "soon"},
    {"anchors": {"0": [0, 0]}},
    {"anchors": [[0, [0, 0]]] * 1_000_000},
    {"anchors": [[-1, [0, 0]]]},
    {"anchors": [[0, [1e300, 0]]]},
    {"anchors": [[0, [0, 0, 0, 0]]]},
    {"anchors": [[0, [0, 0]], [1, [0, 0, 0]]]},
    {"anchors": [[0, [0, 0]], [0, [1, 1]]]},
    {"anchors": [[0, [0, 0], None, -1, True]]},
    {"anchors": [[0, [0, 0], "off"]]},
    {"anchors": [[0, [0, 0], -3]]},
    {"anchors": [[0, [0, 0], 0]]},
    {"anchors": [[0, [0, 0], 1e70]]},
    {"anchors": [[0, [0, 0], None, "g"]]},
    {"linear_equations": "x[0] = 0"},
    {"linear_equations": ["__import__('os').system('true') = x[0]"]},
    {"linear_equations": ["x[0] = 1e999"]},
    {"linear_equations": ["x[0] = 0\nx[1] = 0"]},
    {"linear_equations": ["x[0] = 0"] * 1_000_000},
    {"linear_equations": ["+".join(["x[0]"] * 10_000) + " = 0"]},
    {"version": 99},
    {"version": "1"},
    {"format": "something else"},
    {"source": "sample:bar"},
    {"source": {"path": "x" * 10_000}},
    {"source": {"path": "a\u0000.obj"}},
    {"source": {"path": "m.obj", "sha256": "../../etc/passwd"}},
    {"source": {"path": "m.obj", "command": "rm"}},
    {"legs": [{"from": "previous", "iterations": 3}]},
    {"legs": [{"from": "map", "iterations": 3}]},
    {"legs": [{"from": "start", "iterations": 1e9}]},
    {"legs": [{"from": "start", "iterations": 1, "fixes": ["cut"]}]},
    {"legs": [{"from": "start", "iterations": 1}] * 5000},
    {"__class__": "os"},
]


@pytest.mark.parametrize("spoilt", HOSTILE_VALUES, ids=lambda item: f"{next(iter(item))}-{str(next(iter(item.values())))[:20]}")
def test_values_that_do_not_fit_are_refused_with_a_sentence(tmp_path: Path, spoilt: dict[str, Any]) -> None:
    path = tmp_path / "s.json"
    path.write_text(json.dumps({**HEAD, **spoilt}))
    refused(path)


def refused(path: Path) -> str:
    with pytest.raises(WorkbenchError) as caught:
        read_session(path)
    sentence = caught.value.sentence
    assert str(path) in sentence and len(sentence) < 600 + len(str(path)) and sentence.rstrip()[-1] in ".;"
    return sentence


HOSTILE_TEXTS = {
    "nothing": "",
    "no JSON": "{",
    "a list": "[]",
    "not a number": json.dumps(HEAD)[:-1] + ', "tolerance": NaN}',
    "infinite": json.dumps(HEAD)[:-1] + ', "tolerance": 1e999}',
    "a number without end": json.dumps(HEAD)[:-1] + ', "iterations": ' + "9" * 100_000 + "}",
    "deep": "[" * 200_000,
    "twice": json.dumps(HEAD)[:-1] + ', "solver": "slim", "solver": "aqp"}',
    "binary": "\x00\x01\x02",
}


@pytest.mark.parametrize("name", HOSTILE_TEXTS)
def test_texts_that_are_no_session_are_refused(tmp_path: Path, name: str) -> None:
    path = tmp_path / "s.json"
    path.write_text(HOSTILE_TEXTS[name])
    refused(path)


@pytest.mark.parametrize("part", ["[0,[0,0]],", "{},", "[],"])
def test_a_million_of_anything_is_refused_before_it_is_parsed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, part: str
) -> None:
    path = tmp_path / "s.json"
    path.write_text(json.dumps(HEAD)[:-1] + ', "anchors": [' + part * 1_000_000 + "0]}")
    monkeypatch.setattr(json, "loads", lambda *_, **__: pytest.fail("nothing else in the process would go on meanwhile"))
    assert "more lists and objects" in refused(path)


def test_long_equations_are_no_lists() -> None:
    terms = " + ".join(f"x[{vertex}] + 2.0*y[{vertex}] - z[{vertex}]" for vertex in range(1000))
    assert part_count(json.dumps({**HEAD, "linear_equations": [f"{terms} = 1.0"] * 100})) == 3


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.recursive(
        st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5)),
        lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=5), inner, max_size=4)),
        max_leaves=12,
    ),
    st.sampled_from(["kind", "fixes", "anchors", "legs", "source", "distortion_parameters", "energy", "version", "carried"]),
)
def test_whatever_stands_there_is_read_or_refused(tmp_path: Path, value: Any, name: str) -> None:
    path = tmp_path / "s.json"
    path.write_text(json.dumps({**HEAD, name: value}))
    try:
        read_session(path)
    except WorkbenchError:
        pass


# ---------------------------------------------------------------------------------------------- hostile zips

Packer = Callable[[zipfile.ZipFile], None]


def npy(array: np.ndarray, **options: Any) -> bytes:
    stream = io.BytesIO()
    np.save(stream, array, **options)
    return stream.getvalue()


def claiming(shape: tuple[int, ...]) -> bytes:
    """An npy file that says it is larger than it is."""
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": "<f8", "fortran_order": False, "shape": shape})
    return stream.getvalue() + b"\0" * 16


def link_to_passwd(archive: zipfile.ZipFile) -> None:
    info = zipfile.ZipInfo("map.npy")
    info.external_attr = 0o120777 << 16
    archive.writestr(info, "/etc/passwd")


HOSTILE_MEMBERS: dict[str, Packer] = {
    "traversal": lambda z: z.writestr("../map.npy", npy(np.zeros((2, 2)))),
    "absolute": lambda z: z.writestr("/tmp/map.npy", npy(np.zeros((2, 2)))),
    "backslash": lambda z: z.writestr("..\\map.npy", npy(np.zeros((2, 2)))),
    "link": link_to_passwd,
    "program": lambda z: z.writestr("run.py", "print(1)"),
    "unused": lambda z: z.writestr("leg-3.npy", npy(np.zeros((2, 2)))),
    "pickle": lambda z: z.writestr("map.npy", npy(np.array([{}], dtype=object), allow_pickle=True)),
    "float32": lambda z: z.writestr("map.npy", npy(np.zeros((2, 2), np.float32))),
    "flat": lambda z: z.writestr("map.npy", npy(np.zeros(4))),
    "columns": lambda z: z.writestr("map.npy", npy(np.zeros((2, 4)))),
    "nan": lambda z: z.writestr("map.npy", npy(np.full((2, 2), np.nan))),
    "huge claim": lambda z: z.writestr("map.npy", claiming((10**12, 2))),
    "overflowing claim": lambda z: z.writestr("map.npy", claiming((2**62, 2))),
    "no array": lambda z: z.writestr("map.npy", b"\x93NUMPY\x01\x00"),
    "bomb": lambda z: z.writestr("map.npy", b"\0" * 50_000_000, zipfile.ZIP_DEFLATED),
    "text bomb": lambda z: z.writestr("session.json", b" " * 80_000_000, zipfile.ZIP_DEFLATED),
}


@pytest.mark.parametrize("name", ["../../evil.npy", "/tmp/evil.npy", "a/b.npy", "..\\evil.npy"])
def test_members_that_lead_elsewhere_are_told_as_such(tmp_path: Path, name: str) -> None:
    path = tmp_path / "s.dwb"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("session.json", json.dumps(HEAD))
        archive.writestr(name, npy(np.zeros((3, 2))))
    assert "leads elsewhere" in refused(path)


def test_a_link_in_a_zip_is_told_as_such(tmp_path: Path) -> None:
    path, link = tmp_path / "s.dwb", zipfile.ZipInfo("map.npy")
    link.external_attr = 0o120777 << 16
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("session.json", json.dumps(HEAD))
        archive.writestr(link, npy(np.zeros((3, 2))))
    assert "leads elsewhere" in refused(path)


def test_a_map_that_unpacks_to_far_more_than_its_file_is_not_unpacked(tmp_path: Path) -> None:
    path = tmp_path / "s.dwb"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("session.json", json.dumps(HEAD))
        archive.writestr("map.npy", npy(np.zeros((100_000, 2))))
    assert "Unpacked" in refused(path)


@pytest.mark.parametrize("name", HOSTILE_MEMBERS)
def test_zips_with_something_else_in_them_are_refused_and_nothing_is_unpacked(tmp_path: Path, name: str) -> None:
    path = tmp_path / "in" / "s.dwb"
    path.parent.mkdir()
    with zipfile.ZipFile(path, "w") as archive:
        if name != "text bomb":
            archive.writestr("session.json", json.dumps(HEAD))
        HOSTILE_MEMBERS[name](archive)
    before = sorted(tmp_path.rglob("*"))
    refused(path)
    assert sorted(tmp_path.rglob("*")) == before


def test_pictures_without_a_session_or_with_a_hostile_one_are_refused(tmp_path: Path) -> None:
    stream = io.BytesIO()
    Image.new("RGB", (4, 4)).save(stream, "PNG")
    plain = stream.getvalue()
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w") as archive:
        HOSTILE_MEMBERS["bomb"](archive)
    path = tmp_path / "p.png"
    for content in (None, b"", b"PK", b"{}", bomb.getvalue(), b"\x89PNG\r\n\x1a\n", pickle.dumps({})):
        path.write_bytes(plain if content is None else with_content(plain, content))
        refused(path)
        assert carries_session(path) is (content is not None)


def test_a_picture_carries_a_session_without_its_maps_where_they_are_large(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stream = io.BytesIO()
    Image.new("RGB", (4, 4)).save(stream, "PNG")
    record = SessionRecord(Session(source=str(tmp_path / "m.obj"), distortion="arap"), map=np.arange(20.0).reshape(10, 2))
    path = tmp_path / "p.png"
    for most, has_map in ((10**6, True), (100, False)):
        monkeypatch.setattr(session_file, "LARGEST_CARRIED", most)
        path.write_bytes(picture_with_session(stream.getvalue(), path, record))
        found = read_session(path)
        assert found.session == record.session and (found.map is not None) is has_map


def test_damage_anywhere_is_refused_or_harmless(tmp_path: Path) -> None:
    path = tmp_path / "s.dwb"
    write_session(path, SessionRecord(Session(source="sample:bar"), map=np.arange(20.0).reshape(10, 2)))
    good = path.read_bytes()
    random = np.random.default_rng(0)
    for _ in range(150):
        bad = bytearray(good)
        for place in random.integers(0, len(bad), 3):
            bad[place] = random.integers(0, 256)
        path.write_bytes(bytes(bad[: random.integers(1, len(bad))]) if random.random() < 0.3 else bytes(bad))
        try:
            read_session(path)
        except WorkbenchError:
            pass


def test_folders_and_pipes_are_no_sessions(tmp_path: Path) -> None:
    (tmp_path / "s.dwb").mkdir()
    refused(tmp_path / "s.dwb")
    os.mkfifo(tmp_path / "p.dwb")
    refused(tmp_path / "p.dwb")
    refused(tmp_path / "none.dwb")


def test_a_save_that_fails_leaves_the_file_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "s.dwb"
    record = SessionRecord(Session(source="sample:bar"), map=np.zeros((3, 2)))
    write_session(path, record)
    before = path.read_bytes()

    def fail(*_: Any, **__: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np.lib.format, "write_array", fail)
    with pytest.raises(WorkbenchError, match="No space"):
        write_session(path, replace(record, energy=3.0))
    assert path.read_bytes() == before and list(tmp_path.iterdir()) == [path]


def test_more_anchors_than_a_file_takes_are_not_written(tmp_path: Path) -> None:
    many = Session(source="sample:bar", anchor_vertices=tuple(range(300_000)), anchor_targets=((0.0, 0.0),) * 300_000)
    with pytest.raises(WorkbenchError, match="250000"):
        write_session(tmp_path / "s.dwb", SessionRecord(many))
    assert not list(tmp_path.iterdir())
