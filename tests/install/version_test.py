"""The version by the nearest tag, in checkouts of our own making."""
import pathlib
import tempfile
import unittest

from programs import SOURCE
from strangers import call

SCRIPT = """
include({source}/core/package/version.cmake)
set(palpate_version_without_tag 9.8.7)
palpate_version_by_tag(version {folder})
file(WRITE {folder}/../version ${{version}})
"""


class Version(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="palpate-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name) / "checkout"
        self.folder.mkdir()

    def git(self, *arguments):
        call("git", "-C", self.folder, "-c", "user.name=test", "-c", "user.email=test@localhost", *arguments)

    def commit(self):
        self.git("commit", "--allow-empty", "--quiet", "--message", "a step")

    def version(self, folder=None):
        script = self.folder.parent / "script.cmake"
        script.write_text(SCRIPT.format(source=SOURCE, folder=folder or self.folder))
        call("cmake", "-P", script)
        return ((folder or self.folder) / "../version").resolve().read_text()

    def test_no_checkout_and_no_tag(self):
        self.assertEqual(self.version(), "9.8.7")
        self.git("init", "--quiet")
        self.assertEqual(self.version(), "9.8.7")
        self.commit()
        self.assertEqual(self.version(), "9.8.7")

    def test_the_nearest_tag_that_is_a_version(self):
        self.git("init", "--quiet")
        self.commit()
        self.git("tag", "v1.2.3")
        self.assertEqual(self.version(), "1.2.3")
        self.commit()
        self.git("tag", "nightly")
        self.git("tag", "v2-plan")
        self.commit()
        self.assertEqual(self.version(), "1.2.3.2")
        self.git("tag", "--annotate", "--message", "a release", "v1.10.0")
        self.assertEqual(self.version(), "1.10.0")

    def test_somebody_elses_checkout_around_it(self):
        self.git("init", "--quiet")
        self.commit()
        self.git("tag", "v5.0.0")
        inner = self.folder / "palpate"
        inner.mkdir()
        self.assertEqual(self.version(inner), "9.8.7")


if __name__ == "__main__":
    unittest.main()
