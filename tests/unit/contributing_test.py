"""CONTRIBUTING.md is followed to the letter: its ctest commands find tests, its targets are there."""
import os
import pathlib
import re
import subprocess
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
TEXT = (SOURCE / "CONTRIBUTING.md").read_text()


class Contributing(unittest.TestCase):
    def test_each_ctest_command_finds_tests(self):
        commands = re.findall(r"ctest --test-dir build/strict (?:--\S+ )*(-[RL] \w+)", TEXT)
        self.assertGreaterEqual(len(commands), 2)
        for selection in commands:
            out = subprocess.run(["ctest", "--test-dir", os.environ["PALPATE_BUILD"], "-N", *selection.split()],
                                 capture_output=True, text=True, check=True).stdout
            self.assertGreater(int(re.search(r"Total Tests: (\d+)", out)[1]), 0, selection)

    def test_each_label_of_the_table_has_its_target(self):
        labels = re.findall(r"^\| `(\w+)` \| `tests_\w+` \|", TEXT, re.MULTILINE)
        self.assertGreaterEqual(len(labels), 5)
        made = re.search(r"foreach\(label ([\w ]+)\)", (SOURCE / "tests/CMakeLists.txt").read_text())[1].split()
        self.assertEqual(set(labels) - set(made), set())

    def test_each_path_is_there(self):
        for path in re.findall(r"`((?:core|node|proto|sim|tests)/[\w./]*\w)`", TEXT):
            self.assertTrue((SOURCE / path).exists(), path)


if __name__ == "__main__":
    unittest.main()
