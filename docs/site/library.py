"""The library's interface as pages, from the XML that Doxygen makes of its headers.

Sphinx's own C++ domain (which breathe writes for) does not know concepts and requires clauses; here declarations are
code.
"""
import html
import pathlib
import re
import xml.etree.ElementTree as ElementTree


def hidden(name):
    """Tables and lists of the code itself."""
    return re.match(r"names_of\b|members$", name) is not None


def escaped(text):
    """Text that Markdown is to leave as it is."""
    return re.sub(r"([\\`*_{}\[\]<>$|#~])", r"\\\1", text)


def flat(node):
    return "".join(node.itertext()) if node is not None else ""


def tidy(code):
    """C++ as the headers have it, not as Doxygen spaces it."""
    for old, new in (("< ", "<"), (" >", ">"), (" &", "& "), (" *", "* "), ("& )", "&)"), ("  ", " ")):
        code = code.replace(old, new)
    return code


class Library:
    def __init__(self, xml, include):
        self.include = include
        model = (include.parent / "docs/model.md").read_text()
        self.sections = {found[1]: anchor_of(found[0]) for found in re.finditer(r"(?<=^## )(\d+)\. .*$", model, re.M)}
        self.entries = {}  # header -> [(line, node, kind)]
        self.places = {}   # id -> (header, anchor, name)
        for path in sorted(xml.glob("*.xml")):
            if path.name.startswith(("namespace", "struct", "class", "concept", "union")):
                self.read(ElementTree.parse(path).getroot()[0])
        for header, entries in self.entries.items():
            entries.sort(key=lambda entry: entry[0])
            # Overloads have one heading, at the first of them; so has a type that is specialised.
            for _, node in entries:
                name = self.name_of(node)
                bare = node.get("kind") == "variable" and not flat(node.find("briefdescription")).strip()
                self.places[node.get("id")] = (header, "constants" if bare else anchor_of(name), name)

    def read(self, compound):
        if compound.get("kind") != "namespace":
            location = compound.find("location")
            # A type within a type shows there.
            name = compound.findtext("compoundname")
            if location is not None and "::detail" not in name and not self.nested(name):
                self.add(location, compound)
            return
        for member in compound.iter("memberdef"):
            if not hidden(member.findtext("name")):
                self.add(member.find("location"), member)

    @staticmethod
    def nested(name):
        last = re.sub(r"<.*", "", name).split("::")[-2:]
        return len(last) == 2 and last[0][:1].isupper()

    def add(self, location, node):
        file = location.get("file")
        if file.startswith("include/"):
            file = file.removeprefix("include/")
        if (self.include / file).exists():
            self.entries.setdefault(file, []).append((int(location.get("line", 0)), node))

    @staticmethod
    def name_of(node):
        name = node.findtext("name") or node.findtext("compoundname")
        return re.sub(r"^(?:\w+::)+(?=\w)", "", re.sub(r"\s*<.*", "", name)) if not node.findtext("name") else name

    # --- text

    def prose(self, text):
        """Text of a comment, with links to the sections of the model that it names."""
        return re.sub(r"model\.md section (\d+)",
                      lambda found: f"[{found[0]}](../../model.md#{self.sections[found[1]]})", escaped(text))

    def link(self, node, here):
        text = flat(node)
        place = self.places.get(node.get("refid"))
        return f"[{escaped(text)}]({self.address(place)})" if place and place[0] != here else escaped(text)

    @staticmethod
    def address(place):
        header, anchor, _ = place
        return f"../{page_of(header)}.md#{anchor}"

    def inline(self, node, here):
        parts = [self.prose(node.text or "")]
        for child in node:
            if child.tag == "ref":
                parts.append(self.link(child, here))
            elif child.tag == "formula":
                tex = child.text.strip()
                shown = tex.startswith("\\[")
                tex = tex[2:-2] if shown else tex.strip("$")
                # Inline ones stand in tables, too, whose cells a bar would end.
                inline = tex.strip().replace("|", r"\vert ")
                parts.append(f"\n\n$$\n{tex.strip()}\n$$\n\n" if shown else f"${inline}$")
            elif child.tag == "computeroutput":
                parts.append(f"`{flat(child)}`")
            elif child.tag in ("emphasis", "bold"):
                parts.append(f"*{self.inline(child, here)}*")
            elif child.tag in ("itemizedlist", "orderedlist"):
                parts.append("\n\n" + "".join(f"* {self.paragraphs(item, here, ' ')}\n" for item in child) + "\n")
            elif child.tag in ("verbatim", "programlisting", "preformatted"):
                lines = [re.sub(r"\xa0", " ", flat(line)) for line in child.iter("codeline")] or [flat(child)]
                parts.append("\n\n```cpp\n" + "\n".join(lines).strip("\n") + "\n```\n\n")
            elif child.tag == "sp":
                parts.append(" ")
            elif child.tag == "linebreak":
                parts.append("\n")
            elif child.tag == "simplesect":
                parts.append(f"\n\n{child.get('kind').capitalize()}: {self.paragraphs(child, here, ' ')}\n\n")
            else:
                parts.append(self.inline(child, here))
            parts.append(self.prose(child.tail or ""))
        return re.sub(r" *\n *", "\n", "".join(parts)).strip(" ")

    def paragraphs(self, node, here, between="\n\n"):
        return between.join(filter(None, (self.inline(para, here).strip() for para in node.findall("para"))))

    def text_of(self, node, here, between="\n\n"):
        brief, rest = (self.paragraphs(node.find(part), here, between) if node.find(part) is not None else ""
                       for part in ("briefdescription", "detaileddescription"))
        # Doxygen parts the first sentence from those behind it, and takes "J." for the end of one.
        goes_on = brief and rest and not rest.startswith(("$$", "*", "```"))
        return brief + " " + rest if goes_on else between.join(filter(None, (brief, rest)))

    def cell_of(self, node, here):
        """Text for a table; Doxygen ends some phrases with a full stop."""
        text = self.text_of(node, here, " ")
        return text if ". " in text else text.removesuffix(".")

    # --- declarations

    @staticmethod
    def template(node):
        listed = node.find("templateparamlist")
        if listed is None:
            return ""
        params = [" ".join(filter(None, [flat(param.find("type")), param.findtext("declname")])) +
                  (f" = {flat(param.find('defval'))}" if param.find("defval") is not None else "") for param in listed]
        clause = flat(node.find("requiresclause"))
        return f"template <{', '.join(params)}>\n" + (f"requires {clause}\n" if clause else "")

    def declaration(self, node):
        kind, name = node.get("kind"), node.findtext("name")
        head = self.template(node)
        if kind in ("struct", "class", "union"):
            full = re.sub(r"^(?:\w+::)+(?=\w)", "", node.findtext("compoundname"))
            return f"{head}{kind} {full};"
        if kind == "concept":
            return flat(node.find("initializer")).strip()
        type_ = flat(node.find("type")).strip()
        if kind == "enum":
            return f"enum {'class ' if node.get('strong') == 'yes' else ''}{name};"
        if kind == "typedef":
            return head + flat(node.find("definition")).replace("wingbeat::", "").replace("= typedef ", "= ") + ";"
        arguments = flat(node.find("argsstring"))
        initial = flat(node.find("initializer")).strip()
        initial = f" {initial}" if initial and len(initial) < 80 and "\n" not in initial else ""
        if kind == "function":
            line = f"{'static ' if node.get('static') == 'yes' else ''}{type_} {name}{arguments};".strip()
            if len(line) > 100:
                line = wrapped(line)
            return head + line
        return f"{head}{type_} {name}{arguments}{initial};"

    def related(self, nodes, here):
        """Types and functions that the declarations name, as links."""
        found = {}
        for node in nodes:
            for part in ("type", "param", "initializer"):
                for piece in node.findall(part):
                    for ref in piece.iter("ref"):
                        place = self.places.get(ref.get("refid"))
                        if place and place[2] != self.name_of(node):
                            found[place[2]] = place
        return ", ".join(f"[{escaped(name)}]({self.address(place)})" for name, place in sorted(found.items()))

    # --- pages

    def headers(self):
        return sorted(self.entries)

    def page(self, header):
        first = first_comment(self.include / header)
        name = pathlib.PurePosixPath(header).name
        source = f"../../files/include/{header}"
        first = escaped(first).replace("model.md", "[model.md](../../model.md)")
        lines = [f"# {name}\n", first + "\n" if first else "",
                 f'```cpp\n#include "{header}"\n```\n', f'<a href="{source}">Source</a>\n']
        entries = [node for _, node in self.entries[header]]
        # Constants that say nothing of themselves, such as keys, are one list.
        bare = [node for node in entries if node.get("kind") == "variable" and not self.text_of(node, header)]
        entries = [node for node in entries if node not in bare]
        done = set()
        for node in entries:
            title = self.name_of(node)
            if title in done:
                continue
            done.add(title)
            same = [other for other in entries if self.name_of(other) == title]
            lines.append(f"\n## {escaped(title)}\n")
            for one in same:
                lines.append(f"```cpp\n{tidy(self.declaration(one))}\n```\n")
                lines.append(self.text_of(one, header) + "\n")
                if one.get("kind") == "enum":
                    lines.append(table([(f"`{value.findtext('name')}`", self.cell_of(value, header))
                                        for value in one.findall("enumvalue")]))
                if one.tag == "compounddef":
                    lines.append(self.members(one, header))
            related = self.related(same, header)
            if related:
                lines.append(f"Uses {related}.\n")
        if bare:
            constants = "\n".join(tidy(self.declaration(node)) for node in bare)
            lines.append(f"\n## Constants\n\n```cpp\n{constants}\n```\n")
        return "\n".join(line for line in lines if line.strip()) + "\n"

    def members(self, compound, here):
        fields, rest = [], []
        for member in compound.iter("memberdef"):
            if member.get("prot") != "public" or hidden(member.findtext("name")) or member.get("kind") == "friend":
                continue
            if member.get("kind") == "variable" and member.find("templateparamlist") is None:
                fields.append((f"`{tidy(self.declaration(member)).rstrip(';')}`", self.cell_of(member, here)))
            else:
                rest.append(member)
        text = table(fields)
        for member in rest:
            text += f"\n```cpp\n{tidy(self.declaration(member))}\n```\n\n{self.text_of(member, here)}\n"
        return text


