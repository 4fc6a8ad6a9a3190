"""Pages that the program writes, in Chromium: what they show under the pointer and the keyboard, without a network."""
import html
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["WINGBEAT_PROGRAM"]
ROOT = pathlib.Path(__file__).resolve().parents[2]

STUDY = """
[study]
title = "A </script> plane & more"
vehicle = "{vehicle}"
metrics = ["lift_mean_n", "efficiency_system", "lift_to_weight"]
[[axis]]
key = "transmission.crank_radius"
from = "3 mm"
to = "12 mm"
count = 7
[[axis]]
key = "supply.voltage"
from = "0.5 V"
to = "8 V"
count = 6
"""
LINES = """
[study]
vehicle = "{vehicle}"
metrics = ["lift_mean_n", "frequency_hz"]
[[axis]]
key = "supply.voltage"
from = "2 V"
to = "4 V"
count = 11
[[axis]]
key = "springs"
values = [true, false]
"""
FRONT = """
[study]
vehicle = "{vehicle}"
[search]
population = 20
generations = 2
[[objective]]
maximise = "lift_mean_n"
reference = "0 N"
[[objective]]
minimise = "power_electrical_w"
reference = "4 W"
[[parameter]]
key = "supply.voltage"
lower = "2 V"
upper = "8 V"
[[parameter]]
key = "transmission.crank_radius"
lower = "4 mm"
upper = "6 mm"
"""
ASKED = """<script>
const areas = [...document.querySelectorAll('.area')], tips = [];
const record = () => tips.push([...document.querySelector('.tip').children].map(line => line.textContent));
const point = (area, across, up) => {
  const box = area.getBoundingClientRect();
  area.dispatchEvent(new PointerEvent('pointermove', {clientX: box.left + across * box.width,
                                                      clientY: box.bottom - up * box.height}));
  record();
};
const press = (area, key) => { area.dispatchEvent(new KeyboardEvent('keydown', {key, cancelable: true})); record(); };
%s
document.title = JSON.stringify({tips, areas: areas.length, names: areas.map(a => a.getAttribute('aria-label')),
                                 tabs: areas.map(a => a.tabIndex)});
</script>"""


