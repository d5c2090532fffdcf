"""A file, and the same file replayed to the node: the same answer where the part is recognised."""
import json
import math
import unittest

from google.protobuf import json_format

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


    def test_the_papers_pipeline_is_selected_by_the_same_words(self):
        pipeline = ["--method", "tree", "--estimator", "two-round", "--window", "75", "--shift", "4",
                    "--relative-tolerance", "0.05"]
        with Bus() as bus:
            path = bus.folder / "part.csv"
            rows = ["probe,patch,x_m,y_m,sigma_m"]
            for patch, start in enumerate((0.2, 1.0, 2.3, 3.4)):
                for i in range(111):
                    t = start + 0.25 * i / 110
                    rows.append(f"finger,{patch},{0.3 + 0.025 * math.cos(t)!r},{0.0175 * math.sin(t)!r},1e-9")
            path.write_text("\n".join(rows) + "\n")
            code, out, err = run(TOOL, "fit", path, "--format", "json", *pipeline)
            self.assertEqual(code, 0, err)
            offline = json_format.Parse(out, recognition_pb2.Recognition(), ignore_unknown_fields=True)
            self.assertEqual(offline.curve_class, curve_pb2.CURVE_CLASS_ELLIPSE)
            self.assertEqual(offline.decisions[-1].threshold, 0.05)
            bus.start_node(*pipeline)
            planner = bus.subscriber()
            self.assertEqual(run(TOOL, "replay", path, "--contacts", bus.contacts, "--fast")[0], 0)
            live = wait_for(planner, lambda a: a.sample_count == offline.sample_count)
            for field in ("curve_class", "status", "parameters", "pose", "covariance", "decisions", "invariants"):
                self.assertEqual(getattr(live, field), getattr(offline, field), field)


if __name__ == "__main__":
    unittest.main()
