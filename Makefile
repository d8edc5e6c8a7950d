# Everything runs in .venv, which the first target that needs it makes.
PYTHON ?= python3
BIN := .venv/bin

.PHONY: venv demo test test-browser test-package docs lint check-reference check-topology bench paper clean

venv: .venv/.ready

.venv/.ready: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --quiet --disable-pip-version-check --editable '.[all,dev]'
	$(BIN)/glyphspline warm
	touch $@

demo: venv
	$(BIN)/glyphspline demo --out outputs/demo

lint: venv
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# As many tests at a time as there are cores.
test: lint
	$(BIN)/python -m pytest -n auto --dist worksteal

# The paper, claim by claim, into outputs/paper: up to 25 minutes on two cores (`--quick` for a look).
paper: venv
	$(BIN)/python -m scripts.paper

# 5000 polygons through the compiled core and the plain reference, ten minutes or so of two free cores; the tests take 500.
# Before them 4 million footpoints that are hard to find, against 60 digits: some three minutes.
check-reference: venv
	$(BIN)/python scripts/adversarial_footpoints.py
	$(BIN)/python scripts/check_reference.py

# What written glyphs of five installed faces cross that their sources do not, and are not flagged for: four minutes or so.
check-topology: venv
	$(BIN)/python scripts/topology.py

bench: venv
	$(BIN)/pip install --quiet --disable-pip-version-check --editable '.[bench]'
	$(BIN)/python -m scripts.benchmark

# The pages of docs/ into docs/_build/html; a broken reference or a docstring that does not parse is an error.
docs: venv
	$(BIN)/pip install --quiet --disable-pip-version-check --editable '.[docs]'
	$(BIN)/sphinx-build -q -W --keep-going -b html docs docs/_build/html

# The wheel and the sdist in clean environments: two of this Python. ALL=1: every Python that is found, each extra.
test-package: venv
	$(BIN)/python scripts/test_package.py $(if $(ALL),--all)

# Playwright drives Debian's Chromium; nothing else is downloaded.
test-browser: venv
	$(BIN)/pip install --quiet --disable-pip-version-check --editable '.[browser]'
	@command -v chromium >/dev/null || { test "$$(id -u)" = 0 && apt-get update -q && apt-get install -qy chromium; } \
		|| { echo "make test-browser needs Debian's chromium: apt-get install chromium (as root)" >&2; exit 1; }
	$(BIN)/python -m pytest tests/browser

# Also the cache of compiled code, which does not notice edits in functions that are called from another file.
clean:
	rm -rf .venv .mypy_cache .pytest_cache .ruff_cache .hypothesis *.egg-info build outputs/demo docs/_build
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
