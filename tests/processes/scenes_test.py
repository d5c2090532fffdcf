"""Simulator, node and planner as processes, for every scene that ships."""
import json
import unittest

from bus import Bus, errors_in_sigmas, wait_for
from palpate.v1 import curve_pb2, recognition_pb2
from programs import SOURCE

SCENES = sorted((SOURCE / "sim/scenes").glob("*.textproto"))


class Scenes(unittest.TestCase):
    def play(self, transport):
        with Bus(transport) as bus:
            bus.start_node()
            planner = bus.subscriber()
            for scene in SCENES:
                with self.subTest(scene=scene.stem, transport=transport):
                    truth_path = bus.folder / f"{scene.stem}.json"
                    bus.simulate(scene, "--fast", "--truth", truth_path)
                    for line in truth_path.read_text().splitlines():
                        self.check(planner, json.loads(line))

    def check(self, planner, truth):
        def complete(answer):
            return (answer.group == truth["group"] and answer.object == int(truth["object"]) and
                    answer.sample_count == int(truth["sample_count"]))

        answer = wait_for(planner, complete)
        self.assertEqual(curve_pb2.CurveClass.Name(answer.curve_class), truth["curve_class"])
        self.assertEqual(answer.status, recognition_pb2.RECOGNITION_STATUS_RECOGNIZED)
        self.assertGreater(answer.compute_ns, 0)
        if truth["curve_class"] in ("CURVE_CLASS_UNCLASSIFIED", "CURVE_CLASS_LINE"):
            return  # a line is free to slide: tests/unit/sim/scenes_test.cpp compares it
        for error in errors_in_sigmas(answer, truth):
            self.assertLess(abs(error), 4)

    def test_over_ipc(self):
        self.play("ipc")

    def test_over_tcp(self):
        self.play("tcp")


if __name__ == "__main__":
    unittest.main()
