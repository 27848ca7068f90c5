"""The command line: `workbench` and `python -m workbench`.

One sub-command a file; each has `add_parser` and imports what it computes with only when it runs, so that `--help`
is quick.
"""

from __future__ import annotations

from workbench.cli.main import main

__all__ = ["main"]
