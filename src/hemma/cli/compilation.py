"""Compiled code is kept between runs: the second run of a command need not compile again."""

import hashlib
import os
import platform
from pathlib import Path


def keep_compiled_code() -> None:
    """Switch on JAX's persistent compilation cache, unless the user chose a folder for it or it cannot be.

    The folder is ``$XDG_CACHE_HOME/hemma`` (``~/.cache/hemma``), apart for each kind of processor, since
    code compiled for one may not run on another that shares the home directory. ``HEMMA_CACHE=off`` leaves
    it off.
    """
    if "JAX_COMPILATION_CACHE_DIR" in os.environ or os.environ.get("HEMMA_CACHE") == "off":
        return
    try:
        folder = _folder()
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, RuntimeError):  # no home directory is a RuntimeError
        return
    if os.access(folder, os.W_OK):
        import jax

        jax.config.update("jax_compilation_cache_dir", str(folder))


def _folder() -> Path:
    base = os.environ.get("XDG_CACHE_HOME")
    root = Path(base) if base and Path(base).is_absolute() else Path.home() / ".cache"
    return root / "hemma" / f"compiled-{processor()}"


def processor() -> str:
    """A short name for what the processor can do, and for the threads that code is compiled for."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    abilities = [line for line in lines if line.startswith(("flags", "Features", "model name"))][:2]
    threads = os.environ.get("NPROC", "")
    text = "\n".join([platform.system(), platform.machine(), platform.processor(), threads, *abilities])
    return hashlib.sha256(text.encode()).hexdigest()[:12]
