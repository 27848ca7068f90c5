"""Exit status 2 and one sentence for whatever is refused before anything is computed."""

from __future__ import annotations

import subprocess
import sys

import pytest

from workbench import __version__

REFUSED = [
    ["frobnicate"],
    ["compare", "a.obj"],
    ["solve"],
    ["solve", "no-such-file.obj", "--out", "OUT.obj"],
    ["solve", "sample:no-such-sample", "--out", "OUT.obj"],
    ["solve", "SQUARE", "--out", "OUT.png"],
    ["solve", "SQUARE", "--out", "no-such-folder/out.obj"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--report", "OUT.obj"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--iterations", "-1"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--iterations", "1.5"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--tolerance", "nan"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--time-limit", "soon"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--threads", "0"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--map", "sphere"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--map", "volume"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--fix", "polish"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--solver", "magic"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--init", "magic"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--repair", "magic"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--distortion", "magic-wand"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--distortion", "sigma"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--set", "speed"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--set", "speed=3"],
    ["solve", "SQUARE", "--out", "OUT.obj", "--anchors", "no-such-anchors.csv"],
    ["measure", "SQUARE"],
    ["measure", "no-such-file.obj"],
    ["check", "__import__('os')"],
    ["check", "sum(sigma^2) + unknown"],
    ["check", "sum(sigma^2)", "--dim", "4"],
    ["list", "unicorns"],
    ["open", "no-such-file.obj"],
    ["no-such-file.obj"],
    ["--no-such-option"],
]


@pytest.mark.parametrize("arguments", REFUSED, ids=" ".join)
def test_refused_with_one_sentence_and_nothing_written(arguments, cli, square_file, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = sorted(tmp_path.iterdir())
    result = cli(*[str(square_file) if item == "SQUARE" else item for item in arguments])
    assert result.status == 2
    assert result.err.startswith("workbench") and "Traceback" not in result.err
    assert len(result.err.strip().splitlines()) == 1
    assert result.out == ""
    assert sorted(tmp_path.iterdir()) == before


def test_unknown_parameter_is_answered_with_the_known_ones(cli, square_file, tmp_path):
    text = "sum(sigma^2) + weight/det"
    options = ("--out", tmp_path / "o.obj", "--distortion", text, "--solver", "gradient-descent")
    said = cli("solve", square_file, *options, "--set", "growht=3").err
    assert "growht" in said and "weight" in said and "growth" in said


def test_version_and_help_say_what_there_is(cli):
    assert cli("--version").out.strip() == f"workbench {__version__}"
    said = cli("--help")
    assert said.status == 0
    for command in ("list", "solve", "measure", "check", "doctor"):
        assert command in said.out


@pytest.mark.parametrize(
    ("arguments", "source"),
    [
        ([], None),
        (["FILE"], "FILE"),
        (["open", "FILE"], "FILE"),
        (["FILE", "--theme", "dark"], "FILE"),
        (["--theme", "dark", "FILE"], "FILE"),
        (["--theme=dark"], None),
        (["sample:bar"], "sample:bar"),
        (["--reset"], None),
        (["--reset", "FILE"], "FILE"),
    ],
)
def test_no_command_opens_the_window(arguments, source, cli, square_file, monkeypatch):
    seen = []
    module = type(sys)("workbench.app.main")
    module.run_window = lambda source, **options: seen.append((source, options)) or 0
    monkeypatch.setitem(sys.modules, "workbench.app.main", module)
    file = str(square_file)
    assert cli(*[file if item == "FILE" else item for item in arguments]).status == 0
    theme = "dark" if any("theme" in item for item in arguments) else ""
    assert seen == [(file if source == "FILE" else source, {"theme": theme, "reset": "--reset" in arguments})]


def test_a_window_that_cannot_be_loaded_is_explained(cli, monkeypatch):
    monkeypatch.setitem(sys.modules, "workbench.app.main", None)
    result = cli()
    assert result.status == 2 and "workbench doctor" in result.err


def test_runs_as_a_module(project_root):
    command = [sys.executable, "-m", "workbench", "check", "max(sigma)/min(sigma)"]
    done = subprocess.run(command, cwd=project_root, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0 and "value at (1, 1): 1" in done.stdout


def test_a_reader_that_goes_away_is_no_fault(project_root):
    command = f'"{sys.executable}" -m workbench list --json | head -n 1'
    done = subprocess.run(command, shell=True, cwd=project_root, capture_output=True, text=True, timeout=120, check=False)
    assert "Traceback" not in done.stderr and "Exception" not in done.stderr
