"""Simulator, node, palpate view and a real browser: what the page shows is what the subscriber gets."""
import json
import math
import os
import pathlib
import signal
import sys
import tempfile
import time
import unittest
import urllib.request

import zmq

import browser as chromium
from browser import Browser
from bus import Bus, Probe, wait_for
from canonical import point_on
from palpate.v1 import curve_pb2, recognition_pb2
from programs import SIM, SOURCE, TOOL, run
from view_process import start_view

SCENES = sorted((SOURCE / "sim/scenes").glob("*.textproto"))
SPACE = " "

# Places of the drawn curve, in pixels of the picture.
DRAWN_CURVE = """
const path = document.getElementById('curve-path'), plane = document.getElementById('plane');
const matrix = path.getCTM(), length = path.getTotalLength(), places = [];
for (let i = 0; i <= 4000; ++i) {
  const p = path.getPointAtLength(length * i / 4000).matrixTransform(matrix);
  places.push([p.x, p.y]);
}
return places;
"""
# World coordinates in metres to pixels of the picture.
TO_PIXELS = """
const matrix = document.getElementById('curve-path').getCTM();
const [points, origin] = arguments;
return points.map(([x, y]) => {
  const p = new DOMPoint(1000 * (x - origin[0]), -1000 * (y - origin[1])).matrixTransform(matrix);
  return [p.x, p.y];
});
"""
QUANTITIES = """
return Object.fromEntries([...document.querySelectorAll('#quantities data')].map(
    (cell) => [cell.id, [cell.value, cell.dataset.sigma ?? '']]));
"""


def distance_to_path(point, path):
    """Least distance of a point from a polyline."""
    best = math.inf
    for (x0, y0), (x1, y1) in zip(path, path[1:]):
        dx, dy = x1 - x0, y1 - y0
        length = dx * dx + dy * dy
        part = 0 if length == 0 else max(0, min(1, ((point[0] - x0) * dx + (point[1] - y0) * dy) / length))
        best = min(best, math.hypot(point[0] - x0 - part * dx, point[1] - y0 - part * dy))
    return best


def patch_range(patch, contacts):
    """Canonical curve parameters between which a patch lies. A patch of a closed spline has the spline's own
    instead: its contacts tell where they are, as (t^2, a t^3 + b t^2 + c t) gives t."""
    if patch["curve_class"] != "CURVE_CLASS_CUBIC_SPLINE":
        return patch["start_t"], patch["end_t"]
    a, b, c = (patch["parameters"][letter] for letter in "abc")
    pose = patch["pose"]
    cosine, sine = math.cos(pose.get("theta_rad", 0.0)), math.sin(pose.get("theta_rad", 0.0))
    found = []
    for contact in contacts:
        x, y = contact.x_m - pose.get("x_m", 0.0), contact.y_m - pose.get("y_m", 0.0)
        u, v = cosine * x + sine * y, -sine * x + cosine * y
        found.append((v - b * u) / (a * u + c))
    return min(found), max(found)


