"""The marker ``needs``: tests of libraries that ``make test`` does not install, and ``make test-extras`` does.

A test is skipped where a library that it names is absent, and fails there under ``--require-libraries``.
"""

from __future__ import annotations

from importlib.util import find_spec

import pytest

OPTION = "--require-libraries"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(OPTION, action="store_true", help="fail a test whose libraries are absent, instead of skipping it")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "needs(*modules): modules of libraries that only make test-extras installs")


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    modules = [module for marker in item.iter_markers("needs") for module in marker.args]
    if missing := [module for module in modules if find_spec(module) is None]:
        absent = pytest.fail if item.config.getoption(OPTION) else pytest.skip
        absent(f"not installed: {', '.join(missing)} (make test-extras)")
