"""The examples of node/examples, in every pairing of languages."""
import subprocess
import sys
import threading
import unittest

from bus import Bus
from programs import BUILD, SOURCE

EXAMPLES = SOURCE / "node/examples"


class Examples(unittest.TestCase):
    def pair(self, probe, planner):
        with Bus() as bus:
            bus.start_node()
            reader = bus.start(*planner(bus.results), stdout=subprocess.PIPE)
            writer = bus.start(*probe(bus.contacts))
            self.assertEqual(writer.wait(20), 0)
            silent = threading.Timer(20, reader.kill)  # ends the reading below
            silent.start()
            self.addCleanup(silent.cancel)
            line = ""
            while "ELLIPSE" not in line.upper():  # once enough of it has been touched
                line = reader.stdout.readline()
                self.assertTrue(line, "the planner has ended")
            self.assertIn("finger: ", line)
            reader.kill()
            reader.communicate()

    @staticmethod
    def python(name):
        return lambda endpoint: (sys.executable, EXAMPLES / f"{name}.py", "--endpoint", endpoint)

    @staticmethod
    def cpp(name):
        return lambda endpoint: (BUILD / f"node/examples/palpate_example_{name}", endpoint)

    def test_python_probe_and_planner(self):
        self.pair(self.python("probe"), self.python("planner"))

    def test_cpp_probe_and_planner(self):
        self.pair(self.cpp("probe"), self.cpp("planner"))

    def test_cpp_probe_and_python_planner(self):
        self.pair(self.cpp("probe"), self.python("planner"))


if __name__ == "__main__":
    unittest.main()
