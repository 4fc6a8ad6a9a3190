"""Notebooks are kept with their outputs; scripts/run-notebooks, which compares them, sees what has changed."""

import importlib.machinery
import importlib.util
import os
import unittest
import unittest.mock

from shared import ROOT

INSTALLED = all(importlib.util.find_spec(name) for name in ("nbformat", "nbconvert"))


@unittest.skipUnless(INSTALLED, "nbconvert is not installed")
class Notebooks(unittest.TestCase):
    def setUp(self):
        import nbformat

        loader = importlib.machinery.SourceFileLoader("run_notebooks", str(ROOT / "scripts/run-notebooks"))
        spec = importlib.util.spec_from_loader("run_notebooks", loader)
        self.script = importlib.util.module_from_spec(spec)
        loader.exec_module(self.script)
        self.output = nbformat.v4.new_output
        self.books = {path.stem: nbformat.read(path, 4) for path in (ROOT / "examples/notebooks").glob("*.ipynb")}

    def printed(self, text):
        return [self.output("stream", text=text)]

    def test_they_are_kept_with_outputs(self):
        self.assertGreaterEqual(len(self.books), 6)
        for name, book in self.books.items():
            code = [cell for cell in book.cells if cell.cell_type == "code"]
            with self.subTest(name):
                self.assertEqual([cell.execution_count for cell in code], list(range(1, len(code) + 1)))
                self.assertGreaterEqual(sum(bool(cell.outputs) for cell in code), len(code) - 2)
                drawings = [kind for cell in code for output in cell.outputs for kind in output.get("data", {})]
                self.assertIn("image/svg+xml", drawings)
                self.assertFalse([1 for cell in code for output in cell.outputs if output.output_type == "error"])

    def test_what_has_changed_is_seen(self):
        differing = self.script.differing
        for old, new in (("lift 8.74 mN", "lift 8.90 mN"), ("flapping", "stalled"), ("a\nb", "a"), ("1e-3", "-1e-3"),
                         ("3 designs", "3 vehicles"), ("2 of 3", "2 of 4"), ("1 2", "1 2 3"),
                         ("500 designs", "600 designs")):
            self.assertIn(repr(old.split("\n")[0]) if "\n" not in old else "lines",
                          differing(self.printed(old), self.printed(new)) or "")
        drawing = [self.output("display_data", data={"image/svg+xml": "<svg/>", "text/plain": "<Figure>"})]
        self.assertTrue(differing(drawing, [self.output("display_data", data={"text/plain": "<Figure>"})]))
        self.assertTrue(differing(drawing, []))

    def test_what_has_not_changed_is_not(self):
        differing = self.script.differing
        for old, new in (("lift 8.740 mN", "lift 8.741 mN"), ("error 3.1e-11", "error -8e-12"), ("a  b", "a b"),
                         ("548 designs", "520 designs")):
            self.assertIsNone(differing(self.printed(old), self.printed(new)))
        one, other = ([self.output("display_data", data={"image/svg+xml": f"<svg>{n}</svg>"})] for n in (1, 2))
        self.assertIsNone(differing(one, other))

    @unittest.skipUnless(all(importlib.util.find_spec(name) for name in ("ipykernel", "matplotlib")), "no kernel")
    def test_figures_are_shown_once(self):
        """As the value of a cell or not, with or without pyplot before, and the next ones as the first."""
        import nbformat
        from nbconvert.preprocessors import ExecutePreprocessor

        cells = ["import wingbeat as wb; result = wb.read('friction2022').solve()", "wb.plot.cycle(result)",
                 "wb.plot.power_flow(result)", "figure = wb.plot.cycle(result)", "figure", "wb.plot.cycle(result);",
                 "import matplotlib.pyplot as plt\nwb.plot.cycle(result)\nplt.show()", "plt.show()"]
        book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
        with unittest.mock.patch.dict(os.environ):
            os.environ.pop("MPLBACKEND", None)  # the kernel's own
            os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"
            ExecutePreprocessor(timeout=120, kernel_name="python3").preprocess(book)
        shown = [sum("image/png" in output.get("data", {}) for output in cell.outputs) for cell in book.cells]
        self.assertEqual(shown, [0, 1, 1, 1, 1, 1, 1, 0])


if __name__ == "__main__":
    unittest.main()
