"""cmake --install to a place of its own, and strangers' projects built against it."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from programs import BUILD, SOURCE
from strangers import ANSWERS, PROJECT, call, write_project


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="palpate-")
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.prefix = cls.folder / "prefix"
        call("cmake", "--install", BUILD, "--prefix", cls.prefix)
        cls.project = write_project(cls.folder / "stranger")
        cls.version = re.search(r"CMAKE_PROJECT_VERSION:STATIC=(\S+)", (BUILD / "CMakeCache.txt").read_text())[1]
        cls.libraries = next(cls.prefix.glob("lib/**/libpalpate_core.a")).parent

    def build(self, name, *arguments):
        build = self.folder / name
        call("cmake", "-S", self.project, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}", *arguments)
        call("cmake", "--build", build)
        for program, answer in ANSWERS.items():
            self.assertEqual(call(build / program), answer)
        return build

    def needed(self, program):
        return set(re.findall(r"NEEDED.*\[(.*)\]", call("readelf", "--dynamic", program)))

    def test_the_programs_run_from_there(self):
        for program in ("palpate", "palpate-node", "palpate-sim"):
            self.assertIn(self.version, call(self.prefix / "bin" / program, "--version"))

    def test_a_cmake_project_of_a_stranger_static(self):
        build = self.build("static")
        for program in ANSWERS:
            self.assertFalse([name for name in self.needed(build / program) if "palpate" in name])

    def test_a_cmake_project_of_a_stranger_shared(self):
        build = self.build("shared", "-DBUILD_SHARED_LIBS=ON")
        minor = ".".join(self.version.split(".")[:2])
        self.assertIn(f"libpalpate_core.so.{minor}", self.needed(build / "circle"))
        self.assertIn(f"libpalpate_client.so.{minor}", self.needed(build / "probe"))

    def test_a_shared_library_shows_what_its_headers_declare_and_no_more(self):
        headers = " ".join(path.read_text() for path in (self.prefix / "include").rglob("*.h"))
        declared = set(re.findall(r"\w+", headers))
        for name, most in (("core", 250), ("client", 2000)):
            lines = call("nm", "--dynamic", "--demangle", "--defined-only", self.libraries / f"libpalpate_{name}.so").splitlines()
            symbols = [line.split(maxsplit=2)[2] for line in lines]
            own = [symbol for symbol in symbols if not re.match(r"PALPATE_|descriptor_table_palpate_", symbol)]
            self.assertGreater(len(own), 50)
            self.assertLess(len(own), most)
            for symbol in own:
                self.assertRegex(symbol, r"^((vtable|typeinfo|typeinfo name) for )?palpate::")
                # palpate::Recognizer::add(...): each word of its name stands in a header.
                words = re.match(r"(?:.* for )?([\w:~]+)", symbol)[1].replace("~", "").split("::")
                self.assertTrue(set(filter(None, words)) <= declared | {"operator"}, symbol)
        # What is hidden: in the static library, behind no door.
        everything = call("nm", "--demangle", "--defined-only", self.libraries / "libpalpate_core.a")
        self.assertIn("palpate::fit_smooth_model(", everything)
        self.assertNotIn("palpate::fit_smooth_model(",
                         call("nm", "--dynamic", "--demangle", self.libraries / "libpalpate_core.so"))

    def test_a_component_that_there_is_not(self):
        project = write_project(self.folder / "bad", PROJECT.replace("core client", "core sphere"))
        with self.assertRaisesRegex(AssertionError, "sphere"):
            call("cmake", "-S", project, "-B", project / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}")

    def test_fetch_content(self):
        fetched = PROJECT.replace("find_package(palpate 0.1 REQUIRED COMPONENTS core client)", f"""
include(FetchContent)
FetchContent_Declare(palpate SOURCE_DIR {SOURCE})
FetchContent_MakeAvailable(palpate)
get_property(together TARGET palpate_core PROPERTY UNITY_BUILD)
file(WRITE ${{CMAKE_BINARY_DIR}}/unity "${{CMAKE_UNITY_BUILD}} ${{together}}")
""")
        project = write_project(self.folder / "fetching", fetched)
        build = project / "build"
        # Without optimisation: what is compiled costs seconds.
        call("cmake", "-S", project, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None")
        # Ours are compiled together, the stranger's are not; and nothing of ours is installed with the stranger's.
        self.assertEqual((build / "unity").read_text(), " ON")
        self.assertFalse(list(build.rglob("palpate-config.cmake")))
        plan = call("ninja", "-C", build, "-n")
        for ours in ("palpate-node", "palpate-sim", "palpate_qualification", "_test"):
            self.assertNotIn(ours, plan)
        # The stranger's files, which see our headers and generated ones, and a library of ours. All of it takes minutes.
        if not os.environ.get("PALPATE_FETCH_WHOLE"):
            objects = [f"CMakeFiles/{program}.dir/{program}.cpp.o" for program in ANSWERS]
            call("cmake", "--build", build, "--target", "palpate_topics", *objects)
            return
        call("cmake", "--build", build)
        for program, answer in ANSWERS.items():
            self.assertEqual(call(build / program), answer)

    def test_pkg_config(self):
        where = {"PKG_CONFIG_PATH": str(self.libraries / "pkgconfig")}
        for name, program in (("core", "circle"), ("client", "probe")):
            flags = call("pkg-config", "--cflags", "--libs", f"palpate-{name}", **where).split()
            call("g++", "-std=c++20", self.project / f"{program}.cpp", "-o", self.folder / name, *flags)
            self.assertEqual(call(self.folder / name, LD_LIBRARY_PATH=str(self.libraries)), ANSWERS[program])
            self.assertEqual(call("pkg-config", "--modversion", f"palpate-{name}", **where), self.version + "\n")

    def test_nothing_lies_beside_its_own_folder(self):
        self.assertEqual([p.name for p in (self.prefix / "include").iterdir()], ["palpate"])
        for header in (self.prefix / "include").rglob("*.h"):
            self.assertNotIn(str(SOURCE), header.read_text())

    def test_every_header_that_is_installed_stands_alone_with_its_own_folder(self):
        # Nothing includes what is not there: the doors' headers are all that is.
        folder = self.prefix / "include/palpate"
        for header in folder.rglob("*.h"):
            for name in re.findall(r'^#include "([^"]+)"', header.read_text(), re.MULTILINE):
                self.assertTrue((folder / name).is_file() or (folder.parent / name).is_file(), f"{header}: {name}")


if __name__ == "__main__":
    unittest.main()
