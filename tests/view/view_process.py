"""palpate view as a process beside a node."""
import re
import subprocess

from programs import TOOL


def start_view(bus, *arguments):
    """Starts it on a port that the system picks; gives the process and its address."""
    view = bus.start(TOOL, "view", "--results", bus.results, "--listen", "127.0.0.1:0", *arguments,
                     stdout=subprocess.PIPE)
    line = view.stdout.readline()
    view.stdout.close()
    found = re.search(r"http://\S+", line)
    if not found:
        raise AssertionError("palpate view does not start: " + line)
    return view, found.group()
