"""What scripts/build-site makes the manual of: colours, search, references, gallery and bibliography, by themselves.

scripts/build-site looks at the finished pages; these tests look at its parts and see that its checks find faults.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE = ROOT / "docs/site"
sys.dont_write_bytecode = True
sys.path.insert(0, str(SITE))

import checks  # noqa: E402
import explorer_frame  # noqa: E402
import gallery  # noqa: E402
import python_reference  # noqa: E402
import search_index  # noqa: E402

try:
    import colours
except ImportError:  # Pygments comes with Sphinx
    colours = None


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text)


@unittest.skipUnless(colours, "Pygments is not installed")
class Colours(unittest.TestCase):
    def test_contrast_is_that_of_wcag(self):
        self.assertAlmostEqual(colours.contrast("#000000", "#ffffff"), 21, 9)
        self.assertAlmostEqual(colours.contrast("#777777", "#ffffff"), 4.48, 2)
        self.assertAlmostEqual(colours.contrast("#767676", "#fff"), 4.54, 2)

    def test_every_text_is_readable_in_both_themes(self):
        self.assertEqual(colours.too_faint(), [])

    def test_what_is_faint_is_found(self):
        class Faint(colours.Light):
            styles = {**colours.Light.styles, colours.Comment: "#9aa4ae"}

        shown = [colours.contrast(text, ground) for _, text, ground in colours.code_colours(Faint)]
        self.assertLess(min(shown), colours.required)

    def test_themes_state_the_same_colours(self):
        self.assertEqual(list(colours.light), list(colours.dark))
        for name in {name for pair in colours.pairs for name in pair}:
            self.assertIn(name, colours.light)


class Checks(Folder):
    def site(self, sheet, extra=""):
        self.write("index.html", '<link rel="stylesheet" href="_static/site.css">'
                   '<a href="other.html#there">x</a>' + extra)
        self.write("other.html", '<p id="there">y</p><a href="index.html">x</a>')
        self.write("_static/site.css", sheet)
        return checks.pages_of(self.folder)

    def test_a_good_site_has_no_faults(self):
        pages = self.site("p { color: red; }")
        self.assertEqual(checks.broken_links(self.folder, pages) + checks.dead_styles(self.folder, pages), [])

    def test_dead_style_sheets_are_found(self):
        pages = self.site('@import url(/javascript/normalize.css); p { background: url("gone.svg"); }')
        self.write("_static/unused.css", "")
        self.assertEqual(checks.dead_styles(self.folder, pages),
                         ["_static/site.css loads /javascript/normalize.css",
                          "_static/site.css loads /javascript/normalize.css, which is not there",
                          "_static/site.css loads gone.svg, which is not there",
                          "_static/unused.css is a style sheet of no page"])
        checks.remove_unused(self.folder, pages)
        self.assertFalse((self.folder / "_static/unused.css").exists())
        self.assertTrue((self.folder / "_static/site.css").exists())

    def test_broken_links_are_found(self):
        pages = self.site("", '<a href="gone.html">x</a><a href="other.html#gone">x</a>'
                          '<script src="https://x.org/x.js"></script>')
        self.assertEqual(checks.broken_links(self.folder, pages),
                         ["index.html links to gone.html, which is not there",
                          "index.html links to other.html#gone, an anchor that is not there",
                          "index.html loads https://x.org/x.js from the network"])


@unittest.skipUnless(shutil.which("node"), "there is no node")
class Search(Folder):
    def index(self):
        self.write("sweep.html", "<article><section id='sweeps'><h1>Sweeps<a class='headerlink'>#</a></h1>"
                   "<p>Very many vehicles.</p><section id='plots'><h2>Plots</h2>"
                   "<p>Lines over one axis, contours over two springs.</p></section></section></article>")
        self.write("metrics.html", "<article><section id='metrics'><h1>Metrics</h1><table>"
                   "<tr><td><code>lift_mean_n</code></td><td>mean lift</td></tr></table></section></article>")
        self.write("library/run/sweep.html", "<article><section id='sweep'><h1>sweep.hpp</h1><p>sweep sweep</p>"
                   "</section></article>")
        return search_index.write(self.folder)

    def asked(self, query):
        self.index()
        code = ("const [, script, file, query] = process.argv; const s = require(script);"
                "const text = require('fs').readFileSync(file, 'utf8');"
                "const index = new Function(text + 'return searchIndex;')();"
                "console.log(JSON.stringify(s.rank(index, query).map(p => [p.page, p.sections[0].heading,"
                " p.sections[0].anchor, s.excerpt(s.textOf(p, query), query)])));")
        done = subprocess.run(["node", "-e", code, SITE / "search.js", self.folder / "search-index.js", query],
                              capture_output=True, text=True, check=True)
        return json.loads(done.stdout)

    def test_the_index_has_sections_with_their_text(self):
        rows = {(row["page"], row["heading"]): row for row in self.index()}
        self.assertEqual(rows["sweep.html", "Plots"]["text"], "Lines over one axis, contours over two springs.")
        self.assertEqual(rows["sweep.html", "Plots"]["anchor"], "plots")
        self.assertEqual(rows["metrics.html", "lift_mean_n"]["text"], "lift_mean_n mean lift")
        self.assertEqual(rows["library/run/sweep.html", "sweep.hpp"]["kind"], "header")

    def test_titles_may_stand_before_the_text(self):
        self.write("report.html", "<header><h1>The <i>report</i></h1></header>"
                   "<main><h2 id='summary'>1. Answer</h2><p>Yes.</p></main>")
        row, = [row for row in search_index.entries(self.folder) if row["page"] == "report.html"]
        self.assertEqual([row[name] for name in ("title", "heading", "anchor", "text")],
                         ["The report", "1. Answer", "summary", "Yes."])

    def test_pages_stand_before_headers(self):
        self.assertEqual([page for page, *_ in self.asked("sweep")], ["sweep.html", "library/run/sweep.html"])

    def test_names_of_tables_are_found(self):
        self.assertEqual(self.asked("lift_mean_n")[0][:2], ["metrics.html", "lift_mean_n"])

    def test_excerpts_mark_the_terms(self):
        (page, heading, anchor, excerpt), = self.asked("spring contours")
        self.assertEqual((page, heading, anchor), ("sweep.html", "Plots", "plots"))
        self.assertEqual([text for text, marked in excerpt if marked], ["contours", "springs"])
        self.assertEqual("".join(text for text, _ in excerpt), "Lines over one axis, contours over two springs.")

    def test_nothing_is_found_where_there_is_nothing(self):
        self.assertEqual(self.asked("zeppelin"), [])
        self.assertEqual(self.asked("?"), [])


class PythonReference(Folder):
    def pages(self):
        names = python_reference.write_pages(ROOT / "interfaces/python/wingbeat", self.folder, "# Python reference\n")
        return {name: (self.folder / name).read_text() for name in names}

    def test_every_public_name_has_its_place(self):
        pages = self.pages()
        package = python_reference.Package(ROOT / "interfaces/python/wingbeat")
        self.assertGreater(len(package.public), 30)
        for name in set(package.public) - python_reference.special - set(package.modules):
            heading = rf"^## {re.escape(name.replace('_', chr(92) + '_'))}$"
            shown = [page for page, text in pages.items()
                     if pathlib.PurePath(page).stem not in package.modules and re.search(heading, text, re.M)]
            self.assertEqual(len(shown), 1, name)

    def test_functions_of_a_module_that_are_defined_elsewhere(self):
        text = self.pages()["python-reference/plot.md"]
        shown = re.findall(r"^## (.*)$", text, re.M)
        self.assertEqual(sorted(shown), sorted({name.replace("_", r"\_") for name in (
            "bode", "contours", "cycle", "flight", "front", "lines", "power_flow", "residuals", "sensitivity",
            "start_up", "step", "tolerance", "trends")}))
        self.assertIn("wingbeat.plot.cycle(\n    result: RunResult,\n    *,\n    figure: Figure | None = None,\n", text)

    def test_functions_show_signature_units_errors_and_an_example(self):
        text = self.pages()["python-reference/ensembles.md"]
        sweep = text.split("\n## sweep\n")[1].split("\n## ")[0]
        self.assertIn("wingbeat.sweep(\n    vehicle: Vehicle,\n    axes: Mapping[str, Any],\n    *,\n", sweep)
        self.assertIn("\n) -> SweepData\n", sweep)
        self.assertIn(r"| `frequency` | `float \| str \| None` | `None` | Flapping frequency of all designs \[Hz\]", sweep)
        self.assertRegex(sweep, r"\n\| `InputError` \| For axes")
        self.assertIn("```pycon\n>>> vehicle = wb.read(", sweep)

    def test_methods_of_a_vehicle_show_what_the_functions_say(self):
        pages = self.pages()
        text = pages["python-reference/vehicles.md"]
        parts = {part.split("\n")[0]: part for part in text.split("\n### Vehicle.")[1:]}
        for name, row in (("solve", "`frequency`"), ("sweep", "`axes`"), ("fit", "`deviation`"), ("simulation", "`angle`"),
                          (r"solve\_columns", "`columns`")):
            part = parts[name]
            self.assertIn(f"\n| {row} | `", part)
            self.assertRegex(part, r"\n\*\*Returns\*\* \[`\w+`\]")
            self.assertIn("\n| `InputError` | For ", part)
            self.assertIn("```pycon\n>>> ", part)
            self.assertNotIn("| `vehicle` |", part)
        self.assertNotIn("`metrics`", parts["solve"])
        self.assertIn("\n## SweepData\n", pages["python-reference/ensembles.md"])

    def test_links_within_lead_somewhere(self):
        pages = self.pages()
        for page, text in pages.items():
            for target, anchor in re.findall(r"\]\(([\w/-]+\.md)#([\w-]+)\)", text):
                known = pages[str(pathlib.PurePosixPath(page).parent / target).removeprefix("./")]
                headings = {re.sub(r"[^\w-]", "", heading.lower())
                            for heading in re.findall(r"^##+ (.*)$", known, re.M)}
                self.assertIn(anchor, headings)


class Gallery(unittest.TestCase):
    TEXT = (ROOT / "docs/gallery.md").read_text()

    def test_each_figure_has_its_command_and_its_data(self):
        commands = [found["command"] for found in gallery.entry.finditer(self.TEXT)]
        self.assertEqual(len(commands), self.TEXT.count("\nwingbeat "))
        self.assertGreaterEqual(len(commands), 12)
        figures = [gallery.figure_of(command) for command in commands]
        self.assertEqual(len(set(figures)), len(figures))
        for file in re.findall(r"data/\S+", " ".join(commands)):
            self.assertTrue((ROOT / file).is_file(), file)

    def test_a_command_without_a_figure_is_refused(self):
        with self.assertRaises(LookupError):
            gallery.figure_of("wingbeat run friction2022")


class ExplorerFrame(Folder):
    TEXT = "Before.\n\n<!-- explorer: mechanism, lift of crank -->\n\nAfter.\n"

    def framed(self, text, place="model.md"):
        self.write("designs/crank.toml", "")
        return explorer_frame.framed(text, self.folder / "explorer.html", place, self.folder / "designs")

    def test_a_mark_becomes_a_frame_where_the_explorer_is(self):
        self.assertEqual(self.framed(self.TEXT), "Before.\n\n\n\nAfter.\n")
        self.write("explorer.html", "")
        self.assertIn('src="explorer.html?embed=mechanism,lift#vehicle=crank"', self.framed(self.TEXT))
        self.assertIn('href="../explorer.html#vehicle=crank"', self.framed(self.TEXT, "tutorials/own.md"))

    def test_an_unknown_vehicle_is_refused(self):
        with self.assertRaises(LookupError):
            self.framed(self.TEXT.replace("crank", "none"))

    def test_every_mark_of_the_pages_is_of_a_vehicle(self):
        marks = [match for page in (ROOT / "docs").rglob("*.md")
                 for match in explorer_frame.mark.finditer(page.read_text())]
        self.assertGreaterEqual(len(marks), 4)
        for match in marks:
            self.assertTrue((ROOT / f"data/designs/{match[2]}.toml").is_file(), match[0])


class Bibliography(unittest.TestCase):
    ENTRIES = {key: dict(re.findall(r"^  (\w+) = \{(.*)\},$", body, re.M)) for key, body in re.findall(
        r"^@\w+\{(\w+),\n(.*?)\n\}$", (ROOT / "docs/bibliography.bib").read_text(), re.M | re.S)}
    PAGE = {key: re.sub(r"\s+", " ", text) for key, text in re.findall(
        r"^\* `(\w+)`: (.*?)(?=^\* |^## |\Z)", (ROOT / "docs/bibliography.md").read_text(), re.M | re.S)}

    def test_page_and_file_have_the_same_works(self):
        self.assertGreater(len(self.ENTRIES), 30)
        self.assertEqual(list(self.PAGE), list(self.ENTRIES))
        for key, fields in self.ENTRIES.items():
            with self.subTest(key):
                self.assertIn(fields["year"], self.PAGE[key])
                shown = re.findall(r"DOI \[(10\.[^\]]+)\]", self.PAGE[key])
                self.assertEqual(shown, [fields["doi"]] if "doi" in fields else [])
                self.assertEqual("ot verified" in self.PAGE[key], "not verified" in fields.get("note", ""))
                if "volume" in fields:
                    self.assertIn(f" {fields['volume']}", self.PAGE[key])

    def test_articles_have_a_doi_or_say_that_it_is_not_known(self):
        for key, fields in self.ENTRIES.items():
            if "journal" in fields:
                self.assertTrue("doi" in fields or "note" in fields, key)


if __name__ == "__main__":
    unittest.main()
