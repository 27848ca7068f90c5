"""What preferences say to processes: variables of the environment, for this one and those that it begins."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from workbench.app.views.canvas import CHOICE as DRAWING
from workbench.core.back_end_names import CHOICE as LINEAR_SOLVER
from workbench.core.threads import COUNT as THREADS

VARIABLES = {"threads": THREADS, "linear_solver": LINEAR_SOLVER, "drawing": DRAWING}
OF_USER = frozenset(variable for variable in VARIABLES.values() if variable in os.environ)
"""What was set when the program was started: that comes first."""


def set_environment(values: Mapping[str, Any]) -> bool:
    """Set or remove the variables of these preferences; tells whether anything is another one now."""
    before = [os.environ.get(variable) for variable in VARIABLES.values()]
    for name, variable in VARIABLES.items():
        if variable not in OF_USER:
            value = values.get(name)
            if value:  # 0 and an empty text leave it to the program
                os.environ[variable] = str(value)
            else:
                os.environ.pop(variable, None)
    return before != [os.environ.get(variable) for variable in VARIABLES.values()]
