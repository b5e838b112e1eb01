"""Builds the package with CMake, the core in it: python3 -m build --wheel --no-isolation

CMAKE_ARGS in the environment adds options for CMake, separated by spaces.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, find_packages, setup
from setuptools.command.build_ext import build_ext

SOURCES = pathlib.Path(__file__).resolve().parent.parent
# Beside the other builds, where ccache knows what they have compiled.
BUILD = SOURCES / f"build-wheel-{sys.implementation.cache_tag}"


def version():
    """That of the CMake project."""
    text = (SOURCES / "CMakeLists.txt").read_text()
    return re.search(r"project\(mrpt-hgmm VERSION ([0-9.]+)", text).group(1)


def openmp_of(module):
    """GCC's OpenMP library as the module finds it; None where it needs none."""
    needs = subprocess.run(["ldd", module], check=True, stdout=subprocess.PIPE, text=True).stdout
    found = re.search(r"libgomp\S* => (\S+)", needs)
    return found and found.group(1)


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        package = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve().parent
        package.mkdir(parents=True, exist_ok=True)
        shutil.copy(SOURCES / "LICENSE", package)
        subprocess.run(
            ["cmake", "-S", SOURCES, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
             "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=26",
             "-DCMAKE_BUILD_RPATH=$ORIGIN", "-DHGMM_BUILD_PYTHON=ON", "-DHGMM_BUILD_MRPT=OFF",
             "-DHGMM_BUILD_TESTS=OFF", "-DHGMM_BUILD_BENCH=OFF",
             f"-DPython_EXECUTABLE={sys.executable}", *os.environ.get("CMAKE_ARGS", "").split()],
            check=True)
        subprocess.run(["cmake", "--build", BUILD, "--target", "python-core"], check=True)
        for module in (BUILD / "python" / "hgmm").glob("_core*.so"):
            shutil.copy(module, package)
            # Of the libraries that the module needs, the one that not every system has.
            if openmp := openmp_of(module):
                shutil.copy(os.path.realpath(openmp), package / os.path.basename(openmp))


setup(version=version(), packages=find_packages(include=["hgmm", "hgmm.*"]),
      package_data={"hgmm.report": ["*.css"], "hgmm.view": ["web/*"]},
      ext_modules=[Extension("hgmm._core", sources=[])], cmdclass={"build_ext": CMakeBuild})
