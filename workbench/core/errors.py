"""The one exception that carries a sentence for the user."""

from __future__ import annotations


class WorkbenchError(Exception):
    """Expected failure of an input or a choice: what is wrong, where, and what to do.

    Attributes
    ----------
    sentence : str             complete sentence(s) for the status bar, the error bar and stderr
    fixes : tuple of str       names of `--fix` operations that would help, in the order to apply them
    """

    def __init__(self, sentence: str, *, fixes: tuple[str, ...] = ()) -> None:
        super().__init__(sentence)
        self.sentence = sentence
        self.fixes = fixes

    def __reduce__(self) -> tuple[object, ...]:
        return (_rebuild, (type(self), self.sentence, self.fixes))


def _rebuild(cls: type[WorkbenchError], sentence: str, fixes: tuple[str, ...]) -> WorkbenchError:
    return cls(sentence, fixes=fixes)


class MeshError(WorkbenchError):
    """A mesh or a mesh file that cannot be used as it is."""


class SolverFailedError(WorkbenchError):
    """A run that failed on an input that is in order, where its map was needed for more."""


class FormulaError(WorkbenchError):
    """A formula that is refused; `position` is the column (from 0) in the text where the fault is."""

    def __init__(self, sentence: str, *, position: int = 0, fixes: tuple[str, ...] = ()) -> None:
        super().__init__(sentence, fixes=fixes)
        self.position = position

    def __reduce__(self) -> tuple[object, ...]:
        return (_rebuild_formula_error, (self.sentence, self.position))


def _rebuild_formula_error(sentence: str, position: int) -> FormulaError:
    return FormulaError(sentence, position=position)
