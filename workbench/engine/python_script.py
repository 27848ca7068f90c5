"""A Python script that repeats a session with `workbench.api`: readable, and nothing in it but what the session holds.

Whatever comes from the session stands in the script as a literal, so that no name or formula can become code.
"""

from __future__ import annotations

import keyword
import math
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.engine.own_formulas import self_contained
from workbench.engine.replay import check_maps, initializer_of, problem_of, solver_of, start_of
from workbench.io.atomic import write_text
from workbench.io.file_names import relative_name
from workbench.io.opening import SAMPLE, OpenedSource
from workbench.io.write import write_case
from workbench.session.journal import Leg
from workbench.session.record import SessionRecord
from workbench.session.session import ANCHORS, Session
from workbench.session.text import plain_of, record_of

ENDING = ".py"
ARRAYS = "-arrays.npz"
"""What the name of the file of arrays has in place of the ending: hardly the name of a mesh that lies there, too."""
MOST_INLINE = 24
"""Anchors that stand in the script; more of them are arrays in a file beside it."""
WIDTH = 120

HEAD = '''"""A run of the Distortion Workbench, to be repeated: run this with the Python that the workbench is installed in."""

from pathlib import Path

import numpy as np

from workbench.api import NAMES

HERE = Path(__file__).resolve().parent
'''
NAMES = ("Anchors", "Distortion", "load", "solve", "solver")
"""What a script imports, as far as it needs it."""
CHECK = """
difference = abs(result.energy - RECORDED) / max(abs(RECORDED), 1e-300)
print(f"recorded was {RECORDED:.15g}, relative difference {difference:.1e}")
if difference > 1e-10:
    raise SystemExit("The energy is not the one that was recorded.")
"""
TELL = """
print(f"{result.iterations} iterations, energy {result.energy:.15g}, {result.problem.inverted(result.positions)} inverted")
# result.save("map.obj") writes the map; figure(result).save("map.pdf") draws it
"""


