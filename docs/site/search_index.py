"""The index of the manual's search: the sections of every page as text, from the pages that Sphinx has made."""
import html.parser
import json
import re

headings = {"h1", "h2", "h3", "h4"}
# Without end tag.
void = {"area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}
# Pages of named entries, with the tag of an entry: each is a section of its own, found by its name.
lists = {"metrics.html": "tr", "vehicle-file.html": "tr", "waveforms.html": "tr", "bibliography.html": "li"}
silent = {"script", "style", "svg", "noscript", "nav", "button", "form"}


def kind_of(page):
    """What a page is; docs/site/search.js ranks and names the kinds."""
    if page.startswith("library/"):
        return "header"
    if page.startswith("notebooks/"):
        return "notebook"
    if page.startswith("python-reference"):
        return "python"
    return "history" if page in ("changelog.html", "contributing.html", "architecture.html") else "page"


class Sections(html.parser.HTMLParser):
    """Title and sections of a page: [heading, anchor, text]; what stands in the tag `row_tag` is one, too."""

    def __init__(self, text, row_tag=None):
        super().__init__()
        self.row_tag, self.row, self.in_name = row_tag, None, False
        self.stack = []      # [tag, whether it is left out]
        self.anchors = []    # ids of the sections that are open, with their depth
        self.sections, self.inside, self.in_heading = [], False, None
        # The heading of the page, which the report of a reproduction has before its <main>.
        self.title, self.in_title = "", False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        classes = (attributes.get("class") or "").split()
        if tag in ("article", "main"):
            self.inside = True
        self.in_title = self.in_title or tag == "h1" and not self.title
        if tag in void:
            self.add(" ")
            return
        hidden = tag in silent or bool({"headerlink", "tex", "visually-hidden"} & set(classes))
        self.stack.append((tag, hidden or bool(self.stack and self.stack[-1][1])))
        if tag == "section" and attributes.get("id"):
            self.anchors.append((len(self.stack), attributes["id"]))
        if self.inside and tag == self.row_tag and self.sections:
            self.row = ["", self.sections[-1][1], ""]
        self.in_name = self.in_name or tag == "code" and self.row is not None and not self.row[0]
        if self.inside and tag in headings:
            self.in_heading = tag
            above = self.anchors[-1][1] if self.anchors else self.sections[-1][1] if self.sections else ""
            anchor = attributes.get("id") or above
            self.sections.append(["", "" if tag == "h1" else anchor, ""])
        elif tag not in ("a", "code", "em", "strong", "span", "sub", "sup", "i", "b"):
            self.add(" ")

    def handle_endtag(self, tag):
        if tag in void:
            return
        while self.stack and self.stack.pop()[0] != tag:
            pass
        if tag == "code":
            self.in_name = False
        if tag == self.row_tag and self.row is not None:
            heading = self.sections[-1]
            # A row without a name belongs to the section.
            if self.row[0]:
                self.sections.append(self.row)
                self.sections.append(["", heading[1], ""])
            else:
                heading[2] += self.row[2]
            self.row = None
        while self.anchors and self.anchors[-1][0] > len(self.stack):
            self.anchors.pop()
        if tag == self.in_heading:
            self.in_heading = None
        if tag == "h1":
            self.in_title = False
        if tag in ("article", "main"):
            self.inside = False
        if tag not in ("a", "code", "em", "strong", "span", "sub", "sup", "i", "b"):
            self.add(" ")

    def handle_data(self, data):
        self.add(data)

    def add(self, data):
        if self.in_title and not self.stack[-1][1]:
            self.title += data
        if not self.inside or not self.sections or (self.stack and self.stack[-1][1]):
            return
        if self.row is not None:
            self.row[2] += data
            if self.in_name:
                self.row[0] += data
            return
        self.sections[-1][0 if self.in_heading else 2] += data


def tidy(text):
    return re.sub(r"\s+", " ", text).strip()


def entries(site):
    """The rows of the index."""
    rows = []
    for path in sorted(site.rglob("*.html")):
        page = path.relative_to(site).as_posix()
        if page in ("search.html", "genindex.html"):
            continue
        found = Sections(path.read_text(errors="replace"), lists.get(page))
        title = tidy(found.title)
        for heading, anchor, text in found.sections:
            if heading or tidy(text):
                rows.append({"page": page, "title": title, "heading": tidy(heading), "anchor": anchor,
                             "text": tidy(text), "kind": kind_of(page)})
    return rows


def write(site):
    """search-index.js of the site; returns its rows."""
    rows = entries(site)
    text = json.dumps(rows, ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")
    (site / "search-index.js").write_text(f"const searchIndex = {text};\n")
    return rows
