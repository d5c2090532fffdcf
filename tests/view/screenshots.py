"""Makes the pictures of the README: the two-finger scene in light, dark and on a phone.

usage: screenshots.py FOLDER   (PALPATE_BUILD, PALPATE_SOURCE and PYTHONPATH as ctest sets them: tests/view/README.md)
"""
import pathlib
import sys
import time

from browser import Browser
from bus import Bus
from programs import SOURCE
from view_process import start_view

SCENE = SOURCE / "sim/scenes/two_finger_grasp.textproto"
PICTURES = {"view-light": (1280, 960, False), "view-dark": (1280, 960, True), "view-phone": (390, 844, False)}


def main(folder):
    for name, (width, height, dark) in PICTURES.items():
        with Bus() as bus, Browser(width, height, dark) as browser:
            bus.start_node()
            _, url = start_view(bus)
            browser.open(url)
            browser.wait("return document.querySelector('#link-state').textContent === 'live'")
            bus.simulate(SCENE)
            browser.wait("return document.querySelector('#class').dataset.status === 'recognized' && "
                         "document.querySelector('#sample-count').value === '242'")
            time.sleep(0.25)  # until the numbers beside are the last ones, and the probes not yet silent
            browser.screenshot(folder / f"{name}.png")
            print(folder / f"{name}.png", browser.problems())


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