def literal(value: Any) -> str:
    """Python's text for plain values; it evaluates to them and to nothing else. Raises `TypeError` for other things."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, bool | int | str):
        return repr(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else f"float({str(value)!r})"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{literal(str(name))}: {literal(item)}" for name, item in value.items()) + "}"
    if isinstance(value, tuple):
        return f"({', '.join(map(literal, value))}{',' if len(value) == 1 else ''})"
    if isinstance(value, list):
        return f"[{', '.join(map(literal, value))}]"
    raise TypeError(f"{type(value).__name__} is no plain value")


def write_script(path: str | os.PathLike[str], record: SessionRecord, opened: OpenedSource) -> None:
    """Write the script, and beside it `NAME-arrays.npz` where maps or many anchors belong to it.

    Files are named relative to the folder of the script. Raises `WorkbenchError` where the session does not fit its mesh.
    """
    place = Path(path)
    if place.suffix.lower() != ENDING:
        raise WorkbenchError(f"{path}: a Python script has the ending {ENDING}.")
    text, arrays = script_of(record, opened, place)
    beside = _arrays_of(place)
    if arrays and os.path.realpath(beside) == os.path.realpath(opened.file.path):
        raise WorkbenchError(f"The arrays of the script would take the place of its mesh {beside}; choose another name.")
    if arrays:
        write_case(beside, arrays)
    write_text(place, text)


def _arrays_of(place: Path) -> Path:
    """Where the arrays of a script stand."""
    return place.with_name(place.stem + ARRAYS)


def script_of(record: SessionRecord, opened: OpenedSource, place: Path) -> tuple[str, dict[str, Floats]]:
    """The script of a session that stands at `place`, and the arrays by name that belong into the file beside it."""
    plain, maps = plain_of(record)
    record = record_of(plain, maps)  # as a file has it: a leg has the choices of its session where it has none of its own
    check_maps(record, opened)
    solver = solver_of(record.session, problem_of(record.session, opened))
    writer = _Writer(Path(os.path.realpath(place)).parent)
    initializer = initializer_of(record.session, opened, solver)
    has_case = opened.start is not None and not record.session.initializer
    start = {} if has_case else writer.start(record.session, initializer)
    session, steps = record.session, []
    if not record.legs:
        limits = {name: getattr(session, name) for name in ("iterations", "tolerance", "time_limit")}
        if record.map is None:
            steps.append(writer.solve(session, start, limits))
        else:
            steps.append(writer.solve(session, {"init": writer.array("map", record.map)}, {"iterations": 0, "exactly": True}))
    for index, leg in enumerate(record.legs):
        origin = {"init": "result"} if leg.origin == "previous" else start
        if leg.positions is not None and not _is_start(leg, opened, initializer):
            origin = {"init": writer.array(f"leg_{index + 1}", leg.positions)}
        limits = {"iterations": leg.iterations, "tolerance": leg.choices.tolerance, "exactly": True}
        steps.append(writer.solve(leg.choices, origin, limits))
    if record.legs:  # the energy is told under the choices that came last
        steps.append(writer.solve(session, {"init": "result"}, {"iterations": 0, "exactly": True}))
    return writer.script(session, record.sha256, record.energy, steps, place), writer.arrays


def _is_start(leg: Leg, opened: OpenedSource, initializer: str) -> bool:
    """Whether the map at which a leg began is made again, to the last bit, by the start of its session."""
    if leg.origin != "start" or leg.positions is None:
        return False
    made = start_of(leg.choices, opened, initializer, problem_of(leg.choices, opened))
    return bool(np.array_equal(made, leg.positions))


@dataclass(eq=False)
class _Writer:
    """Puts the parts of a script together; what several calls share stands once."""

    folder: Path
    arrays: dict[str, Any] = field(default_factory=dict)
    held: dict[tuple[Any, ...], str] = field(default_factory=dict)
    """Names of the anchors by what they are."""
    definitions: list[str] = field(default_factory=list)

    def script(self, session: Session, sha256: str, energy: float | None, steps: list[str], place: Path) -> str:
        parts = [HEAD]
        if energy is not None:
            parts.append(f"RECORDED = {literal(energy)}  # the energy in the session")
        if self.arrays:
            parts.append(f"arrays = np.load(HERE / {literal(_arrays_of(place).name)})")
        parts += [""] * (len(parts) > 1) + [self.load(session)]
        if sha256:
            parts.append(f"if source.opened.file.sha256 != {literal(sha256)}:")
            parts.append('    raise SystemExit("The mesh is another than when the session was saved.")')
        parts += [*self.definitions, ""]
        text = "\n".join([*parts, *steps]) + TELL + (CHECK if energy is not None else "")
        body = text.removeprefix(HEAD)
        names = [name for name in NAMES if re.search(rf"\b{name}[(.]", body)]
        head = HEAD.replace("NAMES", ", ".join(names))
        return (head if "np." in body else head.replace("import numpy as np\n\n", "")) + body

    def load(self, session: Session) -> str:
        options = {"kind": session.kind, "fixes": session.fixes}
        usual = Session()
        given = [f"{name}={literal(value)}" for name, value in options.items() if value != getattr(usual, name)]
        return f"source = load({', '.join([self.path(session.source), *given])})"

    def path(self, name: str) -> str:
        """A file as an expression, relative to the script where that can be."""
        if name.startswith(SAMPLE):
            return literal(name)
        found = relative_name(name, self.folder)
        return literal(found) if os.path.isabs(found) else f"HERE / {literal(found)}"

    def array(self, name: str, values: Any) -> str:
        self.arrays[name] = np.asarray(values)
        return f"arrays[{literal(name)}]"

    def start(self, session: Session, initializer: str) -> dict[str, str]:
        """Arguments that make the start of a session."""
        file = session.start_file
        found = {"init": self.path(file) if file and initializer == "file" else literal(initializer)}
        if session.initializer_parameters:
            found["init_parameters"] = literal(session.initializer_parameters)
        if not session.match_area:
            found["match_area"] = "False"
        return found

    def anchors(self, session: Session) -> str:
        """The name of the anchors in force, defined once."""
        session = session.in_force
        columns = {name.removeprefix("anchor_"): getattr(session, name) for name in ANCHORS}
        count = len(session.anchor_vertices)
        if not count:
            return "Anchors.none(source.mesh.dimension)"
        key = tuple(columns.values())
        if key not in self.held:
            name = self.held[key] = f"anchors_{len(self.held) + 1}"
            given = {column: values for column, values in columns.items() if values and set(values) - {math.inf, -1}}
            if count > MOST_INLINE:
                parts = [f"{column}={self.array(f'{name}_{column}', values)}" for column, values in given.items()]
            else:
                parts = [f"{column}=np.array({_rows(values)})" for column, values in given.items()]
            self.definitions.append(_call(f"{name} = Anchors", parts))
        return self.held[key]

    def solve(self, choices: Session, start: Mapping[str, str], limits: Mapping[str, Any]) -> str:
        """The call that goes on from `start` under these choices."""
        choices = self_contained(choices)
        text, values = choices.distortion, choices.distortion_parameters
        distortion, solver = literal(text), literal(choices.solver)
        if values:
            distortion = f"Distortion.resolve({distortion}, {literal(values)})"
        if choices.solver_parameters:
            solver = f"solver({solver}, {_named_values(choices.solver_parameters)})"
        given = {"solver": solver, **start, "anchors": self.anchors(choices)}
        if choices.linear_equations:
            given["equations"] = literal(choices.linear_equations)
        given |= {"pin_boundary": "True"} if choices.fixed_boundary else {}
        given |= {"allow_inversions": "True"} if choices.allow_inversions else {}
        given |= {name: literal(value) for name, value in limits.items() if value != math.inf}
        return _call("result = solve", ["source", distortion, *(f"{name}={value}" for name, value in given.items())])


def _rows(values: tuple[Any, ...]) -> str:
    """A list, a row a line where its members are rows and there are some."""
    if len(values) < 4 or not isinstance(values[0], tuple):
        return literal(list(values))
    return "[\n" + "".join(f"        {literal(row)},\n" for row in values) + "    ]"


def _named_values(values: Mapping[str, Any]) -> str:
    """Values as arguments by name, or as an unpacked literal where a name is none in Python."""
    if all(name.isidentifier() and name.isascii() and not keyword.iskeyword(name) for name in values):
        return ", ".join(f"{name}={literal(value)}" for name, value in values.items())
    return f"**{literal(values)}"


def _call(head: str, arguments: list[str]) -> str:
    line = f"{head}({', '.join(arguments)})"
    if len(line) <= WIDTH and "\n" not in line:
        return line
    return f"{head}(\n" + "".join(f"    {argument},\n" for argument in arguments) + ")"