def wrapped(line):
    """A long declaration with each argument on a line of its own."""
    open_ = line.find("(")
    depth, pieces, start = 0, [], open_ + 1
    for n in range(open_ + 1, len(line)):
        if line[n] in "(<{[":
            depth += 1
        elif line[n] in ")>}]":
            if depth == 0:
                pieces.append(line[start:n])
                return line[: open_ + 1] + "\n    " + ",\n    ".join(p.strip() for p in pieces) + line[n:]
            depth -= 1
        elif line[n] == "," and depth == 0:
            pieces.append(line[start:n])
            start = n + 1
    return line


def table(rows):
    cells = [tuple(cell.replace("\n", " ") for cell in row) for row in rows]
    lines = "".join(f"| {a.replace('|', chr(92) + '|')} | {b} |\n" for a, b in cells)
    return f"| | |\n| --- | --- |\n{lines}" if rows else ""


def anchor_of(name):
    return re.sub(r"[^\w -]", "", name.lower()).replace(" ", "-")


def page_of(header):
    path = pathlib.PurePosixPath(header)
    return f"{layer_of(header)}/{path.stem}"


def layer_of(header):
    parts = pathlib.PurePosixPath(header).parts
    return parts[1] if len(parts) > 2 else "facade"


def first_comment(path):
    """What the header says of itself, as one paragraph."""
    found = re.match(r"(?://[^\n]*\n)+", path.read_text())
    lines = [line[2:].strip() for line in found[0].splitlines()] if found else []
    return " ".join(lines[: lines.index("")] if "" in lines else lines)


