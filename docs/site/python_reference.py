"""Pages of the Python package's public names, from the docstrings and signatures of its sources, which are not run."""
import ast
import pathlib
import re

# What belongs together; names of the package that are in no group get a page of their own.
groups = [
    ("vehicles", "Vehicles and quantities",
     "Vehicle files: read them, look at their keys, change them.",
     ["read", "shipped", "Vehicle", "Section", "Quantity", "parameters", "Parameter", "InputError"]),
    ("runs", "One vehicle", "Steady flapping, start-up, and their results.",
     ["solve", "RunResult", "EnergyBalance", "metrics", "Metric", "simulate", "StartUp", "Event"]),
    ("ensembles", "Many vehicles", "Arrays of designs and sweeps over their keys.",
     ["solve_columns", "Ensemble", "sweep", "SweepData", "open_dataset"]),
    ("studies", "Studies", "Optima, tolerances, fits, flights and motors: the studies of the program.",
     ["optimise", "Found", "Front", "OwnOptimum", "tolerance", "fit", "endurance", "Flight", "identify_motor",
      "Identification", "StudyResult"]),
    ("control", "Time and control", "Simulations that are stepped, equations of motion, linear models.",
     ["Simulation", "SimulationState", "EquationsOfMotion", "linearise", "ControlModels", "LinearModel"]),
    ("parts", "Parts", "Curves of a motor, of force coefficients and of a transmission.",
     ["motor_curves", "coefficient_curves", "kinematics"]),
]
titles = ("Parameters", "Attributes", "Returns", "Raises", "Notes", "Examples")
special = {"__version__"}


class Package:
    """The public names of the package and where they are defined."""

    def __init__(self, folder):
        self.folder = folder
        self.sources, self.trees = {}, {}
        inner = {path.parent.name: path for path in sorted(folder.glob("*/__init__.py"))}
        for name, path in ({path.stem: path for path in sorted(folder.glob("*.py"))} | inner).items():
            self.sources[name] = path.read_text().splitlines()
            self.trees[name] = ast.parse("\n".join(self.sources[name]))
        start = self.trees["__init__"]
        self.homes = {name.asname or name.name: (statement.module, name.name) for statement in start.body
                      if isinstance(statement, ast.ImportFrom) and statement.level for name in statement.names}
        self.public = next([ast.literal_eval(element) for element in statement.value.elts] for statement in start.body
                           if isinstance(statement, ast.Assign) and statement.targets[0].id == "__all__")
        # Names that are imported when they are first asked for.
        late = {name.name: (one.module, name.name) for statement in start.body if isinstance(statement, ast.If)
                for one in statement.body if isinstance(one, ast.ImportFrom) and one.module
                for name in one.names}
        self.homes |= late
        self.public += list(late)
        # Modules without an underscore are public as well.
        self.modules = [name for name in self.trees if not name.startswith("_")]

    def definitions(self, module, name):
        """All statements of a module that define a name: overloads before the function."""
        return [node for node in self.trees[module].body
                if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and node.name == name
                or isinstance(node, ast.AnnAssign) and getattr(node.target, "id", "") == name]

    def of(self, name):
        """Module and definitions of a public name."""
        module, own = self.homes[name]
        found = self.definitions(module, own)
        if not found:
            raise LookupError(f"wingbeat.{name} is not defined in {module}.py")
        return module, found

    def members(self, module):
        """Public functions and classes of a public module: by name their module and definitions. They may be defined
        in a module with an underscore and imported from there."""
        found = {}
        for node in self.trees[module].body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and not node.name.startswith("_"):
                found.setdefault(node.name, (module, []))[1].append(node)
            elif isinstance(node, ast.ImportFrom) and node.level and (node.module or "").startswith("_"):
                for one in node.names:
                    name, nodes = one.asname or one.name, self.definitions(node.module, one.name)
                    kinds = all(isinstance(each, (ast.FunctionDef, ast.ClassDef)) for each in nodes)
                    if nodes and kinds and name in self.listed(module):
                        found[name] = (node.module, nodes)
        return found

    def listed(self, module):
        """`__all__` of a module, empty without one."""
        return next(([ast.literal_eval(element) for element in statement.value.elts]
                     for statement in self.trees[module].body if isinstance(statement, ast.Assign)
                     and getattr(statement.targets[0], "id", "") == "__all__"), [])

    def comment(self, module, node):
        """The comment `#:` of an attribute: above it, or on its line."""
        lines = self.sources[module]
        own = re.search(r"#: ?(.*)", lines[node.lineno - 1])
        if own:
            return own[1]
        found, row = [], node.lineno - 2
        while row >= 0 and lines[row].strip().startswith("#:"):
            found.insert(0, lines[row].strip()[2:].strip())
            row -= 1
        return " ".join(found)


