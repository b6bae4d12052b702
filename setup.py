"""What pyproject.toml cannot say: the wheel knows its commit, and a build leaves nothing behind."""

import atexit
import shutil
import sys
import tempfile
from pathlib import Path

from setuptools import setup
from setuptools.command.build import build
from setuptools.command.build_py import build_py

sys.path.insert(0, str(Path(__file__).parent / "src"))
from asphalt_nscd.files.commit import BUILT_FROM, commit  # noqa: E402


class Build(build):
    """In a folder that vanishes: modules that were deleted since must not come back from an old build/."""

    def initialize_options(self) -> None:
        super().initialize_options()
        self.build_base = tempfile.mkdtemp(prefix="asphalt-nscd-")
        atexit.register(shutil.rmtree, self.build_base, ignore_errors=True)


class BuildPy(build_py):
    """With the commit in a file."""

    def run(self) -> None:
        super().run()
        if not self.editable_mode:
            Path(self.build_lib, "asphalt_nscd", BUILT_FROM).write_text(commit() + "\n", encoding="utf-8")


setup(cmdclass={"build": Build, "build_py": BuildPy})
