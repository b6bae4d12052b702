"""What pyproject.toml cannot say: wheel and sdist know their commit, and a build leaves nothing behind."""

import atexit
import shutil
import sys
import tempfile
from pathlib import Path

from setuptools import setup
from setuptools.command.build import build
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist

sys.path.insert(0, str(Path(__file__).parent / "src"))
from asphalt_nscd.files.commit import PACKED_FROM, commit  # noqa: E402


def note_commit(package):
    path = Path(package, PACKED_FROM)
    path.unlink(missing_ok=True)  # may be a link to the file of the repository
    path.write_text(commit() + "\n", encoding="utf-8")


class Build(build):
    """In a folder that vanishes: modules that were deleted since must not come back from an old build/."""

    def initialize_options(self):
        super().initialize_options()
        self.build_base = tempfile.mkdtemp(prefix="asphalt-nscd-")
        atexit.register(shutil.rmtree, self.build_base, ignore_errors=True)


class BuildPy(build_py):
    def run(self):
        super().run()
        if not self.editable_mode:
            note_commit(Path(self.build_lib, "asphalt_nscd"))


class Sdist(sdist):
    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        note_commit(Path(base_dir, "src/asphalt_nscd"))


setup(cmdclass={"build": Build, "build_py": BuildPy, "sdist": Sdist})
