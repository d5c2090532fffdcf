"""Builds the extension by CMake. PALPATE_BUILD=FOLDER takes what is built there already."""
import os
import pathlib
import shutil
import subprocess
import sys

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

ROOT = pathlib.Path(__file__).resolve().parents[2]


class ByCMake(build_py):
    def run(self) -> None:
        folder = os.environ.get("PALPATE_BUILD")
        if folder is None:
            folder = str(ROOT / "build/wheel")
            options = ["CMAKE_BUILD_TYPE=Release", "PALPATE_BUILD_PYTHON=ON", "PALPATE_BUILD_NODE=OFF",
                       "PALPATE_BUILD_SIM=OFF", "PALPATE_BUILD_TESTS=OFF", f"Python_EXECUTABLE={sys.executable}"]
            subprocess.run(["cmake", "-S", str(ROOT), "-B", folder, *("-D" + option for option in options)], check=True)
            subprocess.run(["cmake", "--build", folder, "--parallel", str(os.cpu_count() or 1), "--target", "palpate_python"], check=True)
        prefix = ROOT / "build/wheel-contents"
        shutil.rmtree(prefix, ignore_errors=True)
        subprocess.run(["cmake", "--install", folder, "--prefix", str(prefix), "--component", "python"], check=True)
        self.copy_tree(str(prefix / "lib/python3/dist-packages"), self.build_lib)


class ForOnePython(Distribution):
    def has_ext_modules(self) -> bool:
        return True


def version() -> str:
    said = subprocess.run(["cmake", "-P", str(ROOT / "core/package/version.cmake")], check=True, capture_output=True, text=True)
    return said.stderr.strip()


(ROOT / "build").mkdir(exist_ok=True)
setup(version=version(),
      packages=["palpate"], cmdclass={"build_py": ByCMake}, distclass=ForOnePython,
      # Write nothing next to the sources.
      options={"build": {"build_base": str(ROOT / "build/wheel-parts")}, "egg_info": {"egg_base": str(ROOT / "build")}})
