# Two commands for a fresh clone: `make run` opens the window on a sample, `make test` runs the whole suite.
# Both set up what is missing first: a virtual environment in .venv, the packages, and on Debian and Ubuntu the system libraries.

VENV := .venv
PYTHON := $(VENV)/bin/python
PIP := $(PYTHON) -m pip install --disable-pip-version-check --no-input --quiet
export DEBIAN_FRONTEND := noninteractive

# APT_INSTALL,packages: as root directly, else with sudo; where there is neither, say what to type. `update` once a shell.
define APT_INSTALL
apt_install() { \
	if ! command -v apt-get >/dev/null; then \
		echo "Please install what these Debian packages hold, by your system's own means: $$*" >&2; return 1; \
	elif [ "$$(id -u)" = 0 ]; then as=""; \
	elif command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then as="sudo DEBIAN_FRONTEND=noninteractive"; \
	else echo "System packages are missing. Run as root: apt-get update && apt-get install -y $$*" >&2; return 1; \
	fi; \
	echo "Installing system packages: $$*"; \
	if [ -z "$$updated" ]; then $$as apt-get update -qq </dev/null && updated=1; fi; \
	$$as apt-get install -y -qq --no-install-recommends "$$@" </dev/null >/dev/null; \
}
endef

# Prints the first Python that is new enough and can make a virtual environment.
define FIND_PYTHON
find_python() { \
	for name in python3.13 python3.12 python3.11 python3; do \
		if "$$name" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; then \
			echo "$$name"; return 0; \
		fi; \
	done; return 1; \
}
endef

.PHONY: run test bench clean
.DEFAULT_GOAL := run

run: $(VENV)/installed
	@$(APT_INSTALL); set -e; missing=$$($(PYTHON) -m workbench.engine.system_libraries); \
	if [ -n "$$missing" ]; then apt_install $$missing; fi
	@$(PYTHON) -m workbench

# Everything is run even where an earlier check fails, so that one call tells all; pytest comes last.
test: $(VENV)/installed-test
	@$(APT_INSTALL); set -e; missing=$$($(PYTHON) -m workbench.engine.system_libraries --tests); \
	if [ -n "$$missing" ]; then apt_install $$missing; fi
	@failed=""; \
	echo "ruff"; $(PYTHON) -m ruff check . || failed="$$failed ruff"; \
	echo "mypy"; $(PYTHON) -m mypy || failed="$$failed mypy"; \
	echo "import-linter"; $(VENV)/bin/lint-imports || failed="$$failed import-linter"; \
	if [ -n "$$failed" ]; then echo "FAILED:$$failed (see above)" >&2; fi; \
	echo "pytest"; $(PYTHON) -m pytest $(ARGS) && [ -z "$$failed" ]

bench: $(VENV)/installed-test
	@for file in tests/benchmarks/*.py; do \
		case "$$file" in */_*|*/test_*|*/conftest.py) continue ;; esac; \
		echo "== $$file"; $(PYTHON) "$$file" || exit 1; \
	done

clean:
	rm -rf $(VENV) build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/created:
	@$(APT_INSTALL); $(FIND_PYTHON); \
	python=$$(find_python) || { \
		apt_install python3 python3-venv && python=$$(find_python); \
	} || { echo "Python 3.11 or newer, with its venv module, is needed and was not found." >&2; exit 1; }; \
	echo "Making $(VENV) with $$($$python --version)"; \
	"$$python" -m venv $(VENV)
	@touch $@

$(VENV)/installed: pyproject.toml $(VENV)/created
	@echo "Installing the packages into $(VENV): some minutes on the first call"
	@$(PIP) --editable .
	@touch $@

$(VENV)/installed-test: pyproject.toml $(VENV)/created
	@echo "Installing the packages into $(VENV): some minutes on the first call"
	@$(PIP) --editable '.[test]'
	@touch $@ $(VENV)/installed
