"""Debian packages: made by cpack, clean under lintian, installed in a clean root and used from there."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from clean_root import MAY_NOT
from programs import BUILD
from strangers import ANSWERS, call, write_project

HERE = pathlib.Path(__file__).parent
# Beside what our packages depend on: a stranger's compiler and what reads the pages.
TOOLS = ("g++", "make", "cmake", "pkg-config", "python3")
# The gateway's where there was libnats.
NAMES = ("palpate", "libpalpate-dev", "python3-palpate") + (
    ("palpate-gateway",) if (BUILD / "node/gateway/palpate-gateway").exists() else ())

IN_THE_ROOT = """
set -e
dpkg --install /given/*.deb
# Every file as it was packed, none missing.
dpkg --verify {names}
test -z "$(dpkg --verify {names})"
cd /tmp
palpate-sim /usr/share/palpate/scenes/circle.textproto --csv - --object 1 | palpate fit - --format text | grep 'circle'
palpate-node --config /etc/palpate/node.textproto --check-config
if dpkg --status palpate-gateway >/dev/null 2>&1; then palpate-gateway --version && echo "the gateway runs"; fi
cp -r /given/stranger .
cmake -S stranger -B build >/dev/null
cmake --build build >/dev/null
for program in circle probe; do echo "cmake: $(build/$program)"; done
g++ -std=c++20 stranger/circle.cpp -o circle $(pkg-config --cflags --libs palpate-core)
echo "pkg-config: $(./circle)"
pkg-config --exists palpate-client
python3 - <<'END'
import math, palpate
from palpate.v1 import recognition_pb2
points = [[15 * math.cos(0.1 * i), 15 * math.sin(0.1 * i)] for i in range(60)]
print("python:", palpate.fit(points, sigma=0.001, unit="mm").curve_class, recognition_pb2.Recognition().ByteSize())
palpate.Probe, palpate.Planner
END
dpkg --purge {names} >/dev/null
for left in /usr/include/palpate /etc/palpate /usr/bin/palpate /usr/lib/python3/dist-packages/palpate; do
  if [ -e $left ]; then echo "left behind: $left"; fi
done
""".format(names=" ".join(NAMES))


class Deb(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for tool in ("cpack", "dpkg-deb", "dpkg-shlibdeps"):
            if shutil.which(tool) is None:
                raise unittest.SkipTest(f"{tool} is not installed")
        cls.temporary = tempfile.TemporaryDirectory(prefix="palpate-")
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        call("cpack", "--config", BUILD / "CPackConfig.cmake", "-G", "DEB", "-B", cls.folder)
        cls.packages = sorted(cls.folder.glob("*.deb"))

    def test_the_packages_are_these(self):
        self.assertEqual(sorted(call("dpkg-deb", "--field", package, "Package").strip() for package in self.packages),
                         sorted(NAMES))

    @unittest.skipUnless(shutil.which("lintian"), "lintian is not installed: nothing is said about the packages")
    def test_lintian_has_nothing_to_say(self):
        self.assertEqual(call("lintian", "--allow-root", "--fail-on", "error,warning", *self.packages), "")

    def test_in_a_clean_root(self):
        if os.geteuid() != 0 or subprocess.run(["unshare", "--mount", "true"], capture_output=True).returncode != 0:
            self.skipTest("only root may make a root")
        write_project(self.folder / "stranger")
        depends = {name.split("(")[0].split("|")[0].strip() for package in self.packages
                   for name in call("dpkg-deb", "--field", package, "Depends").split(",")}
        done = subprocess.run(["unshare", "--mount", "/usr/bin/python3", HERE / "clean_root.py", self.folder,
                               ",".join(sorted(depends - set(NAMES) | set(TOOLS))), "--", "sh", "-c", IN_THE_ROOT],
                              capture_output=True, text=True)
        if done.returncode == MAY_NOT:
            self.skipTest("this machine allows no root under an overlay")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        out = done.stdout
        for answer in ANSWERS.values():
            self.assertIn(f"cmake: {answer}", out)
        self.assertIn(f"pkg-config: {ANSWERS['circle']}", out)
        self.assertIn("python: circle 0\n", out)
        if "palpate-gateway" in NAMES:
            self.assertIn("the gateway runs\n", out)
        self.assertNotIn("left behind", out)


if __name__ == "__main__":
    unittest.main()
