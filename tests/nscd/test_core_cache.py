"""Whether a kernel is compiled already, which a long step says that is not."""

from __future__ import annotations

from pathlib import Path

from asphalt_nscd.nscd.core_cache import core_folder, is_compiled


def test_a_kernel_of_these_sources_is_found(monkeypatch, tmp_path):
    monkeypatch.setenv("ASPHALT_NSCD_CACHE", str(tmp_path))
    assert not is_compiled("granular.step")
    kept = Path(core_folder(), "spheres_0123")
    kept.mkdir(parents=True)
    (kept / "granular.stepping-9.py311.nbi").touch()
    assert not is_compiled("granular.step")
    (kept / "granular.step-9.py311.nbi").touch()
    assert is_compiled("granular.step")
