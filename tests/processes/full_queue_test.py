"""Messages faster than the recognizer reads: what has no room is not said to be published."""
import signal
import subprocess
import time
import unittest

import zmq
from bus import Bus
from programs import SIM, SOURCE, TOOL

SCENE = SOURCE / "sim/scenes/ellipse.textproto"
MESSAGES = 50_000  # more than all queues and the system's buffers hold


class FullQueue(unittest.TestCase):
    def said_to_a_recognizer_that_never_reads(self, bus, *command, stopped_after=None):
        """Its exit code, and what it said."""
        socket = bus.context.socket(zmq.SUB)
        socket.setsockopt(zmq.RCVHWM, 10)
        socket.setsockopt(zmq.LINGER, 0)
        socket.setsockopt_string(zmq.SUBSCRIBE, "contact/")
        socket.bind(command[command.index("--contacts") + 1])
        process = bus.start(*command, stderr=subprocess.PIPE)
        start = time.monotonic()
        while process.poll() is None:
            if stopped_after and time.monotonic() - start > stopped_after:
                process.send_signal(signal.SIGINT)
                stopped_after = None
            socket.get(zmq.EVENTS)  # libzmq's reader accepts and subscribes while it is asked for something
            time.sleep(0.01)
        return process.returncode, process.communicate()[1]

    def test_replay_as_fast_as_possible_waits_for_room_and_says_where_there_is_none(self):
        with Bus() as bus:
            table = bus.folder / "long.csv"
            table.write_text("x_m,y_m\n" + "".join(f"{1e-6 * i},0\n" for i in range(MESSAGES)))
            code, err = self.said_to_a_recognizer_that_never_reads(
                bus, TOOL, "replay", table, "--contacts", bus.contacts, "--fast", "--batch", "1", "--wait", "0.5")
            self.assertEqual(code, 1, err)
            self.assertIn("1 message not taken", err)

    def test_a_stop_while_it_waits_for_room_is_no_failure(self):
        with Bus() as bus:
            table = bus.folder / "long.csv"
            table.write_text("x_m,y_m\n" + "".join(f"{1e-6 * i},0\n" for i in range(MESSAGES)))
            code, err = self.said_to_a_recognizer_that_never_reads(
                bus, TOOL, "replay", table, "--contacts", bus.contacts, "--fast", "--batch", "1", "--wait", "60",
                stopped_after=3)
            self.assertEqual(code, 0, err)
            self.assertNotIn("not taken", err)

    def test_the_simulator_too(self):
        with Bus() as bus:
            code, err = self.said_to_a_recognizer_that_never_reads(
                bus, SIM, SCENE, "--contacts", bus.contacts, "--fast", "--wait", "0.5", "--pause", "0",
                "--repeat", MESSAGES, "--quiet")
            self.assertEqual(code, 1, err)
            self.assertIn("1 message not taken", err)
            code, err = self.said_to_a_recognizer_that_never_reads(
                bus, SIM, SCENE, "--contacts", f"ipc://{bus.folder}/other", "--fast", "--wait", "60", "--pause", "0",
                "--repeat", MESSAGES, "--quiet", stopped_after=3)
            self.assertEqual(code, 0, err)


if __name__ == "__main__":
    unittest.main()
