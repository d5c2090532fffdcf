"""The examples of node/examples, in every pairing of languages."""
import subprocess
import sys
import threading
import unittest

from bus import Bus
from programs import BUILD, SOURCE, TOOL, run

EXAMPLES = SOURCE / "node/examples"


class Examples(unittest.TestCase):
    def pair(self, probe, planner, curve=False):
        with Bus("tcp" if curve else "ipc") as bus:
            keys = []
            if curve:
                for name in ("node", "us"):
                    self.assertEqual(run(TOOL, "keygen", bus.folder / name)[0], 0)
                bus.start_node("--curve-secret-key", bus.folder / "node.secret", "--allow-clients", bus.folder / "us.public")
                keys = [bus.folder / "us.secret", bus.folder / "node.public"]
            else:
                bus.start_node()
            reader = bus.start(*planner(bus.results, *keys), stdout=subprocess.PIPE)
            writer = bus.start(*probe(bus.contacts, *keys))
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
        def call(endpoint, *keys):
            flags = zip(("--curve-secret-key", "--curve-server-key"), keys)
            return (sys.executable, EXAMPLES / f"{name}.py", "--endpoint", endpoint, *(part for pair in flags for part in pair))
        return call

    @staticmethod
    def cpp(name):
        return lambda endpoint, *keys: (BUILD / f"node/examples/palpate_example_{name}", endpoint, *keys)

    def test_python_probe_and_planner(self):
        self.pair(self.python("probe"), self.python("planner"))

    def test_cpp_probe_and_planner(self):
        self.pair(self.cpp("probe"), self.cpp("planner"))

    def test_cpp_probe_and_python_planner(self):
        self.pair(self.cpp("probe"), self.python("planner"))

    def test_with_keys(self):
        self.pair(self.python("probe"), self.cpp("planner"), curve=True)
        self.pair(self.cpp("probe"), self.python("planner"), curve=True)

    def test_one_key_alone_is_refused(self):
        with Bus() as bus:
            self.assertEqual(run(TOOL, "keygen", bus.folder / "us")[0], 0)
            for call in (self.python("probe"), self.python("planner"), self.cpp("probe"), self.cpp("planner")):
                code, _, err = run(*call(bus.results, bus.folder / "us.secret"))
                self.assertEqual(code, 2, err)
                self.assertRegex(err, "give both or neither|the recognizer's public key file is not named")

    def test_wrong_usage_ends_in_a_line_that_says_so(self):
        for name in ("probe", "planner"):
            call = self.cpp(name)
            for wrong in ("tcp:/127.0.0.1:5581", "--nonsense"):
                code, out, err = run(*call(wrong))
                self.assertEqual((code, out), (2, ""), err)
                self.assertEqual(err.count("\n"), 1, err)
                self.assertIn(f'"{wrong}" is no endpoint', err)
            code, out, err = run(*call("--help"))
            self.assertEqual((code, err), (0, ""))
            self.assertIn("[ENDPOINT ", out)

    def test_who_waits_says_for_what(self):
        with Bus() as bus:
            for call in (self.python("probe"), self.python("planner"), self.cpp("probe"), self.cpp("planner")):
                waiting = bus.start(*call(bus.results), stderr=subprocess.PIPE)
                self.assertIn(bus.results, waiting.stderr.readline())
                waiting.kill()
                waiting.communicate()


if __name__ == "__main__":
    unittest.main()
