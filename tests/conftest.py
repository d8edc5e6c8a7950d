"""What `make test` leaves to `make test-all`: tests with the markers ``long`` and ``needs``, and many examples.

A test that ``needs`` libraries is skipped where one that it names is absent, and fails there under
``--require-libraries``.
"""

from __future__ import annotations

from importlib.util import find_spec

import pytest
from hypothesis import settings

OPTION = "--require-libraries"

settings.register_profile("quick", max_examples=25, deadline=None)
settings.register_profile("long", max_examples=300, deadline=None)
settings.load_profile("quick")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(OPTION, action="store_true", help="fail a test whose libraries are absent, instead of skipping it")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "needs(*modules): modules of libraries that only make test-all installs")


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    modules = [module for marker in item.iter_markers("needs") for module in marker.args]
    if missing := [module for module in modules if find_spec(module) is None]:
        absent = pytest.fail if item.config.getoption(OPTION) else pytest.skip
        absent(f"not installed: {', '.join(missing)} (make test-all)")
