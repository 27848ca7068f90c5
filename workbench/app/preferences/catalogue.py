"""Every preference: its name, its words, what it may be, and the page it stands on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from workbench.core.back_end_names import available_back_ends
from workbench.core.errors import WorkbenchError
from workbench.core.method import Parameter
from workbench.session.session import Session


@dataclass(frozen=True)
class Preference:
    """One line of the dialog.

    `parameter` has name, type, default and limits, and what the tool tip says; `words` are the choices as they are shown;
    `unit` stands behind a number, `least` in place of the smallest one. `is_listed_late`: the choices are only known once
    the methods are found.
    """

    page: str
    label: str
    parameter: Parameter
    words: Mapping[str, str] = field(default_factory=dict)
    unit: str = ""
    least: str = ""
    step: float = 1.0
    is_listed_late: bool = False

    @property
    def name(self) -> str:
        return self.parameter.name

    @property
    def default(self) -> Any:
        return self.parameter.default

    def check(self, value: object) -> Any:
        """`value` where it fits. Raises `WorkbenchError`."""
        own = self.parameter.type
        if type(value) is not own and not (own is float and type(value) is int):
            raise WorkbenchError(f"{self.name} cannot be {value!r}.")
        return self.parameter.check(value)


def _number(page: str, label: str, name: str, default: float, low: float, high: float, tip: str, **more: Any) -> Preference:
    return Preference(page, label, Parameter(name, type(default), default, tip, low, high), **more)


def _choice(page: str, label: str, name: str, words: Mapping[str, str], tip: str) -> Preference:
    return Preference(page, label, Parameter(name, str, next(iter(words)), tip, choices=tuple(words)), words)


def _switch(page: str, label: str, name: str, default: bool, tip: str) -> Preference:
    return Preference(page, label, Parameter(name, bool, default, tip))


def _method(page: str, label: str, name: str, default: str, tip: str) -> Preference:
    return Preference(page, label, Parameter(name, str, default, tip), is_listed_late=True)


GENERAL, APPEARANCE, VIEWS = "General", "Appearance", "Views and colours"
SOLVING, SAVING, PERFORMANCE = "Solving", "Saving and undo", "Performance"
PAGES = (GENERAL, APPEARANCE, VIEWS, SOLVING, SAVING, PERFORMANCE)
BACK_ENDS = {
    "multifrontal": "Multifrontal, of this program",
    "cholmod": "CHOLMOD",
    "pardiso": "PARDISO (Intel MKL)",
    "superlu": "SuperLU",
}
COLOUR_MAPS = {"CET_L19": "Pale blue over violet to red", "CET_L12": "Pale to blue", "CET_L1": "Pale to black"}

PREFERENCES: tuple[Preference, ...] = (
    _choice(
        GENERAL,
        "At the start open",
        "start_with",
        {"sample": "A sample", "last": "The last mesh"},
        "What the window opens where no file is named on the command line",
    ),
    _number(GENERAL, "Recent files", "recent_count", 10, 1, 40, "How many files and sessions the File menu lists"),
    _switch(GENERAL, "Tool tips", "tool_tips", True, "Explain buttons and fields where the pointer rests"),
    _choice(
        APPEARANCE,
        "Colours",
        "theme",
        {"system": "Follow the system", "light": "Light", "dark": "Dark"},
        "Of the window; figures are white or transparent whatever it is",
    ),
    _number(
        APPEARANCE,
        "Size of text",
        "font_size",
        0,
        0,
        24,
        "Of everything in the window",
        unit=" pt",
        least="As the system has it",
    ),
    _choice(
        APPEARANCE,
        "Tool bar",
        "tool_bar",
        {"beside": "Pictures and words", "pictures": "Pictures", "words": "Words", "under": "Words under pictures"},
        "What its buttons show",
    ),
    _number(
        VIEWS,
        "Anchors",
        "anchor_size",
        6.5,
        2.0,
        16.0,
        "Radius of an anchor's disc; of many they are smaller",
        unit=" px",
        step=0.5,
    ),
    _number(VIEWS, "Edges", "edge_width", 1.0, 0.5, 5.0, "Width of the edges of simplices", unit=" px", step=0.5),
    _number(
        VIEWS,
        "Show edges up to",
        "edges_up_to",
        12_000,
        0,
        10_000_000,
        "Of meshes of more triangles edges are drawn only where they are asked for (E), from the next mesh on",
        unit=" triangles",
        step=1000,
    ),
    _choice(
        VIEWS, "Distortions", "colour_map", COLOUR_MAPS, "Colours from little to much; yellow stands for inverted simplices"
    ),
    _method(SOLVING, "Distortion", "distortion", Session().distortion, "That of a new window"),
    _method(SOLVING, "Solver", "solver", Session().solver, "That of a new window"),
    _number(
        SOLVING,
        "Threads",
        "threads",
        0,
        0,
        256,
        "For solving; a change begins the engine anew on the map that there is",
        least="All cores, up to 8",
    ),
    _choice(
        SOLVING,
        "Linear solver",
        "linear_solver",
        {"": "Whichever suits", **{name: BACK_ENDS[name] for name in available_back_ends()}},
        "Factorises the Hessian; a change begins the engine anew on the map that there is",
    ),
    _switch(SAVING, "Keep unsaved work", "autosave", True, "So that it can be offered at the next start after a crash"),
    _number(
        SAVING, "Every", "autosave_seconds", 4, 1, 600, "So much work is lost in a crash, at the most, and a little", unit=" s"
    ),
    _switch(
        SAVING,
        "Pictures carry the session",
        "carry_session",
        True,
        "A PNG that is saved can be opened, or dropped on the window, to go on from what it shows",
    ),
    _number(
        SAVING,
        "Memory for undo",
        "undo_megabytes",
        256,
        16,
        65_536,
        "For maps; beyond it the oldest steps are forgotten",
        unit=" MB",
    ),
    _number(
        SAVING,
        "Memory for the time line",
        "time_line_megabytes",
        256,
        16,
        65_536,
        "For maps; beyond it the oldest ones are forgotten",
        unit=" MB",
    ),
    _number(
        PERFORMANCE,
        "Rest of the panels",
        "panel_rest",
        3.0,
        0.0,
        50.0,
        "Between two drawings of a small panel, as a multiple of the time that one takes: the main view comes first",
        unit=" ×",
        step=0.5,
    ),
    _choice(
        PERFORMANCE,
        "Draw with",
        "drawing",
        {"": "Whatever is quicker", "memory": "The processor", "card": "The graphics card"},
        "From the next start on",
    ),
)
BY_NAME: Mapping[str, Preference] = {preference.name: preference for preference in PREFERENCES}
