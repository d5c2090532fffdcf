"""Start, stop, exit codes, and nothing lost that was received."""
import os
import signal
import unittest

from bus import Bus, Probe, stop, wait_for
from programs import NODE, SIM, SOURCE, run


class Lifecycle(unittest.TestCase):
    def test_stops_cleanly_within_half_a_second_even_with_a_planner_that_does_not_read(self):
        for with_signal in (signal.SIGINT, signal.SIGTERM):
            with Bus() as bus:
                node = bus.start_node()
                bus.subscriber("", high_water_mark=1)
                probe = Probe(bus.publisher())
                for number in range(200):
                    probe.send(probe.batch(10 * (number % 20), object_number=1 + number // 20))
                code, seconds = stop(node, with_signal)
                self.assertEqual(code, 0)
                self.assertLess(seconds, 0.5)

    def test_what_was_received_before_the_stop_is_answered(self):
        with Bus() as bus:
            node = bus.start_node()
            planner = bus.subscriber()
            probe = Probe(bus.publisher())
            probe.stroke()
            # On its way is not received: a round of the status tells that it has arrived.
            status = bus.subscriber("status/")
            wait_for(status, lambda s: s.samples_received == 200)
            stop(node)
            self.assertEqual(wait_for(planner, lambda a: a.sample_count == 200).sample_count, 200)

    def test_exit_codes(self):
        self.assertEqual(run(NODE, "--nonsense")[0], 2)
        for program, flag in ((NODE, "--insecure"), (SIM, "--quiet")):
            code, _, err = run(program, flag + "=maybe")
            self.assertEqual(code, 2)
            self.assertIn(flag[2:], err)
        code, out, err = run(NODE, "--max-groups", "0", "--check-config")
        self.assertEqual((code, out), (6, ""))
        self.assertIn("max_groups", err)
        self.assertEqual(run(NODE, "--check-config")[0], 0)
        # Beyond this machine without CURVE: only when said aloud.
        code, _, err = run(NODE, "--contacts", "tcp://0.0.0.0:5581", "--check-config")
        self.assertEqual(code, 6)
        self.assertIn("insecure", err)
        self.assertEqual(
            run(NODE, "--contacts", "tcp://0.0.0.0:5581", "--insecure", "--check-config")[0], 0)
        self.assertEqual(run(SIM, "absent.textproto")[0], 2)
        code, _, err = run(SIM, SOURCE / "sim/scenes/circle.textproto", "--contacts",
                           "ipc:///nonexistent/contacts", "--wait", "0.2")
        self.assertEqual(code, 1)
        self.assertIn("no recognizer", err)

    def test_an_endpoint_that_is_taken_is_refused(self):
        with Bus() as bus:
            bus.start_node()
            code, _, err = run(NODE, "--contacts", bus.contacts, "--results",
                               f"ipc://{bus.folder}/other")
            self.assertEqual(code, 1)
            self.assertIn(str(bus.folder), err)

    def test_a_name_that_cannot_be_bound_is_told_with_what_can(self):
        with Bus() as bus:
            code, _, err = run(NODE, "--contacts", "tcp://localhost:*", "--results", f"ipc://{bus.folder}/results")
            self.assertEqual(code, 1)
            self.assertIn("cannot bind to tcp://localhost:*", err)
            self.assertIn("name an interface or an address, such as 127.0.0.1", err)

    def test_a_configuration_file_and_its_errors(self):
        with Bus() as bus:
            config = bus.folder / "node.textproto"
            config.write_text('name: "cell"\nmax_groups: 3\n')
            code, out, _ = run(NODE, "--config", config, "--print-config")
            self.assertEqual(code, 0)
            self.assertIn('name: "cell"', out)
            config.write_text("name: \"cell\"\nmax_grups: 3\n")
            code, _, err = run(NODE, "--config", config, "--check-config")
            self.assertEqual(code, 6)
            self.assertIn(f"{config}:2:", err)

    def test_the_environment_names_the_file_and_what_it_misspells_is_told(self):
        with Bus() as bus:
            config = bus.folder / "node.textproto"
            config.write_text('name: "cell"\n')
            os.environ |= {"PALPATE_CONFIG": str(config), "PALPATE_WORKER": "2"}
            self.addCleanup(lambda: [os.environ.pop(name) for name in ("PALPATE_CONFIG", "PALPATE_WORKER")])
            code, out, err = run(NODE, "--print-config")
            self.assertEqual(code, 0)
            self.assertIn('name: "cell"', out)
            self.assertIn("PALPATE_WORKER is not read: no option has that name, did you mean PALPATE_WORKERS?", err)
            self.assertNotIn("PALPATE_CONFIG is not read", err)
            other = bus.folder / "other.textproto"
            other.write_text('name: "other"\n')
            self.assertIn('name: "other"', run(NODE, "--config", other, "--print-config")[1])
            config.unlink()
            code, _, err = run(NODE, "--check-config")
            self.assertEqual(code, 6)
            self.assertIn(str(config), err)


if __name__ == "__main__":
    unittest.main()