class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, *words, status=0):
        done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout if status == 0 else done.stderr

    def study(self, text, vehicle="friction2022-springs"):
        file = self.folder / "study.toml"
        file.write_text(text.format(vehicle=ROOT / "data/designs" / f"{vehicle}.toml"))
        return file

    def asked(self, page, script):
        """What a page answers to a script that points at its panels."""
        used = self.folder / "used.html"
        used.write_text(page.read_text().replace("</body>", ASKED % script + "</body>"))
        done = subprocess.run(
            ["timeout", "100", "chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
             "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={self.folder / 'profile'}",
             "--enable-logging=stderr", "--dump-dom", used.as_uri()], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, "chromium (scripts/install-dependencies installs it): " + done.stderr)
        self.assertNotIn(":CONSOLE", done.stderr)
        return json.loads(html.unescape(re.search(r"<title>(.*?)</title>", done.stdout, re.S)[1]))

    def check_alone(self, page):
        text = page.read_text()
        for foreign in ("http://", "https://", "src=", "@import", "<link rel=\"stylesheet"):
            self.assertEqual(text.replace("http://www.w3.org/", "").count(foreign), 0, foreign)
        self.assertIn("prefers-color-scheme: dark", text)
        self.assertIn("@media print", text)
        drawing = text[text.index("<svg"):text.index("</svg>")]
        self.assertIn("var(--ink)", drawing)
        self.assertNotIn("rgb(  0,   0,   0)", drawing)

    def lift(self, radius, voltage, status=0):
        words = [PROGRAM, "run", ROOT / "data/designs/friction2022-springs.toml", "--json", "--voltage", voltage,
                 "--set", f"transmission.crank_radius={radius}"]
        done = subprocess.run(words, capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stderr)
        return json.loads(done.stdout)

    @unittest.skipUnless(shutil.which("gnuplot"), "no gnuplot")
    def test_contours(self):
        page = self.folder / "plane.html"
        self.run_program("sweep", self.study(STUDY), "-o", self.folder / "plane.nc", "--plot", page)
        self.check_alone(page)
        answer = self.asked(page, """
          point(areas[0], 1 / 6 + 0.01, 0.61);
          press(areas[0], 'ArrowRight');
          press(areas[0], 'ArrowUp');
          point(areas[0], 0.5, 0.01);
          press(areas[1], 'End');
          press(areas[0], 'Escape');
        """)
        self.assertEqual((answer["areas"], answer["tabs"]), (2, [0, 0]))
        self.assertTrue(answer["names"][0].startswith("mean lift (mN): arrow keys"))
        first, right, up, idle, _, hidden = answer["tips"]
        metrics = self.lift("4.5 mm", "5 V")
        self.assertEqual(first[:3], ["crank radius: 4.5 mm", "supply voltage: 5 V",
                                     f"mean lift: {1e3 * metrics['lift_mean_n']:.4g} mN"])
        self.assertEqual(right[:2], ["crank radius: 6 mm", "supply voltage: 5 V"])
        self.assertEqual(up[:2], ["crank radius: 6 mm", "supply voltage: 6.5 V"])
        self.assertEqual(idle[2:], ["mean lift: none", self.lift("7.5 mm", "0.5 V", 3)["status"]])
        self.assertEqual(hidden, [])
        outside = self.asked(page, "point(areas[0], 1, 1); point(areas[0], 5 / 6, 0.8);")["tips"]
        self.assertTrue(any(line.startswith("outside the model's domain: ") or line in ("locked", "stalled", "jammed")
                            for tip in outside for line in tip))

    @unittest.skipUnless(shutil.which("gnuplot"), "no gnuplot")
    def test_curves(self):
        page = self.folder / "lines.html"
        self.run_program("sweep", self.study(LINES), "-o", self.folder / "lines.nc", "--plot", page, "--plot-metric",
                         "lift_mean_n")
        self.check_alone(page)
        (tip,) = self.asked(page, "point(areas[0], 0.51, 0.2);")["tips"]
        metrics = self.lift("5 mm", "3 V")
        self.assertEqual(tip[:2], ["supply voltage: 3 V", f"springs on: {1e3 * metrics['lift_mean_n']:.4g} mN"])
        self.assertTrue(tip[2].startswith("springs off: "))

    @unittest.skipUnless(shutil.which("gnuplot"), "no gnuplot")
    def test_fronts(self):
        page = self.folder / "front.html"
        found = json.loads(self.run_program("optimise", self.study(FRONT, "friction2022"), "--plot", page, "--json"))
        self.check_alone(page)
        (answer,) = self.asked(page, "press(areas[0], 'End');")["tips"]
        best = max(found["front"], key=lambda design: design["metrics"]["lift_mean_n"])
        self.assertEqual(answer[:4], [
            f"mean lift: {1e3 * best['metrics']['lift_mean_n']:.4g} mN",
            f"mean electrical input power: {best['metrics']['power_electrical_w']:.4g} W",
            f"supply voltage: {best['parameters']['supply.voltage']:.4g} V",
            f"crank radius: {1e3 * best['parameters']['transmission.crank_radius']:.4g} mm",
        ])
        self.assertIn("end 1", answer[4])

    def test_where_there_are_no_pages(self):
        vehicle = ROOT / "data/designs/friction2022.toml"
        text = self.run_program("run", vehicle, "--plot", "cycle.html", status=2)
        self.assertIn("--plot cycle.html: the name must end in .svg, .pdf or .png\n", text)
        text = self.run_program("optimise", ROOT / "data/studies/optimise-hover.toml", "--plot", "x.html", status=2)
        self.assertIn("--plot x.html: pages show fronts; the optimum of one objective is drawn to .svg, .pdf or .png",
                      text)

    @unittest.skipUnless(shutil.which("gnuplot"), "no gnuplot")
    def test_the_report(self):
        made = pathlib.Path(os.environ.get("WINGBEAT_REPRODUCED", self.folder / "made"))
        if not made.exists():
            self.run_program("reproduce", "friction2022", "--coarse", "-o", made)
        answer = self.asked(made / "report.html", """
          const table = document.querySelector('.scorecard'), filter = table.querySelector('.filter');
          const count = () => [...table.querySelectorAll('tbody td:first-child')].filter(td => !td.parentNode.hidden);
          const choose = (name, value) => {
            filter.querySelector(name).value = value;
            filter.dispatchEvent(new Event('input'));
            const rows = count();
            tips.push([rows.length, filter.querySelector('span').textContent,
                       rows.every(td => td.parentNode.querySelectorAll('td.yes').length === 2),
                       rows.every(td => td.parentNode.textContent.toLowerCase().includes(
                                    filter.querySelector('input').value))]);
          };
          tips.push([filter.hidden, count().length]);
          choose('select', '2');
          choose('select', '');
          choose('input', 'crank');
          choose('input', '');
          const strip = table.querySelectorAll('thead th')[4];
          strip.dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter', cancelable: true}));
          strip.dispatchEvent(new KeyboardEvent('keydown', {key: ' ', cancelable: true}));
          const groups = [[]];
          for (const row of table.querySelector('tbody').rows) {
            if (row.cells[0].classList.contains('group')) groups.push([]);
            else groups[groups.length - 1].push(+row.cells[4].dataset.value);
          }
          tips.push([strip.getAttribute('aria-sort'),
                     groups.every(g => g.every((value, n) => n === 0 || value <= g[n - 1]))]);
          for (const id of ['figure-20', 'figure-21', 'figure-22']) {
            const svg = document.querySelector(`#${id} svg`);
            press(svg, 'ArrowRight');
            tips[tips.length - 1].push(svg.tabIndex);
            press(svg, 'Escape');
            tips[tips.length - 1] = [document.querySelector('.tip').style.display];
          }
        """)["tips"]
        (hidden, every), both, all_again, crank, _, order = answer[:6]
        self.assertFalse(hidden)
        self.assertGreater(every, 40)
        self.assertTrue(0 < both[0] < every and both[2])
        self.assertEqual(all_again[:2], [every, f"{every} statements"])
        self.assertTrue(0 < crank[0] < every and crank[3])
        self.assertEqual(order, ["descending", True])
        for (*shown, tab), ended, axis in zip(answer[6::2], answer[7::2], ("crank radius: ", "rod length: ",
                                                                         "supply voltage: ")):
            self.assertTrue(shown[0].startswith(axis), shown)
            self.assertGreaterEqual(len(shown), 4)
            self.assertEqual((tab, ended), (0, ["none"]))


if __name__ == "__main__":
    unittest.main()
