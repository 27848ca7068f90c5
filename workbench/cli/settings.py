"""`--set NAME=VALUE`: parameters by name."""

from __future__ import annotations

import argparse


def add_set_option(parser: argparse.ArgumentParser, owners: str) -> None:
    parser.add_argument(
        "--set", dest="settings", metavar="NAME=VALUE", type=name_and_value, action="append", default=[],
        help=f"a parameter of {owners}; may be given many times",
    )  # fmt: skip


def name_and_value(text: str) -> tuple[str, str]:
    """`NAME=VALUE` taken apart; argparse's own error otherwise."""
    name, equals, value = text.partition("=")
    if not equals or not name.strip() or not value.strip():
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form NAME=VALUE")
    return name.strip(), value.strip()
