"""Modules of the package import each other in one direction."""

import ast
import pathlib
import unittest

PACKAGE = pathlib.Path(__file__).resolve().parents[2] / "interfaces/python/wingbeat"


def imports_that_run(tree):
    """Modules of the package that are imported, anywhere in a file, but for type checkers alone."""
    found = set()
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
            continue
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            found |= {node.module} if node.module else {name.name for name in node.names}
        found |= imports_that_run(node)
    return found


def circle_from(module, graph, path=()):
    """A way from the module back to itself, or None."""
    if module in path:
        return [*path[path.index(module):], module]
    for target in sorted(graph.get(module, ())):
        if found := circle_from(target, graph, (*path, module)):
            return found
    return None


class Imports(unittest.TestCase):
    def test_there_are_no_circles(self):
        graph = {file.stem: imports_that_run(ast.parse(file.read_text())) for file in PACKAGE.glob("*.py")}
        self.assertIn("_tables", graph["_vehicle"])
        for module in graph:
            self.assertIsNone(circle_from(module, graph))

    def test_a_circle_is_found(self):
        graph = {"_a": imports_that_run(ast.parse("def f():\n    from ._b import x\n")), "_b": {"_a"}}
        self.assertEqual(circle_from("_a", graph), ["_a", "_b", "_a"])
        typing_only = "if TYPE_CHECKING:\n    from ._b import x\n"
        self.assertEqual(imports_that_run(ast.parse(typing_only)), set())
