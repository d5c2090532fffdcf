"""A probe with lobes, drift and lag: qualified on a ring, its file given to the node, a part measured with it."""
import json
import math
import pathlib
import shutil
import signal
import time
import unittest

from bus import Bus, errors_in_sigmas, wait_for, wait_for_log
from palpate.v1 import recognition_pb2
from programs import NODE, SIM, SOURCE, TOOL, run

SCENES = SOURCE / "sim/scenes/calibration"

# All that a file must say: a probe without any error.
PERFECT = """artefact: "circle 0.025" sample_count: 400 verdict: QUALIFICATION_VERDICT_SUFFICIENT
offset_covariance_m2: 0 sigma_m { value: 1e-6 } deviation_m {} deviation_length_m {} spike_probability {} setup_m {}
"""


class ProbeFiles(unittest.TestCase):
    def done(self, *command):
        code, out, err = run(*command, timeout=120)
        self.assertEqual(code, 0, err)
        return out

    def qualified(self, folder):
        """A probe file and a recording of the ellipse, with the truth about it."""
        ring, part, file = folder / "ring.csv", folder / "part.csv", folder / "stylus.probe"
        self.done(SIM, SCENES / "ring.textproto", "--csv", ring)
        self.done(TOOL, "calibrate", ring, "--circle", "0.025", "--output", file)
        self.done(SIM, SCENES / "ellipse.textproto", "--csv", part, "--truth", folder / "truth.json")
        return file, part, json.loads((folder / "truth.json").read_text())

    def answer(self, bus, part, after=None):
        """The node's answer to the whole recording, which is replayed to it as a new object."""
        samples = len(part.read_text().splitlines()) - 1
        planner = bus.subscriber()
        self.done(TOOL, "replay", part, "--contacts", bus.contacts, "--fast")
        return wait_for(planner, lambda a: a.sample_count == samples and (after is None or a.object != after.object),
                        timeout_s=20)

    def test_the_node_measures_as_fit_does_and_says_by_which_file(self):
        with Bus() as bus:
            file, part, truth = self.qualified(bus.folder)
            offline = json.loads(self.done(TOOL, "fit", part, "--probe", file, "--format", "json"))
            bus.start_node("--probe-files", file)
            live = self.answer(bus, part)
            self.assertEqual(list(live.probe_files), [str(file)])
            self.assertEqual(offline["probe_files"], [str(file)])
            self.assertEqual(live.status, recognition_pb2.RECOGNITION_STATUS_RECOGNIZED)
            # The same samples, the same arithmetic; one offers its numbers in decimals.
            covariance = list(live.covariance)
            deviations = [math.sqrt(covariance[i * 6]) for i in range(5)]
            found = [live.parameters.a, live.parameters.b, live.pose.x_m, live.pose.y_m, live.pose.theta_rad]
            other = [offline["parameters"][name] for name in "ab"]
            other += [offline["pose"][name] for name in ("x_m", "y_m", "theta_rad")]
            for one, two, deviation in zip(found, other, deviations):
                self.assertLess(abs(one - two), 1e-6 * deviation)
            for one, two in zip(covariance, offline["covariance"]):
                self.assertLess(abs(one - two), 1e-6 * math.sqrt(max(covariance[::6])) ** 2)
            self.assertLess(max(map(abs, errors_in_sigmas(live, truth))), 4.0)

    def test_without_the_file_the_axes_are_off(self):
        with Bus() as bus:
            file, part, truth = self.qualified(bus.folder)
            errors = {}
            for options in ((), ("--probe-files", file)):
                node = bus.start_node(*options)
                live = self.answer(bus, part)
                errors[bool(options)] = max(abs(getattr(live.parameters, name) - truth["parameters"][name])
                                            for name in "ab")
                self.assertEqual(len(live.probe_files), len(options) // 2)
                node.send_signal(signal.SIGTERM)
                self.assertEqual(node.wait(5), 0)
            print(f"largest error of an axis: {1e6 * errors[False]:.1f} um without the probe file, "
                  f"{1e6 * errors[True]:.1f} um with it")
            # The offset is 30 um and its lobes 45: both are gone.
            self.assertGreater(errors[False], 20e-6)
            self.assertLess(errors[True], 5e-6)

    def test_a_given_class_is_measured_by_the_file_too(self):
        with Bus() as bus:
            file, part, truth = self.qualified(bus.folder)

            def fit(*options):
                out = self.done(TOOL, "fit", part, "--class", "ellipse", "--format", "json", *options)
                return json.loads(out)

            def error(answer):
                found = answer["recognition"]["parameters"]
                return max(abs(found[name] - truth["parameters"][name]) for name in "ab")

            # Least squares take spikes as they are: who gives the class says which those are.
            spikes = [str(i + 1) for i, r in enumerate(fit()["residual_m"]) if abs(r) > 3e-4]
            self.assertGreater(len(spikes), 0)
            left_out = ("--leave-out", ",".join(spikes))
            plain, measured = fit(*left_out), fit(*left_out, "--probe", file)
            print(f"given ellipse, largest error of an axis: {1e6 * error(plain):.1f} um without the probe file, "
                  f"{1e6 * error(measured):.1f} um with it")
            self.assertGreater(error(plain), 20e-6)
            self.assertLess(error(measured), 5e-6)
            self.assertEqual(measured["recognition"]["probe_files"], [str(file)])
            self.assertEqual(plain["recognition"]["probe_files"], [])
            covariance = measured["recognition"]["covariance"]
            for i, name in enumerate("ab"):
                off = measured["recognition"]["parameters"][name] - truth["parameters"][name]
                self.assertLess(abs(off), 4 * math.sqrt(covariance[6 * i]), name)
            self.assertTrue(any("white noise alone" in note for note in measured["notes"]))

    def test_a_known_part_is_not_placed_with_a_probe_file(self):
        code, out, err = run(TOOL, "fit", "none.csv", "--part", "none.textproto", "--probe", "none.probe")
        self.assertEqual((code, out), (2, ""))
        self.assertIn("--probe: not with --part", err)

    def test_a_probe_of_another_name_is_taken_as_it_is(self):
        with Bus() as bus:
            file, part, _ = self.qualified(bus.folder)
            file.write_text(file.read_text().replace('name: "stylus"', 'name: "other"'))
            node = bus.start_node("--probe-files", file)
            before = self.answer(bus, part)
            self.assertEqual(list(before.probe_files), [])
            # Read again with the right name, it holds from the next samples on.
            file.write_text(file.read_text().replace('name: "other"', 'name: "stylus"'))
            node.send_signal(signal.SIGHUP)
            wait_for_log(node, "1 probe files reread")
            self.assertEqual(list(self.answer(bus, part, after=before).probe_files), [str(file)])
            # One that cannot be used changes nothing.
            file.write_text("name: 3\n")
            node.send_signal(signal.SIGHUP)
            wait_for_log(node, f"probe files stay as they were: {file}:1:7")

    def test_a_file_without_a_name_is_for_all_others(self):
        with Bus() as bus:
            file, part, _ = self.qualified(bus.folder)
            file.write_text(file.read_text().replace('name: "stylus"\n', ""))
            other = bus.folder / "other.probe"
            shutil.copy(file, other)
            other.write_text('name: "other"\n' + other.read_text())
            bus.start_node("--probe-files", other, "--probe-files", file)
            self.assertEqual(list(self.answer(bus, part).probe_files), [str(file)])

    def test_what_cannot_be_used_is_named(self):
        with Bus() as bus:
            folder = pathlib.Path(bus.folder)
            good, bad = folder / "good.probe", folder / "bad.probe"
            good.write_text('name: "stylus"\n' + PERFECT)
            for text, said in (('name: "stylus"\ntip_radius_m: -1\n', f"{bad}:2: tip_radius_m"),
                               ("tip_radius: 1\n", f"{bad}:1:"),
                               ("", f"{bad}: artefact: is missing"),
                               ('name: "other"\n' + PERFECT.partition("setup_m")[0], f"{bad}: setup_m: is missing"),
                               ('name: "stylus"\n' + PERFECT, f"{bad}: name: stylus, and so in {good}")):
                bad.write_text(text)
                for more in ((), ("--check-config",)):
                    code, _, err = run(NODE, "--probe-files", good, "--probe-files", bad, *more)
                    self.assertEqual(code, 6, err)
                    self.assertIn(said, err)
            code, _, err = run(NODE, "--probe-files", folder / "none.probe")
            self.assertEqual(code, 6)
            self.assertIn("none.probe", err)
            config = folder / "node.textproto"
            config.write_text(f'probe_files: "{good}"\n')
            self.assertEqual(run(NODE, "--config", config, "--check-config")[0], 0)


if __name__ == "__main__":
    unittest.main()
