"""cmake --install to a place of its own, and strangers' projects built against it."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from programs import BUILD, SOURCE

CIRCLE = """
#include <palpate/recognizer.h>

#include <cmath>
#include <cstdio>
#include <vector>

int main() {
  std::vector<palpate::ContactSample> samples;
  for (int i = 0; i < 60; ++i) {
    samples.push_back({{0.1 + 0.02 * std::cos(0.1 * i), 0.02 * std::sin(0.1 * i)}, 1e-6, 0});
  }
  palpate::Recognizer recognizer;
  recognizer.add({}, samples);
  const palpate::Recognition answer = recognizer.recognize();
  std::printf("%s %.6f\\n", name_of(answer.shape.curve_class).data(), answer.shape.values[0]);
}
"""
PROBE = """
#include <palpate/client.h>

#include <cstdio>

int main() {
  palpate::client::ContactPublisherOptions options;
  options.endpoint = "ipc://nobody-listens-here";
  palpate::client::ContactPublisher publisher(options);
  std::printf("%d\\n", publisher.wait_for_recognizer(std::chrono::milliseconds(10)));
}
"""
PROJECT = """
cmake_minimum_required(VERSION 3.25)
project(stranger LANGUAGES CXX)
find_package(palpate 0.1 REQUIRED COMPONENTS core client)
add_executable(circle circle.cpp)
target_link_libraries(circle PRIVATE palpate::core)
add_executable(probe probe.cpp)
target_link_libraries(probe PRIVATE palpate::client)
"""


def call(*command, **environment):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, env=os.environ | environment)
    if done.returncode != 0:
        raise AssertionError(" ".join(map(str, command)) + "\n" + done.stdout + done.stderr)
    return done.stdout


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="palpate-")
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.prefix = cls.folder / "prefix"
        call("cmake", "--install", BUILD, "--prefix", cls.prefix)
        cls.project = cls.folder / "stranger"
        cls.project.mkdir()
        for name, text in (("circle.cpp", CIRCLE), ("probe.cpp", PROBE), ("CMakeLists.txt", PROJECT)):
            (cls.project / name).write_text(text)
        cls.version = re.search(r"project\(palpate VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text())[1]

    def test_the_programs_run_from_there(self):
        for program in ("palpate", "palpate-node", "palpate-sim"):
            self.assertIn(self.version, call(self.prefix / "bin" / program, "--version"))

    def test_a_cmake_project_of_a_stranger(self):
        build = self.project / "build"
        call("cmake", "-S", self.project, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}")
        call("cmake", "--build", build)
        self.assertEqual(call(build / "circle"), "circle 0.020000\n")
        self.assertEqual(call(build / "probe"), "0\n")

    def test_a_component_that_there_is_not(self):
        (self.project / "bad").mkdir()
        (self.project / "bad/CMakeLists.txt").write_text(PROJECT.replace("core client", "core sphere"))
        with self.assertRaisesRegex(AssertionError, "sphere"):
            call("cmake", "-S", self.project / "bad", "-B", self.project / "bad/build",
                 f"-DCMAKE_PREFIX_PATH={self.prefix}")

    def test_pkg_config(self):
        where = next(self.prefix.glob("lib*/**/pkgconfig"))
        for name, out in (("core", "circle 0.020000\n"), ("client", "0\n")):
            flags = call("pkg-config", "--cflags", "--libs", f"palpate-{name}", PKG_CONFIG_PATH=str(where)).split()
            source = self.project / ("circle.cpp" if name == "core" else "probe.cpp")
            program = self.folder / name
            call("g++", "-std=c++20", source, "-o", program, *flags)
            self.assertEqual(call(program), out)
            self.assertEqual(call("pkg-config", "--modversion", f"palpate-{name}", PKG_CONFIG_PATH=str(where)),
                             self.version + "\n")

    def test_nothing_lies_beside_its_own_folder(self):
        self.assertEqual([p.name for p in (self.prefix / "include").iterdir()], ["palpate"])
        for header in (self.prefix / "include").rglob("*.h"):
            self.assertNotIn(str(SOURCE), header.read_text())


if __name__ == "__main__":
    unittest.main()
