"""API pages: of every header that is installed, without a warning."""
import re
import shutil
import unittest

from programs import BUILD
from strangers import call


class Api(unittest.TestCase):
    @unittest.skipUnless(shutil.which("doxygen"), "doxygen is not installed: no pages were made")
    def test_pages_without_a_warning(self):
        call("doxygen", BUILD / "Doxyfile")  # a warning is an error
        pages = BUILD / "api/html"
        named = " ".join(path.read_text(errors="replace") for path in pages.glob("class*.html"))
        for name in ("palpate::Recognizer", "palpate::client::ContactPublisher", "palpate::client::ResultSubscriber"):
            self.assertTrue(re.search(re.escape(name), named), name)


if __name__ == "__main__":
    unittest.main()
