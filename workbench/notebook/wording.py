"""Sentences that name options of the command line, in the words of a script."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from workbench.core.errors import WorkbenchError

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")

_WORDS = (
    (re.compile(r"--fix ([a-z]+(?:,[a-z]+)*)"), r'fixes="\1"'),
    (re.compile(r"--set (\w+)=\.\.\."), r'parameters={"\1": ...}'),
    (re.compile(r"--map (\w+)"), r'kind="\1"'),
)
_OPTION = re.compile(r"--([a-z][a-z-]*)")


def for_scripts(sentence: str) -> str:
    """The sentence with arguments of `load` and `solve` in place of options."""
    for pattern, words in _WORDS:
        sentence = pattern.sub(words, sentence)
    return _OPTION.sub(lambda match: match[1].replace("-", "_"), sentence)


def in_words_of_scripts(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """The function, with the sentences of its `WorkbenchError` in the words of a script."""

    @functools.wraps(function)
    def told(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Result:
        try:
            return function(*args, **kwargs)
        except WorkbenchError as error:
            error.sentence = for_scripts(error.sentence)
            error.args = (error.sentence,)
            raise

    return told
