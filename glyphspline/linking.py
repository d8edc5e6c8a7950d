"""How code is put together: what compiled functions call is linked into what Python calls, and optimised there."""

from __future__ import annotations

from typing import Any

import llvmlite.binding as llvm
from numba.core.codegen import JITCodeLibrary

INLINED = 200
"""Instructions, before they are optimised, up to which LLVM decides whether a function becomes part of its callers.

It would take up every one that is called in one place. The interpolation of 300 vertices takes 1.1 times as long then,
and code takes a quarter longer to compile.
"""


class _KeptLibrary(JITCodeLibrary):  # type: ignore[misc, unused-ignore]
    """Code that is kept as machine code."""

    def __init__(self, codegen: Any) -> None:
        super().__init__(codegen, type(self).__name__)
        self.enable_object_caching()


class Linked(_KeptLibrary):
    """Code that is linked into that of its callers, and only there is optimised and made machine code.

    As it is nowhere called by itself, all that would be for nothing; and once more in the next caller above.
    """

    def _optimize_final_module(self) -> None:
        """Set the code aside for the callers, and make the rest of what is left: the places of environments."""
        self._finalize_dynamic_globals()
        whole = self._final_module
        places = [str(own) for own in whole.global_variables if own.name.startswith("_ZN08NumbaEnv")]
        for one in whole.functions:
            if not one.is_declaration and one.linkage == llvm.Linkage.external:
                one.linkage = "linkonce_odr"
        self._shared_module = whole
        self._final_module = llvm.parse_assembly("\n".join(places))
        self._final_module.name = whole.name


class Whole(_KeptLibrary):
    """Code that Python calls, with all that is linked into it.

    An array is eight numbers or more, and a curve is ten arrays. As nobody else calls the functions linked, LLVM leaves
    out the arguments that they do not use: a sharp fit takes three quarters of the time.
    """

    def _optimize_final_module(self) -> None:
        for one in self._final_module.functions:
            if not one.is_declaration and one.linkage == llvm.Linkage.linkonce_odr:
                one.linkage = "internal"
                if sum(1 for block in one.blocks for _ in block.instructions) > INLINED:
                    one.add_function_attribute("noinline")
        super()._optimize_final_module()