class View(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = cls.enterClassContext(Browser())

    def look(self, bus, *fragment):
        """A node, the view, and the page open on it."""
        node = bus.start_node()
        view, url = start_view(bus)
        self.browser.open("about:blank")
        self.browser.open(url + "/" + "".join(fragment))
        self.browser.wait("return document.querySelector('#link-state').textContent === 'live'")
        return node, view, url

    def choose(self, group):
        self.browser.wait("const select = document.querySelector('#group'); select.value = arguments[0]; "
                          "if (select.value === arguments[0]) select.onchange(); "
                          "return select.value === arguments[0]", group)

    def tearDown(self):
        self.assertEqual(self.expected_problems(self.browser.problems()), [])

    @staticmethod
    def expected_problems(problems):
        # The page says on its own that the server is gone; the browser notes each try.
        return [p for p in problems if "WebSocket connection to" not in p]

    def test_every_scene_is_shown_as_the_subscriber_gets_it_and_to_a_pixel(self):
        with Bus() as bus:
            self.look(bus)
            planner = bus.subscriber()
            for scene in SCENES:
                with self.subTest(scene=scene.stem):
                    truth_path = bus.folder / f"{scene.stem}.json"
                    bus.simulate(scene, "--fast", "--truth", truth_path)
                    for line in truth_path.read_text().splitlines():
                        self.check_scene(planner, json.loads(line))

    def check_scene(self, planner, truth):
        answer = wait_for(planner, lambda a: a.group == truth["group"] and a.object == int(truth["object"]) and
                          a.sample_count == int(truth["sample_count"]))
        self.choose(answer.group)
        self.browser.wait("return document.querySelector('#save-csv').href.endsWith(arguments[0]) && "
                          "document.querySelector('#sample-count')?.value === arguments[1] && "
                          "document.querySelector('#class').dataset.status === 'recognized' && "
                          "window.palpateObject === arguments[2]",
                          f"/{answer.group}.csv", str(answer.sample_count), str(answer.object))
        name = curve_pb2.CurveClass.Name(answer.curve_class).removeprefix("CURVE_CLASS_").lower()
        self.assertEqual(self.browser.text("#class").replace("-", "_").replace(" ", "_"), name)
        shown = self.browser.run(QUANTITIES)
        expected = {letter: getattr(answer.parameters, letter) for letter in "abc"
                    if answer.parameters.HasField(letter)}
        if answer.HasField("pose"):
            expected |= {"x": answer.pose.x_m, "y": answer.pose.y_m, "theta": answer.pose.theta_rad}
        size = len(expected)
        for i, (key, value) in enumerate(expected.items()):
            # Exactly: the page keeps every digit.
            self.assertEqual(float(shown[f"quantity-{key}"][0]), value)
            sigma = math.sqrt(max(answer.covariance[i * size + i], 0.0))
            self.assertAlmostEqual(float(shown[f"quantity-{key}"][1] or "inf"), sigma, delta=1e-12 * sigma)
        self.assertEqual(len(shown), size + 1)  # and the number of samples
        best = self.browser.run("return document.querySelector('#hypotheses data').value")
        self.assertEqual(float(best), answer.hypotheses[0].probability)
        if answer.HasField("pose"):
            self.check_curve(truth, answer)

    def check_curve(self, truth, answer):
        """The true curve along everything that was touched, within a pixel of the drawn one."""
        origin = self.browser.run("return window.palpateOrigin")
        drawn = self.browser.run(DRAWN_CURVE)
        points = []
        for patch in truth["patches"]:
            contacts = [c for c in answer.contacts if (c.probe, c.patch) == (patch["probe"], patch["patch"])]
            start, end = patch_range(patch, contacts)
            for i in range(21):
                t = start + (end - start) * i / 20
                points.append(point_on(patch["curve_class"], patch.get("parameters", {}), patch["pose"], t))
        self.assertGreater(len(points), 20)
        for pixel in self.browser.run(TO_PIXELS, points, origin):
            self.assertLess(distance_to_path(pixel, drawn), 1.0)

    def test_a_silent_probe_is_shown(self):
        with Bus() as bus:
            self.look(bus)
            status = bus.subscriber("status/")
            sim = bus.start(SIM, "--contacts", bus.contacts, "--quiet", "--repeat", "0", "--pause", "0",
                            SOURCE / "sim/scenes/circle.textproto")
            alive = "return document.querySelector('tr[data-probe=finger]')?.innerText.includes('alive')"
            self.browser.wait(alive)
            sim.send_signal(signal.SIGSTOP)
            frozen = time.monotonic()
            wait_for(status, lambda s: s.probes and not s.probes[0].alive)
            said = time.monotonic()
            self.browser.wait("return document.querySelector('tr[data-probe=finger]').innerText.includes('silent')")
            shown = time.monotonic()
            print(f"silent probe: the node says so after {said - frozen:.2f} s, the page {shown - said:.2f} s later")
            self.assertLess(shown - frozen, 1.0)
            sim.send_signal(signal.SIGCONT)
            self.browser.wait(alive)

    def test_a_restarted_node_is_picked_up_without_a_reload(self):
        with Bus() as bus:
            node, _, _ = self.look(bus)
            self.browser.run("window.sameLoad = true")
            bus.simulate(SOURCE / "sim/scenes/circle.textproto", "--fast")
            self.browser.wait("return document.querySelector('#class').textContent === 'circle'")
            node.kill()
            node.wait()
            self.browser.wait("return document.querySelector('#link-state').textContent.startsWith("
                              "'recognizer silent for')")
            bus.start_node()
            bus.simulate(SOURCE / "sim/scenes/ellipse.textproto", "--fast")
            self.browser.wait("return document.querySelector('#class').textContent === 'ellipse' && "
                              "document.querySelector('#link-state').textContent === 'live'")
            self.assertTrue(self.browser.run("return window.sameLoad"))

    def test_a_restarted_view_is_picked_up_without_a_reload(self):
        with Bus() as bus:
            _, view, url = self.look(bus)
            self.browser.run("window.sameLoad = true")
            view.kill()
            view.wait()
            self.browser.wait("return document.querySelector('#link-state').className === 'bad'")
            again = bus.start(TOOL, "view", "--results", bus.results, "--listen", url.removeprefix("http://"))
            self.browser.wait("return document.querySelector('#link-state').textContent === 'live'")
            self.assertTrue(self.browser.run("return window.sameLoad"))
            again.terminate()
            self.assertEqual(again.wait(5), 0)

    def test_an_object_change_clears_what_was_felt_before(self):
        dots = "return [...document.querySelectorAll('#plane path.samples')].reduce(" \
               "(sum, path) => sum + path.getAttribute('d').split('M').length - 1, 0) === arguments[0]"
        with Bus() as bus:
            self.look(bus)
            probe = Probe(bus.publisher())
            probe.stroke()
            self.browser.wait("return document.querySelector('#class').textContent === 'circle'")
            self.browser.wait(dots, 200)
            probe.send(probe.batch(0, count=2, object_number=2))
            self.browser.wait(dots, 2)
            self.browser.wait("return document.querySelector('#class').textContent === 'nothing yet' && "
                              "document.querySelector('#curve-path').getAttribute('d') === ''")

    def test_a_place_that_is_the_only_one_is_drawn_at_the_scale_of_a_hand(self):
        for count in (1, 20):
            with self.subTest(count=count), Bus() as bus:
                self.look(bus)
                probe = Probe(bus.publisher())
                batch = probe.batch(0, count=1)
                for _ in range(1, count):
                    batch.samples.append(batch.samples[0])
                probe.send(batch)
                self.browser.wait("return document.querySelector('#plane path.samples')")
                scale = self.browser.run("return document.querySelector('#plane .world').transform.baseVal[0].matrix.a")
                self.assertLess(scale, 1000)  # pixels per mm
                self.assertGreater(scale, 1)

    def test_labels_are_on_the_page_and_tell_their_ticks_apart_wherever_the_part_lies(self):
        labels = "return [...document.querySelectorAll('#plane .grid text:not(.unit)')].map((text) => { " \
                 "const box = text.getBBox(); return [text.textContent, text.getAttribute('text-anchor'), box.x]; })"
        charts = "return ['curvature', 'signature'].flatMap((chart) => [...document.querySelectorAll(" \
                 "`#${chart} .grid text:not([transform])`)].map((text) => { const box = text.getBBox(); " \
                 "return [text.textContent, box.x, text.ownerSVGElement.viewBox.baseVal.width - box.x - box.width]; }))"
        for at, step, unit in ((0.0, 1e-3, "mm"), (1e3, 1e-3, "x − 1000000 mm"), (1e5, 1e-3, "x − 100000000 mm"),
                               (-1e5, 1.0, "x + 100000 m"), (0.3, 1e-8, "x − 300000000 nm"), (0.0, 1e3, "km")):
            with self.subTest(at=at, step=step), Bus() as bus:
                self.look(bus)
                probe = Probe(bus.publisher())
                batch = probe.batch(0, count=1)
                del batch.samples[:]
                for i in range(60):
                    batch.samples.add(x_m=at + step * i, y_m=-at + 2e-2 * step * i * i, sigma_m=1e-3 * step)
                probe.send(batch)
                self.browser.wait("return document.querySelector('#sample-count')?.value === '60'")
                said = "return document.querySelector('#plane .grid .unit').textContent"
                self.assertEqual(self.browser.run(said), unit)
                shown = self.browser.run(labels)
                for anchor in ("middle", "end"):
                    texts = [text for text, its, _ in shown if its == anchor]
                    self.assertGreater(len(texts), 2)
                    self.assertEqual(len(set(texts)), len(texts), texts)
                for text, _, x in shown:
                    self.assertGreaterEqual(x, 0, text)
                for text, before, after in self.browser.run(charts):
                    self.assertGreaterEqual(min(before, after), 0, text)

    def test_a_band_wider_than_the_part_is_drawn_within_it(self):
        # Of a circle of 20 mm: at its centre, between it and there, on it, outside.
        covered = "const band = document.querySelector('#plane .band'), [x0, y0] = window.palpateOrigin; " \
                  "return [0, 7, 14, 20.5, 25].map((x) => " \
                  "band.isPointInFill(new DOMPoint(x - 1000 * x0, 0.1 + 1000 * y0)))"
        for sigma, expected in ((1e-3, [False, False, False, True, False]), (0.05, [True] * 5)):
            with self.subTest(sigma=sigma), Bus() as bus:
                false_node = bus.context.socket(zmq.XPUB)
                false_node.setsockopt(zmq.XPUB_VERBOSE, 1)
                false_node.bind(bus.results)
                _, url = start_view(bus)
                self.browser.open("about:blank")
                self.browser.open(url)
                for _ in range(3):  # recognitions, status, contacts
                    self.assertTrue(false_node.poll(10000))
                    false_node.recv()
                answer = recognition_pb2.Recognition(group="part", object=1, curve_class=curve_pb2.CURVE_CLASS_CIRCLE,
                                                     status=recognition_pb2.RECOGNITION_STATUS_AMBIGUOUS)
                answer.header.source, answer.header.epoch = "node", 1
                answer.parameters.a = 0.02
                answer.pose.x_m = 0.0
                answer.hypotheses.add(curve_class=answer.curve_class, probability=1.0)
                for k in range(8):
                    angle = 2 * math.pi * k / 8
                    answer.contacts.add(probe="p", x_m=0.02 * math.cos(angle), y_m=0.02 * math.sin(angle), t=angle)
                answer.covariance.extend(sigma ** 2 if i in (0, 5, 10) else 0.0 for i in range(16))
                false_node.send_multipart([b"recognition/part/", answer.SerializeToString()])
                self.browser.wait("return document.querySelector('#plane .band')?.getAttribute('d')")
                # Drawn from the first contact on.
                self.browser.wait("return window.palpateOrigin")
                self.assertEqual(self.browser.run(covered), expected)

    def test_pause_scrub_and_go_on(self):
        with Bus() as bus:
            self.look(bus)
            bus.simulate(SOURCE / "sim/scenes/circle.textproto", "--speed", "0.5")
            self.browser.wait("return document.querySelector('#class').textContent === 'circle'")
            total = self.browser.run("return document.querySelector('#sample-count').value")
            self.browser.press(SPACE)
            self.browser.wait("return !document.querySelector('#past').hidden")
            self.browser.wait("return Number(document.querySelector('#scrub').max) > 3")
            # Back to the first moments: less was known.
            self.browser.run("const scrub = document.querySelector('#scrub'); scrub.value = 1; scrub.oninput()")
            early = self.browser.wait("const count = document.querySelector('#sample-count')?.value; "
                                      "return Number(count) < arguments[0] && count", int(total))
            # A link to it shows it to whoever comes later, though the part has been another one since.
            link = self.browser.wait("return location.hash.includes('at=') && location.href")
            # What comes meanwhile is shown when the picture goes on.
            bus.simulate(SOURCE / "sim/scenes/ellipse.textproto", "--fast")
            time.sleep(0.3)
            self.assertNotEqual(self.browser.text("#class"), "ellipse")
            self.browser.run("document.querySelector('#resume').click()")
            self.browser.wait("return document.querySelector('#class').textContent === 'ellipse'")
            self.assertNotIn("at=", self.browser.run("return location.hash"))
            with Browser() as other:
                other.open(link)
                other.wait("return document.querySelector('#sample-count')?.value === arguments[0]", early)
                self.assertFalse(other.run("return document.querySelector('#past').hidden"))
                dots = other.run("return [...document.querySelectorAll('#plane path.samples')].reduce("
                                 "(sum, path) => sum + path.getAttribute('d').split('M').length - 1, 0)")
                self.assertEqual(dots, int(early))
                # The slider goes as far as the page's own group does, before this page was opened.
                self.assertEqual(other.run("return document.querySelector('#scrub').value"), "1")
                other.run("document.querySelector('#resume').click()")
                other.wait("return document.querySelector('#class').textContent === 'ellipse'")
                self.assertEqual(other.problems(), [])

    def test_a_link_reproduces_the_view(self):
        with Bus() as bus:
            _, _, url = self.look(bus)
            bus.simulate(SOURCE / "sim/scenes/circle.textproto", "--fast")
            bus.simulate(SOURCE / "sim/scenes/two_finger_grasp.textproto", "--fast")
            self.browser.wait("return document.querySelector('#group').options.length === 3")
            self.choose("part")
            self.browser.run("document.querySelector('#zoom-in').click();"
                             "document.querySelector('input[name=residuals]').click();"
                             "document.querySelector('input[name=tips]').click()")
            self.browser.wait("return document.querySelector('#class').textContent === 'circle'")
            place = "return document.querySelector('#plane .world').getAttribute('transform').match(/[-0-9.e]+/g).map(Number)"
            link, before = self.browser.run("return location.hash"), self.browser.run(place)
            self.assertIn("group=part", link)
            self.browser.open("about:blank")
            self.browser.open(url + "/" + link)
            self.browser.wait("return document.querySelector('#class').textContent === 'circle'")
            self.assertEqual(self.browser.run("return location.hash"), link)
            for now, then in zip(self.browser.run(place), before):
                self.assertAlmostEqual(now, then, delta=1e-3)  # a thousandth of a pixel
            self.assertEqual(self.browser.run("return document.querySelector('#plane').getAttribute('class')"),
                             "hide-tips")

    def test_what_is_saved_is_what_was_seen(self):
        with Bus() as bus, tempfile.TemporaryDirectory() as folder:
            _, _, url = self.look(bus)
            bus.simulate(SOURCE / "sim/scenes/two_finger_grasp.textproto", "--fast")
            self.browser.wait("return document.querySelector('#sample-count')?.value === '242'")
            path = pathlib.Path(folder) / "saved.csv"
            self.assertEqual(self.browser.run("return document.querySelector('#save-csv').href"),
                             url + "/samples/grasp.csv")
            path.write_bytes(urllib.request.urlopen(url + "/samples/grasp.csv").read())
            code, out, err = run(TOOL, "fit", path)
            self.assertEqual(code, 0, err)
            fitted = json.loads(out)
            with urllib.request.urlopen(url + "/answer/grasp.json") as reply:
                answer = json.load(reply)
            self.assertEqual((fitted["group"], fitted["sample_count"], fitted["curve_class"]),
                             ("grasp", "242", answer["curve_class"]))
            svg = self.browser.run("return import('/saving.js').then((saving) => "
                                   "saving.standalone(document.querySelector('#plane'), 'a <b>'))")
            self.assertIn("<title>a &lt;b&gt;</title>", svg)
            self.assertNotIn("class=", svg)

    def test_hostile_messages_stay_text(self):
        evil = "<img src=x onerror='window.hacked=1'><script>window.hacked=1</script>"
        with Bus() as bus:
            node, view, _ = self.look(bus)
            node.kill()
            node.wait()
            false_node = bus.context.socket(zmq.XPUB)
            false_node.setsockopt(zmq.XPUB_VERBOSE, 1)
            false_node.bind(bus.results)
            for _ in range(3):  # recognitions, status, contacts
                self.assertTrue(false_node.poll(10000))
                false_node.recv()
            answer = recognition_pb2.Recognition(group="part", object=1)
            answer.header.source, answer.header.epoch = "node", 1
            answer.header.frame = evil
            answer.status = recognition_pb2.RECOGNITION_STATUS_COLLECTING
            answer.decisions.add(test=evil, value=math.nan, threshold=math.inf)
            answer.contacts.add(probe=evil, patch=1, x_m=1.0, y_m=math.nan, kappa_per_m=math.inf)
            false_node.send_multipart([b"recognition/part/", answer.SerializeToString()])
            self.browser.wait("return document.querySelector('#decisions').innerText.includes('onerror')")
            # Names that are none, shapes that are none, numbers of any size: nothing of it is drawn.
            answer.header.seq, answer.group = 1, evil
            false_node.send_multipart([b"recognition/part/", answer.SerializeToString()])
            broken = recognition_pb2.Recognition(group="broken", object=2,
                                                 curve_class=curve_pb2.CURVE_CLASS_ELLIPSE,
                                                 status=recognition_pb2.RECOGNITION_STATUS_RECOGNIZED)
            for seq, (a, b, x) in enumerate([(1.0, 2.0, 0.0), (math.nan, 1.0, 0.0), (1e308, 1e-308, 1e308),
                                             (1.0, 0.5, math.inf), (-1.0, 0.0, 0.0)]):
                broken.header.seq, broken.header.epoch = seq, 1
                broken.parameters.a, broken.parameters.b = a, b
                broken.pose.x_m = x
                del broken.covariance[:]
                broken.covariance.extend([math.nan] * 25)
                false_node.send_multipart([b"recognition/broken/", broken.SerializeToString()])
            for number in range(20000):
                broken.group = f"group-{number}"
                false_node.send_multipart([f"recognition/group-{number}/".encode(), broken.SerializeToString()])
                false_node.send_multipart([f"contact/probe-{number}/".encode(), os.urandom(50)])
            answer.header.seq, answer.group = 2, "part"
            answer.sample_count = 4711
            deadline = time.monotonic() + 20
            while time.monotonic() < deadline:  # the flood may have cost some of these
                answer.header.seq += 1
                false_node.send_multipart([b"recognition/part/", answer.SerializeToString()])
                if self.browser.run("return document.querySelector('#sample-count')?.value") == "4711":
                    break
                time.sleep(0.1)
            self.assertEqual(self.browser.run("return document.querySelector('#sample-count')?.value"), "4711")
            self.assertIsNone(self.browser.run("return window.hacked ?? null"))
            self.assertEqual(self.browser.run("return document.querySelectorAll('img, script').length"), 1)
            self.assertLessEqual(self.browser.run("return document.querySelector('#group').options.length"), 65)
            self.assertIsNone(view.poll())

    def test_every_control_is_reached_and_used_by_keyboard(self):
        tab, enter, arrow_left = "\ue004", "\ue007", "\ue012"
        with Bus() as bus:
            self.look(bus)
            bus.simulate(SOURCE / "sim/scenes/circle.textproto")
            self.browser.wait("return document.querySelector('#class').textContent === 'circle'")
            controls = self.browser.run("return [...document.querySelectorAll('select, button, a, input, #plane')]"
                                        ".filter((e) => e.checkVisibility()).map((e) => e.id || e.name)")
            reached = []
            for _ in controls:
                self.browser.press(tab)
                reached.append(self.browser.run("return document.activeElement.id || document.activeElement.name"))
            self.assertEqual(reached, controls)
            # What is focused is seen.
            self.assertNotEqual(self.browser.run("return getComputedStyle(document.activeElement).outlineStyle"), "none")
            self.browser.run("document.querySelector('#plane').focus()")
            scale = "return document.querySelector('#plane .world').getCTM().a"
            moved = "return document.querySelector('#plane .world').getCTM().e"
            before, at = self.browser.run(scale), self.browser.run(moved)
            self.browser.press(arrow_left)
            self.assertGreater(self.browser.run(moved), at)
            self.browser.press("+")
            self.assertGreater(self.browser.run(scale), before)
            self.browser.press("f")
            self.assertAlmostEqual(self.browser.run(scale), before, delta=0.05 * before)
            self.browser.press("g")
            self.assertEqual(self.browser.run("return document.activeElement.id"), "group")
            self.browser.run("document.querySelector('#pause').focus()")
            self.browser.press(enter)
            self.browser.wait("return document.activeElement.id === 'scrub' && Number(scrub.value) > 1")
            at = self.browser.run("return Number(scrub.value)")
            self.browser.press(arrow_left)
            self.assertEqual(self.browser.run("return Number(scrub.value)"), at - 1)

    def test_words_are_read_in_light_and_dark_and_on_a_phone(self):
        # Contrast of at least 4.5 (WCAG 2.1, AA) for every text, against what lies behind it.
        faint = """
            const parts = (colour) => colour.match(/[\\d.]+/g).map(Number);
            const light = ([r, g, b]) => [r, g, b].map((v) => v / 255)
                .map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
                .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
            const behind = (e) => {
              for (; e; e = e.parentElement) {
                const colour = parts(getComputedStyle(e).backgroundColor);
                if (colour.length === 3 || colour[3] === 1) return colour;
              }
              return [255, 255, 255];
            };
            const bad = [];
            for (const e of document.querySelectorAll('body *')) {
              const own = [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
              if (!own || !e.checkVisibility() || e.closest('noscript, option')) continue;
              const style = getComputedStyle(e);
              const ink = light(parts(e instanceof SVGElement ? style.fill : style.color)), back = light(behind(e));
              const contrast = (Math.max(ink, back) + 0.05) / (Math.min(ink, back) + 0.05);
              if (contrast < 4.5) bad.push(`${e.tagName} ${e.textContent}: ${contrast.toFixed(2)}`);
            }
            return bad;"""
        for width, dark in ((1280, False), (1280, True), (390, False), (390, True)):
            with self.subTest(width=width, dark=dark), Bus() as bus, Browser(width, 844, dark) as browser:
                bus.start_node()
                _, url = start_view(bus)
                browser.open(url)
                browser.wait("return document.querySelector('#link-state').textContent === 'live'")
                bus.simulate(SOURCE / "sim/scenes/two_finger_grasp.textproto", "--fast")
                browser.wait("return document.querySelector('#sample-count')?.value === '242'")
                self.assertEqual(browser.run(faint), [])
                # Nothing beside the screen, and buttons that a finger hits (WCAG 2.2: 24 pixels).
                self.assertLessEqual(browser.run("return document.documentElement.scrollWidth"), width)
                small = browser.run("return [...document.querySelectorAll('button, .button, select')].filter((e) => "
                                    "e.checkVisibility() && Math.min(e.offsetWidth, e.offsetHeight) < 24).map((e) => e.id)")
                self.assertEqual(small, [])

    def test_any_address_after_the_hash_is_harmless(self):
        with Bus() as bus:
            _, _, url = self.look(bus)
            bus.simulate(SOURCE / "sim/scenes/circle.textproto", "--fast")
            for fragment in ("group=<img src=x onerror=window.hacked=1>", "view=NaN,1e999,-1", "view=1,2,0", "at=-1&group=part",
                             "at=99999999999999999999&group=part", "at=5&group=nobody", "hide=<b>,,curve&show=%00", "%",
                             "group=../../answer/part&at=1", "x" * 5000):
                self.browser.open("about:blank")
                self.browser.open(f"{url}/#{fragment}")
                self.browser.wait("return document.querySelector('#link-state').textContent === 'live'")
                self.assertIsNone(self.browser.run("return window.hacked ?? null"))
                self.assertEqual(self.browser.run("return document.querySelectorAll('img, script').length"), 1)
            self.browser.wait("return document.querySelector('#class').textContent === 'circle'")
            problems = self.browser.problems()
            # A group that is not there has no moments, which is no error; nothing else is asked for.
            self.assertEqual(self.expected_problems(problems), [])

    def test_touch_to_pixel(self):
        with Bus() as bus:
            self.look(bus)
            for _ in range(3):
                bus.simulate(SOURCE / "sim/scenes/two_finger_grasp.textproto")
            # Some of the answers were drawn; how soon is said here and decided nowhere: machines differ.
            latencies = sorted(self.browser.run("return window.palpateLatenciesMs"))
            self.assertGreater(len(latencies), 20)
            print(f"touch to pixel: p50 {latencies[len(latencies) // 2]:.0f} ms, "
                  f"p99 {latencies[int(0.99 * len(latencies))]:.0f} ms of {len(latencies)} pictures")


if __name__ == "__main__":
    if not chromium.available():
        print("SKIPPED: no chromium and chromedriver here (apt-get install chromium chromium-driver): "
              "the page is not tested")
        sys.exit(77)  # ctest's SKIP_RETURN_CODE
    unittest.main()
