"""The README, cut into chapters at its headings."""

from __future__ import annotations

import re
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

from workbench.core.registry import resource_folder
from workbench.engine.doctor import DISTRIBUTION

HEADING = re.compile(r"(#{1,3}) (.+)")
NO_README = "# Distortion Workbench\n\nThe README is missing from this installation; install it anew to have it here.\n"


@dataclass(frozen=True)
class Chapter:
    """`level` 1 for the title's own words, 2 for chapters, 3 for parts of them; `text` is Markdown with the heading."""

    title: str
    level: int
    text: str

    def holds(self, words: str) -> bool:
        """Whether every one of some words occurs in it."""
        text = self.text.casefold()
        return all(word in text for word in words.casefold().split())


def readme_folder() -> Path:
    """Where the README's pictures are: inside the installed package, or, with itself, at the root of a checkout."""
    return resource_folder("assets").parent


def read_chapters(folder: Path | None = None) -> tuple[Chapter, ...]:
    """Chapters of the README in their order; one that says so where there is none.

    It stands in `folder`, or else in the metadata of the installed package, which hold it as their description.
    """
    try:
        text = ((folder or readme_folder()) / "README.md").read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        text = _description()
    return cut_into_chapters(text) or cut_into_chapters(NO_README)


def _description() -> str:
    try:
        found = metadata.metadata(DISTRIBUTION)
    except metadata.PackageNotFoundError:
        return ""
    return str(found.get_payload()) or found.get("Description", "")  # type: ignore[attr-defined]


def cut_into_chapters(text: str) -> tuple[Chapter, ...]:
    """Chapters of a Markdown text whose code is indented; what stands before the first heading is left out."""
    chapters: list[Chapter] = []
    title, level, lines = "", 0, list[str]()

    def end() -> None:
        if title:
            chapters.append(Chapter(title, level, "\n".join(lines).rstrip() + "\n"))

    for line in text.splitlines():
        found = HEADING.fullmatch(line)
        if found:
            end()
            level, title, lines = len(found[1]), found[2].strip(), []
        lines.append(line)
    end()
    return tuple(chapters)


def with_fences(text: str) -> str:
    """The same Markdown with indented code between fences: such blocks are known as code wherever they are drawn."""
    lines: list[str] = []
    is_code, blank = False, 0
    for line in text.splitlines():
        if not line.strip():
            blank += 1
            continue
        begins = line.startswith("    ") and (is_code or blank > 0)
        if is_code and not begins:
            lines.append("```")
        lines += [""] * blank
        if begins and not is_code:
            lines.append("```")
        lines.append(line[4:] if begins else line)
        is_code, blank = begins, 0
    return "\n".join([*lines, "```"] if is_code else lines) + "\n"
