"""What must hold of the finished manual: links, style sheets, the search, and the contrast of every text."""
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import urllib.parse

here = pathlib.Path(__file__).resolve().parent


class Page(html.parser.HTMLParser):
    """Links and anchors of one page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors.update(attributes[key] for key in ("id", "name") if attributes.get(key))
        self.links += [(tag, key, attributes[key]) for key in ("href", "src", "data") if attributes.get(key)]


def local(path, link):
    """The file that a link of the file `path` leads to, with its anchor; None where it leads out of the site."""
    url = urllib.parse.urlsplit(link)
    if url.scheme or url.netloc:
        return None
    target = path.parent / urllib.parse.unquote(url.path) if url.path else path
    return pathlib.Path(os.path.normpath(target)), urllib.parse.unquote(url.fragment)


def pages_of(site):
    return {path: Page(path.read_text(errors="replace")) for path in site.rglob("*.html")}


def broken_links(site, pages):
    """Links that lead nowhere or into the network for what a page shows, and pages that are hard to reach. Anchors with
    an equals sign are states of the explorer."""
    found, leads = [], {}
    for path, page in pages.items():
        leads[path] = set()
        for tag, key, link in page.links:
            scheme = urllib.parse.urlsplit(link).scheme
            if scheme in ("http", "https", "mailto"):
                if key != "href" or tag == "link":
                    found.append(f"{path.name} loads {link} from the network")
            elif scheme not in ("data", "javascript"):
                target, anchor = local(path, link)
                leads[path].add(target)
                if not target.is_file():
                    found.append(f"{path.name} links to {link}, which is not there")
                elif anchor and "=" not in anchor and target in pages and anchor not in pages[target].anchors:
                    found.append(f"{path.name} links to {link}, an anchor that is not there")
    first = site / "index.html"
    reached = {first} | leads[first]
    reached |= {page for one in leads[first] for page in leads.get(one, ())}
    found += [f"{path.relative_to(site)} is more than two links away from the first page" for path in pages
              if path not in reached]
    return sorted(set(found))


def sheet_links(text):
    """What a style sheet loads."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    imports = re.findall(r"@import\s+(?:url\()?\s*[\"']?([^\"');]+)", text)
    return imports + [link for link in re.findall(r"url\(\s*[\"']?([^\"')]+)", text) if not link.startswith("data:")]


def used_files(site, pages):
    """Files that pages show or load, and what the style sheets among them load; and what of it is not there."""
    used, missing = set(), []
    waiting = [(path, link) for path, page in pages.items() for _, _, link in page.links]
    while waiting:
        path, link = waiting.pop()
        found = local(path, link)
        if found is None or found[0] in used:
            continue
        target = found[0]
        if not target.is_file():
            missing.append(f"{path.relative_to(site)} loads {link}, which is not there")
            continue
        used.add(target)
        if target.suffix == ".css":
            waiting += [(target, link) for link in sheet_links(target.read_text())]
    return used, sorted(set(missing))


def remove_unused(site, pages):
    """Leaves in _static what pages use, and licences."""
    used, _ = used_files(site, pages)
    for path in sorted((site / "_static").rglob("*"), reverse=True):
        if path.is_file() and path not in used and path.name != "copyright":
            path.unlink()
        elif path.is_dir() and not any(path.iterdir()):
            path.rmdir()


def dead_styles(site, pages):
    """Style sheets that no page links to or whose own links lead nowhere."""
    used, missing = used_files(site, pages)
    found = [text for text in missing if ".css loads" in text]
    for sheet in site.rglob("*.css"):
        if sheet not in used:
            found.append(f"{sheet.relative_to(site)} is a style sheet of no page")
        found += [f"{sheet.relative_to(site)} loads {link}" for link in sheet_links(sheet.read_text())
                  if link.startswith(("/", "http:", "https:"))]
    return sorted(set(found))


# A query and the page that must be the first found, "" for any; C++ headers stand behind all pages.
queries = [
    ("friction", ""), ("crank_kinematics", ""), ("hover", ""), ("pitch hinge", "pitch-hinges.html"),
    ("lift_mean_n", "metrics.html"), ("motor.armature_inductance", "vehicle-file.html"), ("sweep", "sweep.html"),
    ("InputError", "python-reference/vehicles.html"), ("solve_columns", "python-reference/ensembles.html"),
    ("motor data sheet", "motors.html"), ("how long does a battery last", "endurance.html"), ("fmu", "fmu.html"),
    ("Dickinson", "bibliography.html"), ("install", "install.html"),
    ("tolerance", "tolerance.html"), ("Reynolds number", "domain.html"), ("gallery", "gallery.html"),
]


def search_faults(site):
    """Queries whose first result is another page, has no excerpt, or stands behind a C++ header."""
    script = """
const search = require(process.argv[1]), fs = require("fs");
const index = new Function(fs.readFileSync(process.argv[2], "utf8") + "return searchIndex;")();
console.log(JSON.stringify(JSON.parse(process.argv[3]).map(query => {
  const pages = search.rank(index, query);
  return { pages: pages.map(page => [page.page, page.kind]), excerpts: pages.map(
    page => search.excerpt(search.textOf(page, query), query)) };
})));"""
    done = subprocess.run(["node", "-e", script, here / "search.js", site / "search-index.js",
                           json.dumps([query for query, _ in queries])], capture_output=True, text=True)
    if done.returncode != 0:
        return [f"the search fails: {done.stderr}"]
    found = []
    for (query, wanted), result in zip(queries, json.loads(done.stdout)):
        pages = [page for page, _ in result["pages"]]
        if not pages or wanted and pages[0] != wanted:
            found.append(f'the search for "{query}" finds {", ".join(pages[:4]) or "nothing"}, not {wanted} first')
            continue
        kinds = [kind == "header" for _, kind in result["pages"]]
        if kinds != sorted(kinds):
            found.append(f'the search for "{query}" finds C++ headers before pages')
        shown = sum(any(marked for _, marked in excerpt) for excerpt in result["excerpts"])
        if 2 * shown < len(pages):
            found.append(f'the search for "{query}" shows excerpts with the term for {shown} of {len(pages)} pages')
    return found


def faint_texts(site, names, required):
    """Texts of the pages `names` that are hard to read in either theme, as Chromium shows them: by the system's theme
    and by the page's button. None where there is no Chromium."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if not chromium:
        return None
    harness = site / "contrast-check.html"
    frames = "".join(f'<iframe src="{name}" style="width: 1280px; height: 900px"></iframe>' for name in names)
    harness.write_text(f'<!doctype html><title>contrast</title><pre id="found"></pre>{frames}<script>'
                       f"const required = {required};"
                       f"{(here / 'contrast.js').read_text()}</script>")
    found = []
    try:
        for system, scheme in (("light", 1), ("dark", 0)):
            # A Chromium that has hung is started once more.
            for _ in range(2):
                with tempfile.TemporaryDirectory() as profile:
                    done = subprocess.run(
                        ["timeout", "300", chromium, "--headless", "--no-sandbox", "--disable-gpu",
                         f"--user-data-dir={profile}", "--allow-file-access-from-files",
                         f"--blink-settings=preferredColorScheme={scheme}",
                         "--window-size=1280,900", "--dump-dom",
                         f"{harness.as_uri()}#{system}"],
                        capture_output=True, text=True)
                text = re.search(r'<pre id="found">(.*?)</pre>', done.stdout, re.S)
                if text and text[1].startswith("{"):
                    break
            else:
                return [f"Chromium did not measure the contrast: {done.stderr[-500:]}"]
            result = json.loads(html.unescape(text[1]))
            if result["texts"] < 100 * len(names):
                return [f"Chromium has measured {result['texts']} texts only"]
            found += result["found"]
    finally:
        harness.unlink()
    return found