def decorators(node):
    return {ast.unparse(one).split("(")[0].split(".")[-1] for one in getattr(node, "decorator_list", [])}


def annotation(node):
    if node is None:
        return ""
    return re.sub(r"'([^'\"]*)'", r'"\1"', ast.unparse(node))


def listed(given):
    """The parameters of a signature, each as text."""
    def one(parameter, default):
        kind = f": {annotation(parameter.annotation)}" if parameter.annotation else ""
        value = annotation(default)
        return f"{parameter.arg}{kind}" + (f" = {value}" if kind and value else f"={value}" if value else "")

    plain = given.posonlyargs + given.args
    defaults = [None] * (len(plain) - len(given.defaults)) + given.defaults
    texts = [one(*pair) for pair in zip(plain, defaults)]
    if given.posonlyargs:
        texts.insert(len(given.posonlyargs), "/")
    if given.vararg:
        texts.append(f"*{one(given.vararg, None)}")
    elif given.kwonlyargs:
        texts.append("*")
    texts += [one(*pair) for pair in zip(given.kwonlyargs, given.kw_defaults)]
    return texts + ([f"**{one(given.kwarg, None)}"] if given.kwarg else [])


def signature(name, node, method=False):
    """As one would call it, without self."""
    texts = listed(node.args)
    if method and "staticmethod" not in decorators(node):
        texts = texts[1:]
    returned = annotation(node.returns).strip('"')
    returned = f" -> {returned}" if returned and returned != "None" else ""
    text = f"{name}({', '.join(texts)}){returned}"
    return text if len(text) <= 100 else f"{name}(\n    " + ",\n    ".join(texts) + f",\n){returned}"


def parameters_of(node, method=False):
    """Name, type and default of each parameter."""
    given = node.args
    plain = given.posonlyargs + given.args
    defaults = [None] * (len(plain) - len(given.defaults)) + given.defaults
    rows = list(zip(plain, defaults))[1 if method else 0:] + list(zip(given.kwonlyargs, given.kw_defaults))
    return [(one.arg, annotation(one.annotation), annotation(default)) for one, default in rows]


def parts_of(doc):
    """A docstring in the form of numpydoc, by section: {"": text, "Parameters": [(name, meaning), ...], ...}. Of
    "Returns" the name is the type. Notes join the text."""
    pieces = re.split(rf"^({'|'.join(titles)})\n-+\n", doc or "", flags=re.M)
    found = {"": pieces[0].strip()}
    for title, body in zip(pieces[1::2], pieces[2::2]):
        body = body.strip("\n")
        if title == "Examples":
            found[title] = body
        elif title == "Notes":
            found[""] += "\n\n" + body
        else:
            found[title] = [(row.split("\n")[0].partition(" : ")[0], " ".join(row.split("\n", 1)[-1].split()))
                            for row in re.split(r"\n(?=\S)", body)]
    return found


def examples(body, links):
    """Examples: what is typed and shown as blocks, sentences between them as text."""
    return "\n".join(f"```pycon\n{block}\n```\n" if block.startswith(">>>") else prose(block, links) + "\n"
                     for block in body.split("\n\n"))


def escaped(text):
    return re.sub(r"([\\*_{}\[\]<>$|#~])", r"\\\1", text)


def prose(text, links):
    """Text of a docstring as Markdown: `code` stays, names of the package become links, indented lines become code."""
    blocks = []
    for block in re.split(r"\n\s*\n", text.strip()):
        if block.startswith("    "):
            blocks.append("```python\n" + re.sub("^    ", "", block, flags=re.M) + "\n```")
            continue
        pieces = re.split(r"(`[^`]*`)", re.sub(r"\s*\n\s*", " ", block))
        blocks.append("".join(linked(piece, links) for piece in pieces))
    return "\n\n".join(blocks)


def linked(piece, links):
    if piece.startswith("`"):
        # `metrics` may be an argument; `wingbeat.metrics` and `Metric` are names of the package.
        name = piece.strip("`").removeprefix("wingbeat.")
        named = name in links and (piece.startswith("`wingbeat.") or name[0].isupper())
        return f"[{piece}]({links[name]})" if named else piece
    return re.sub(r"wingbeat\\\.(\w+)|wingbeat\.(\w+(?:\\_\w+)*)", lambda m: (
        f"[`{name}`]({links[name]})" if (name := (m[1] or m[2]).replace("\\", "")) in links else m[0]), escaped(piece))