def first_sentence(path):
    return re.split(r"(?<=[a-z0-9)\]])[.;:] ", first_comment(path))[0].rstrip(".")


def write_pages(xml, include, folder, described, introduction):
    """library.md and a page for each layer and header in `folder`; returns the names of the pages of layers, in the
    order of `described`, which says what each layer is."""
    library = Library(xml, include)
    layers = {}
    for header in library.headers():
        layers.setdefault(layer_of(header), []).append(header)
    order = sorted(layers, key=lambda name: (list(described).index(name) if name in described else -1))
    index, pages = introduction, []
    for layer in order:
        text = described.get(layer, "All that most users of the library need, by one include")
        text = text[:1].upper() + text[1:]
        title = "wingbeat.hpp" if layer == "facade" else layer
        body = f"# {title}\n\n{text}.\n\n| header | what is in it |\n| --- | --- |\n"
        entries = []
        for header in layers[layer]:
            place = folder / "library" / f"{page_of(header)}.md"
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(library.page(header))
            entries.append(page_of(header))
            body += f"| [{place.stem}.hpp]({page_of(header)}.md) | {escaped(first_sentence(include / header))} |\n"
        body += "\n```{toctree}\n:hidden:\n\n" + "\n".join(entries) + "\n```\n"
        (folder / "library" / f"{layer}.md").write_text(body)
        pages.append(f"library/{layer}.md")
        index += f"| [{layer}](library/{layer}.md) | {text} |\n"
    index += "\n```{toctree}\n:hidden:\n\n" + "\n".join(page.removesuffix(".md") for page in pages) + "\n```\n"
    (folder / "library.md").write_text(index)
    return ["library.md", *pages]
