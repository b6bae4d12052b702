"""Compiled kernels without the compiler: loading numba takes longer than most tests.

Numba compiles a kernel once, as a C function over pointers; its object code is kept in the cache of the core and
linked by llvmlite alone. Such a kernel must allocate nothing and raise nothing: it then needs no runtime of numba,
of which it still names functions that are never called; those names lead to `abort`.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import TypeAlias

import llvmlite.binding as llvm

from asphalt_nscd.nscd.core_cache import core_folder

Library: TypeAlias = llvm.ExecutionEngine
_loaded: list[Library] = []  # what is freed takes its functions with it


def native(name: str, build: Callable[[], tuple[str, str]]) -> int:
    """Address of a kernel for ctypes; `build` gives (symbol, LLVM assembly) if it is not compiled yet."""
    path = _folder() / f"{name}-{_machine()[1]}.native"
    content = _read(path)
    if content is None:
        content = _compile(*build())
        with suppress(OSError):  # where it cannot be kept, each job makes it
            _write(path, content)
    header, _, code = content.partition(b"\n")
    told = json.loads(header)
    library = ctypes.CDLL("msvcrt" if sys.platform == "win32" else None)  # None: what this process has loaded
    abort = ctypes.cast(library.abort, ctypes.c_void_p).value
    for symbol in told["foreign"]:
        if llvm.address_of_symbol(symbol) is None:
            llvm.add_symbol(symbol, abort)
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine()[0])
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    _loaded.append(engine)
    return int(engine.get_function_address(told["symbol"]))


def _compile(symbol: str, assembly: str) -> bytes:
    """What is kept of a kernel: a line of JSON (its symbol, the foreign names), then object code."""
    machine = _machine()[0]
    module = llvm.parse_assembly(assembly)
    named = [*module.functions, *module.global_variables]
    foreign = [item.name for item in named if item.is_declaration and not item.name.startswith("llvm.")]
    return json.dumps({"symbol": symbol, "foreign": foreign}).encode() + b"\n" + machine.emit_object(module)


@cache
def _machine() -> tuple[llvm.TargetMachine, str]:
    """This processor, and a name for it and for the version of LLVM."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    cpu, features = llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    target = llvm.Target.from_default_triple()
    machine = target.create_target_machine(
        cpu=cpu, features=features, opt=3, reloc="default", codemodel="jitdefault"
    )
    told = f"{target.triple} {cpu} {features} {llvm.llvm_version_info}"
    return machine, hashlib.sha256(told.encode()).hexdigest()[:16]


@cache
def _folder() -> Path:
    return Path(core_folder())


def _read(path: Path) -> bytes | None:
    """What was written, if it is there and whole: a processor would run anything."""
    try:
        digest, _, content = path.read_bytes().partition(b"\n")
    except OSError:
        return None
    return content if hashlib.sha256(content).hexdigest().encode() == digest else None


def _write(path: Path, content: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}-")
    try:
        # into a file of its own, renamed when whole: jobs side by side may write this kernel at once
        with os.fdopen(handle, "wb") as file:
            file.write(hashlib.sha256(content).hexdigest().encode() + b"\n" + content)
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
