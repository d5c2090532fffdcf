"""A file, and the same file replayed to the node: the same answer where the part is recognised."""
import json
import math
import unittest

from bus import Bus, wait_for
from palpate.v1 import curve_pb2, recognition_pb2
from programs import SIM, SOURCE, TOOL, run


class SameAnswer(unittest.TestCase):
    def test_a_recognised_part_comes_out_the_same_from_both(self):
        for scene in ("ellipse", "parabola"):
            with Bus() as bus:
                path = bus.folder / "part.csv"
                self.assertEqual(run(SIM, SOURCE / f"sim/scenes/{scene}.textproto", "--csv", path)[0], 0)
                code, out, err = run(TOOL, "fit", path, "--format", "json")
                self.assertEqual(code, 0, err)
                offline = json.loads(out)
                bus.start_node()
                planner = bus.subscriber()
                self.assertEqual(run(TOOL, "replay", path, "--contacts", bus.contacts, "--fast")[0], 0)
                live = wait_for(planner, lambda a: a.sample_count == int(offline["sample_count"]))
                self.assertEqual(recognition_pb2.RecognitionStatus.Name(live.status), offline["status"])
                self.assertEqual(offline["status"], "RECOGNITION_STATUS_RECOGNIZED")
                self.assertEqual(curve_pb2.CurveClass.Name(live.curve_class), offline["curve_class"])
                # The samples are the same: the answers may differ by a part of their own uncertainty only.
                found = [v for _, v in live.parameters.ListFields()] + [live.pose.x_m, live.pose.y_m]
                other = [offline["parameters"][f.name] for f, _ in live.parameters.ListFields()]
                other += [offline["pose"]["x_m"], offline["pose"]["y_m"]]
                size = len(found) + 1
                for i, (one, two) in enumerate(zip(found, other)):
                    self.assertLess(abs(one - two), 0.1 * math.sqrt(live.covariance[i * (size + 1)]), (scene, i))


if __name__ == "__main__":
    unittest.main()
