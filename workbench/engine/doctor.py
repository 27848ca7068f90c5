"""What a healthy installation has, and what this one lacks: facts for `workbench doctor` and the window's help."""

from __future__ import annotations

import os
import platform
import re
import subprocess
import sys
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path

from workbench import __version__
from workbench.core.registry import load_registry, resource_folder, user_plugin_folder
from workbench.core.threads import thread_count
from workbench.engine.log_file import log_path
from workbench.engine.system_libraries import install_command, missing_libraries

DISTRIBUTION = "distortion-workbench"
OPTIONAL = ("pypardiso", "pytetwild", "imageio-ffmpeg")
PROBE = """
import sys
from PySide6.QtGui import QGuiApplication
application = QGuiApplication(["doctor"])
print(application.platformName())
"""


@dataclass(frozen=True)
class Finding:
    """One line; `good` false marks what needs the user's attention, `remedy` says what to do, `details` stand below."""

    name: str
    value: str
    good: bool = True
    remedy: str = ""
    details: str = ""


@dataclass(frozen=True)
class Section:
    """A heading and its findings."""

    title: str
    findings: tuple[Finding, ...] = field(default=())


def examine() -> tuple[Section, ...]:
    """Look at everything. Starts one short-lived process to see whether Qt can open a display."""
    return (program(), packages(), plugins(), linear_solvers(), graphics())


def program() -> Section:
    """Versions, threads and folders."""
    return Section(
        "program",
        (
            Finding("workbench", __version__),
            Finding("python", f"{platform.python_version()} ({sys.executable})"),
            Finding("system", f"{platform.platform()}, {os.cpu_count()} processors"),
            _threads(),
            _kernel_cache(),
            Finding("log of the window", str(log_path())),
        ),
    )


def packages() -> Section:
    """Version of each library that the package declares, and those that are missing."""
    findings = []
    for name in _required():
        version = installed_version(name)
        if version:
            findings.append(Finding(name, version))
        else:
            findings.append(Finding(name, "not installed", good=False, remedy=f"python -m pip install {name}"))
    for name in OPTIONAL:
        findings.append(Finding(name, installed_version(name) or "not installed (optional)"))
    return Section("packages", tuple(findings))


def versions() -> dict[str, str]:
    """Versions that a report carries: the program, Python, and the libraries that numbers depend on."""
    names = ("numpy", "scipy", "numba", "libigl", "cvxopt", "pymetis")
    found = {name: installed_version(name) for name in names}
    return {"workbench": __version__, "python": platform.python_version(), **{k: v for k, v in found.items() if v}}


def installed_version(name: str) -> str:
    """Version of an installed distribution, empty where there is none."""
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return ""


def plugins() -> Section:
    """Plugin folders, and every plugin that failed with its traceback."""
    folder, own = user_plugin_folder(), resource_folder("plugins")
    found = load_registry((own, folder))
    findings = [
        Finding("built-in plugins", str(own), good=own.is_dir()),
        Finding("your plugins", f"{folder}{'' if folder.is_dir() else ' (make it to add methods of your own)'}"),
        Finding(
            "methods",
            f"{len(found.distortions)} distortions, {len(found.solvers)} solvers, {len(found.initializers)} initializers",
        ),
    ]
    for failure in found.failures:
        remedy = "mend the file or move it away"
        findings.append(Finding(str(failure.path), f"failed: {failure.sentence}", False, remedy, failure.traceback))
    return Section("plugins", tuple(findings))


def linear_solvers() -> Section:
    """The back ends of the factorisation."""
    findings = [Finding("multifrontal", "Cholesky on all cores: always there, the default")]
    for name, what, instead in (
        ("pymetis", "METIS order of the vertices", "the order is AMD or Cuthill and McKee's: slower on large meshes"),
        ("pypardiso", "Intel's dense routines in the factorisation, and PARDISO (extra mkl)", "optional"),
        ("cvxopt", "CHOLMOD (extra cholmod)", "optional"),
    ):
        version = installed_version(name)
        findings.append(Finding(name, f"{what}: {version}" if version else f"{what}: not installed; {instead}"))
    findings.append(Finding("superlu", "SciPy: always there"))
    return Section("linear solvers", tuple(findings))


def graphics() -> Section:
    """Shared libraries, and whether Qt can open a window here."""
    missing = missing_libraries()
    findings = []
    if missing:
        names = ", ".join(library.name for library in missing)
        findings.append(Finding("system libraries", f"missing: {names}", good=False, remedy=install_command(missing)))
    else:
        findings.append(Finding("system libraries", "all there"))
    findings.append(_display())
    return Section("graphics", tuple(findings))


def _display() -> Finding:
    if not installed_version("PySide6-Essentials"):
        return Finding("window", "Qt is not installed; the command line works without it", False, f"pip install {DISTRIBUTION}")
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        remedy = "start it in a desktop session, or under a virtual screen: xvfb-run workbench"
        return Finding("window", "there is no display (DISPLAY is not set); the command line works without it", True, remedy)
    try:
        probe = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, text=True, timeout=60, check=False)
    except subprocess.TimeoutExpired:
        return Finding("window", "Qt does not answer within a minute", False, "look whether the display still answers")
    if probe.returncode == 0:
        return Finding("window", f"Qt opens displays through {probe.stdout.strip()}")
    said = [line for line in probe.stderr.splitlines() if line.strip()]
    return Finding("window", "Qt cannot open the display", False, "see what Qt says below", "\n".join(said))


def _threads() -> Finding:
    return Finding("threads", f"{thread_count()} (change with --threads N)")


def _kernel_cache() -> Finding:
    configured = os.environ.get("NUMBA_CACHE_DIR")
    place = Path(configured) if configured else Path(__file__).resolve().parents[1] / "core" / "__pycache__"
    if os.access(place if place.is_dir() else place.parent, os.W_OK):
        return Finding("compiled kernels", str(place))
    return Finding("compiled kernels", "in numba's cache folder of this user, as the package's own folder is read-only")


def _required() -> list[str]:
    """Names of the distributions that ours needs here, from its metadata; none where it is not installed."""
    try:
        lines = metadata.requires(DISTRIBUTION) or []
    except metadata.PackageNotFoundError:
        return []
    names = []
    for line in lines:
        requirement, _, marker = line.partition(";")
        if "extra" in marker or ("platform_system" in marker and platform.system() == "Windows"):
            continue
        match = re.match(r"[A-Za-z0-9._-]+", requirement)
        if match:
            names.append(match.group())
    return list(dict.fromkeys(names))
