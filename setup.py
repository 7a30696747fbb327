"""Builds the Python package by CMake, for `pip install .`; pyproject.toml says the rest.

The environment variable CMAKE_ARGS has further arguments for CMake.
"""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
BUILD = ROOT / f"build-{sys.implementation.cache_tag}"  # everything that is made on the way


def version():
    """CMake's project knows it."""
    return re.search(r'#define LAMELLA_VERSION "(.*)"', (ROOT / "include/lamella/core/version.hpp").read_text(encoding="utf-8"))[1]


class CMakeBuild(build_ext):
    """The extension and the library in it, without the program and the tests."""

    def build_extension(self, extension):
        subprocess.run(
            ["cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", "-D", "CMAKE_BUILD_TYPE=Release",
             "-D", "LAMELLA_PYTHON=REQUIRED", "-D", f"Python3_EXECUTABLE={sys.executable}",
             "-D", "LAMELLA_APP=OFF", "-D", "LAMELLA_TESTS=OFF", "-D", "LAMELLA_INSTALL=OFF",
             *shlex.split(os.environ.get("CMAKE_ARGS", ""))],
            check=True,
        )
        subprocess.run(["cmake", "--build", BUILD, "--target", "lamella_python"], check=True)
        built = BUILD / "python" / "lamella" / Path(self.get_ext_filename(extension.name)).name
        target = Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(str(built), str(target))


BUILD.mkdir(parents=True, exist_ok=True)
setup(
    version=version(),
    ext_modules=[Extension("lamella._lamella", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    options={"build": {"build_base": str(BUILD)}, "egg_info": {"egg_base": str(BUILD)}},
)
