# Everything runs in .venv. Each target installs what it needs, once: .venv/.NAME says that the extra NAME is installed.
PYTHON ?= python3
BIN := .venv/bin
# Python compiles the modules of libraries when it first imports them, most of them never, and keeps the result.
unexport PYTHONDONTWRITEBYTECODE
INSTALL := $(BIN)/pip install --quiet --disable-pip-version-check --no-compile --editable

.PHONY: venv warm demo test test-all test-browser test-package wheel docs lint fuzz check-reference check-topology check-bounds check-bytes check-starts bench paper clean
.NOTPARALLEL:

# The package alone.
venv: .venv/.ready

.venv/.ready: pyproject.toml
	test -x $(BIN)/pip || $(PYTHON) -m venv .venv
	$(INSTALL) .
	touch $@

# An extra of pyproject.toml, and the package with it.
.venv/.%: pyproject.toml
	test -x $(BIN)/pip || $(PYTHON) -m venv .venv
	$(INSTALL) '.[$*]'
	touch .venv/.ready $(if $(filter test test-all browser,$*),.venv/.dev) $@

# Compiles what is not compiled yet. Without it everything runs as plain Python, tests in hours.
warm: .venv/.ready
	$(BIN)/glyphspline warm

# Nothing is compiled for these few glyphs.
demo: .venv/.ready
	$(BIN)/glyphspline demo --out outputs/demo

# ruff, mypy on the package, and the libraries whose types mypy reads; nothing is compiled.
lint: .venv/.dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# Every truth, at the size that tells it: lint beside compiling, then as many tests at a time as there are cores.
test: .venv/.test
	$(MAKE) lint & lint=$$!; $(BIN)/glyphspline warm && wait $$lint
	$(BIN)/python -m pytest -n auto --dist worksteal -m 'not long and not needs'

# All tests: those that repeat others at length, and those of data-set libraries, an object store, a cluster and notebooks,
# which fail where a library is absent. Types of scripts and tests too.
test-all: .venv/.test-all lint warm
	$(BIN)/mypy glyphspline scripts tests
	$(BIN)/python -m pytest -n auto --dist worksteal --require-libraries --hypothesis-profile long

# The paper, claim by claim, into outputs/paper: up to 25 minutes on two cores (`--quick` for a look). `make paper ONLY=fig4`
# makes that figure and its claims alone, into outputs/paper-fig4.
paper: warm
	$(BIN)/python -m scripts.paper $(if $(ONLY),--only $(ONLY))

# 5000 polygons through the compiled core and the plain reference, ten minutes or so of two free cores; `make test-all` takes 500.
# Before them 4 million footpoints that are hard to find, against 60 digits: some three minutes.
check-reference: warm
	$(BIN)/python -m scripts.adversarial_footpoints
	$(BIN)/python -m scripts.check_reference

# What written glyphs of five installed faces, and 500 contours in tangles or thinner than the tolerance, cross that their
# sources do not, and are not flagged for: seven minutes or so.
check-topology: warm
	$(BIN)/python -m scripts.topology

# Whether glyphs of eight installed faces, written in both formats, are within the bounds that the manifest has of them:
# half an hour or so of two free cores.
check-bounds: .venv/.test warm
	$(BIN)/python -m scripts.bounds

# Whether plain Python writes the bytes of compiled code: glyphs of six installed faces and ones that no designer draws.
check-bytes: .venv/.test warm
	$(BIN)/python -m scripts.same_bytes

# 2000 starts of a command, 500 of them under load, and in 100 more a process is killed: an hour of two free cores.
check-starts: .venv/.ready
	$(BIN)/python -m scripts.starts

# Damaged fonts and drawings through the commands, each in limits of time and memory: MINUTES of it, ten if not given.
fuzz: .venv/.test warm
	$(BIN)/python -m tests.fuzz --minutes $(or $(MINUTES),10)

bench: .venv/.bench warm
	$(BIN)/python -m scripts.benchmark

# The pages of docs/ into docs/_build/html; a broken reference or a docstring that does not parse is an error.
docs: .venv/.docs
	$(BIN)/sphinx-build -q -W --keep-going -b html docs docs/_build/html

# The wheel and the sdist in clean environments: one of this Python. ALL=1: every Python that is found, each extra.
# Then a wheel with compiled code, of what `make test` has compiled: nothing is compiled by its commands.
test-package: warm
	$(PYTHON) tests/package/environments.py $(if $(ALL),--all)
	$(PYTHON) tests/package/compiled_wheel.py

# Into dist: the pure wheel, and one with compiled code for this system and Python, for every processor of its kind.
wheel: .venv/.ready
	$(BIN)/pip install --quiet --disable-pip-version-check build
	$(BIN)/python -m build --wheel --outdir dist .
	GLYPHSPLINE_COMPILED=1 $(BIN)/python -m build --wheel --outdir dist .

# Playwright drives Debian's Chromium; nothing else is downloaded.
test-browser: .venv/.browser warm
	@command -v chromium >/dev/null || { test "$$(id -u)" = 0 && apt-get update -q && apt-get install -qy chromium; } \
		|| { echo "make test-browser needs Debian's chromium: apt-get install chromium (as root)" >&2; exit 1; }
	$(BIN)/python -m pytest tests/browser

# All that was made here. Compiled code need not be cleared after edits: it is named by the sources it was made from.
clean:
	rm -rf .venv .mypy_cache .pytest_cache .ruff_cache .hypothesis *.egg-info build outputs/demo docs/_build
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