def table(head, rows, links):
    if not rows:
        return ""
    def cell(text):
        return re.sub(r"\s+", " ", prose(text, links)).replace("\n", " ") if text else ""
    def code(text):
        return f"`{text}`".replace("|", "\\|") if text else ""
    lines = [f"| {' | '.join(head)} |", f"|{' --- |' * len(head)}"]
    lines += ["| " + " | ".join([*(code(part) for part in row[:-1]), cell(row[-1])]) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def split_names(rows):
    """Rows of a section of a docstring, in which several names may share a meaning."""
    return {name.strip(): meaning for names, meaning in rows for name in names.split(",")}


class Reference:
    """The pages, as Markdown."""

    def __init__(self, folder):
        self.package = Package(folder)
        self.groups = [(file, title, text, [name for name in names if name in self.package.public])
                       for file, title, text, names in groups]
        placed = {name for *_, names in self.groups for name in names} | special
        rest = [name for name in self.package.public if name not in placed and name not in self.package.modules]
        if rest:
            self.groups.append(("other", "Other names", "What else the package has.", rest))
        self.links = {name: f"{file}.md#{name.lower()}" for file, *_, names in self.groups for name in names}

    def function(self, module, name, nodes, level="##", owner="", package="wingbeat"):
        method = bool(owner)
        overloads = [node for node in nodes if "overload" in decorators(node)]
        main = next((node for node in nodes if "overload" not in decorators(node)), nodes[-1])
        called = f"{owner}{name}" if method else f"{package}.{name}"
        shown = overloads if len(overloads) > 1 else [main]
        lines = [f"{level} {escaped(owner + name)}\n", "```python\n" + "\n".join(
            signature(called, node, method) for node in shown) + "\n```\n"]
        parts = parts_of(ast.get_docstring(main))
        lines.append(prose(parts[""], self.links) + "\n")
        parts = self.of_function(main) | parts
        lines.append(self.sections(parts, parameters_of(main, method)))
        return "\n".join(lines)

    def of_function(self, node):
        """Of a method that is a function of the package, `@method_of("solve")`: what the function's docstring says of
        the other arguments, of what comes back and of errors."""
        names = [one.args[0].value for one in node.decorator_list
                 if isinstance(one, ast.Call) and ast.unparse(one.func) == "method_of"]
        if not names:
            return {}
        _, nodes = self.package.of(names[0])
        found = parts_of(ast.get_docstring(nodes[-1]))
        returned = [(names[0], "")] if isinstance(nodes[-1], ast.ClassDef) else found.get("Returns", [])
        own = {one.arg for one in node.args.args + node.args.kwonlyargs}
        kept = [row for row in found["Parameters"] if own.intersection(row[0].split(", "))]
        return {"Parameters": kept, "Returns": returned, "Raises": found.get("Raises", [])}

    def inherited(self, module, node):
        """The bodies of base classes that are not public themselves."""
        for base in map(ast.unparse, node.bases):
            homes = [one.module for one in self.package.trees[module].body if isinstance(one, ast.ImportFrom)
                     and one.level and base in {name.name for name in one.names}]
            if homes and base not in self.links:
                defined = self.package.definitions(homes[0], base)[0]
                if isinstance(defined, ast.ClassDef):  # else chosen by what is installed
                    yield from defined.body

    def sections(self, parts, given):
        stated = split_names(parts.get("Parameters", []))
        types = {name: (kind, default) for name, kind, default in given}
        lines = [table(("parameter", "type", "default", "meaning"),
                       [(name, *types.get(name, ("", "")), meaning) for name, meaning in stated.items()], self.links)]
        if "Returns" in parts:
            for kind, meaning in parts["Returns"]:
                shown = " or ".join(f"`{one}`" for one in kind.split(" or "))
                meaning = f": {prose(meaning, self.links)}" if meaning else ""
                lines.append(f"**Returns** {prose(shown, self.links)}{meaning}\n")
        lines.append(table(("raises", "when"), parts.get("Raises", []), self.links))
        if "Examples" in parts:
            lines.append(examples(parts["Examples"], self.links))
        return "\n".join(lines)

    def fields(self, module, node):
        """Attributes and properties of a class: (name, type, meaning)."""
        rows = []
        for one in node.body:
            if isinstance(one, ast.AnnAssign) and not one.target.id.startswith("_"):
                rows.append((one.target.id, annotation(one.annotation), self.package.comment(module, one)))
            elif isinstance(one, ast.FunctionDef) and "property" in decorators(one) and not one.name.startswith("_"):
                doc = parts_of(ast.get_docstring(one))
                raises = " ".join(f"Raises {name}: {when}." for name, when in doc.get("Raises", []))
                rows.append((one.name, annotation(one.returns), f"{doc['']} {raises}".strip()))
        return rows

    def class_(self, module, name, node, package="wingbeat"):
        parts = parts_of(ast.get_docstring(node))
        start = next((one for one in node.body
                      if isinstance(one, ast.FunctionDef) and one.name in ("__init__", "__new__")), None)
        made = start is not None and "Parameters" in parts
        call = signature(f"{package}.{name}", start, True) if made else f"class {package}.{name}"
        bases = [ast.unparse(base) for base in node.bases]
        lines = [f"## {escaped(name)}\n", f"```python\n{call}\n```\n"]
        known = [f"[{base}]({self.links[base]})" for base in bases if base in self.links]
        lines.append(prose(parts[""], self.links) + "\n")
        if known:
            lines.append(f"It is a {', '.join(known)} as well.\n")
        stated = split_names(parts.get("Attributes", []))
        fields = self.fields(module, node)
        fields = [(field, kind, stated.get(field) or meaning) for field, kind, meaning in fields]
        lines.append(table(("attribute", "type", "meaning"), fields, self.links))
        lines.append(self.sections(parts, parameters_of(start, True) if made else []))
        methods = {}
        for one in [*node.body, *self.inherited(module, node)]:
            if isinstance(one, ast.FunctionDef) and not one.name.startswith("_") and not (
                    {"property", "setter"} & decorators(one)):
                methods.setdefault(one.name, []).append(one)
        for method, nodes in methods.items():
            lines.append(self.function(module, method, nodes, "###", f"{name}."))
        return "\n".join(lines)

    def entry(self, name):
        module, nodes = self.package.of(name)
        if isinstance(nodes[0], ast.ClassDef):
            return self.class_(module, name, nodes[0])
        if isinstance(nodes[0], ast.AnnAssign):
            meaning = self.package.comment(module, nodes[0])
            return (f"## {escaped(name)}\n\n```python\nwingbeat.{name}: {annotation(nodes[0].annotation)}\n```\n\n"
                    f"{prose(meaning, self.links)}\n")
        return self.function(module, name, nodes)

    def summary(self, name):
        """The first sentence about a name."""
        module, nodes = self.package.of(name)
        if isinstance(nodes[0], ast.AnnAssign):
            text = self.package.comment(module, nodes[0])
        else:
            text = next(filter(None, (ast.get_docstring(node) for node in nodes)), "")
        return re.split(r"(?<=[a-z0-9`\"\])])[.:;](?:\s|$)", re.sub(r"\s+", " ", text))[0]

    def module_page(self, name):
        """A public module: its docstring and its public functions and classes."""
        lines = [f"# wingbeat.{name}\n", prose(ast.get_docstring(self.package.trees[name]) or "", self.links) + "\n"]
        package = f"wingbeat.{name}"
        for own, (home, nodes) in self.package.members(name).items():
            lines.append(self.class_(home, own, nodes[0], package) if isinstance(nodes[0], ast.ClassDef)
                         else self.function(home, own, nodes, package=package))
        return "\n".join(lines)

    def write(self, folder, introduction):
        """python-reference.md and the pages under it, in `folder`; returns the names of all."""
        (folder / "python-reference").mkdir()
        index, pages = introduction, []
        for file, title, text, names in self.groups:
            body = f"# {title}\n\n{text}\n\n" + "\n".join(self.entry(name) for name in names)
            (folder / "python-reference" / f"{file}.md").write_text(body)
            pages.append(f"python-reference/{file}")
            rows = "".join(f"| [`{name}`](python-reference/{self.links[name]}) | "
                           f"{linked_outside(self.summary(name))} |\n" for name in names)
            index += f"\n## {title}\n\n{text}\n\n| | |\n| --- | --- |\n{rows}"
        for name in self.package.modules:
            (folder / "python-reference" / f"{name}.md").write_text(self.module_page(name))
            pages.append(f"python-reference/{name}")
            index += f"\n## wingbeat.{name}\n\n[wingbeat.{name}](python-reference/{name}.md)\n"
        index += "\n```{toctree}\n:hidden:\n\n" + "\n".join(pages) + "\n```\n"
        (folder / "python-reference.md").write_text(index)
        return ["python-reference.md", *(f"{page}.md" for page in pages)]


def linked_outside(text):
    pieces = re.split(r"(`[^`]*`)", text)
    return "".join(piece if piece.startswith("`") else escaped(piece) for piece in pieces)


def write_pages(package, folder, introduction):
    """The reference of the Python package in the folder `package`, as pages in `folder`; returns their names."""
    return Reference(pathlib.Path(package)).write(pathlib.Path(folder), introduction)
