"""Sphinx settings of the manual; scripts/build-site lays out the pages, runs Sphinx and renders the equations."""
import pathlib
import re
import sys

from docutils import nodes

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(here))
import colours  # noqa: E402

version = re.search(r"VERSION (\d+\.\d+\.\d+)", (here / "project.cmake").read_text())[1]
project = "wingbeat"
author = "the wingbeat authors"
release = version
html_title = f"wingbeat {version}"

extensions = ["myst_parser"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
root_doc = "index"
exclude_patterns = ["extra"]
myst_enable_extensions = ["dollarmath", "html_image"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]
highlight_language = "none"
default_role = None
smartquotes = False

html_theme = "furo"
html_static_path = ["static"]
html_extra_path = ["extra"]
html_css_files = ["site.css", "katex/katex.min.css"]
html_copy_source = False
html_use_index = False
html_show_sourcelink = False
html_show_sphinx = False
html_show_copyright = False
html_last_updated_fmt = None
templates_path = ["templates"]
pygments_style = "colours.Light"
pygments_dark_style = "colours.Dark"
html_theme_options = {
    "light_css_variables": {
        "font-stack": "system-ui, 'DejaVu Sans', 'Helvetica Neue', Arial, sans-serif",
        "font-stack--monospace": "'DejaVu Sans Mono', ui-monospace, Menlo, Consolas, monospace",
        **colours.light,
    },
    "dark_css_variables": colours.dark,
    "navigation_with_keys": False,
}


def plain(self, node):
    """TeX between marks that scripts/build-site replaces."""
    self.body.append(f'<span class="tex">{self.encode(node.astext())}</span>')
    raise nodes.SkipNode


def displayed(self, node):
    self.body.append(f'<div class="tex">{self.encode(node.astext())}</div>\n')
    raise nodes.SkipNode


def without_unused(app, page, template, context, doctree):
    """Nothing here uses the extensions that furo has a style sheet for, nor the scripts of Sphinx."""
    context["css_files"] = [sheet for sheet in context.get("css_files", []) if "furo-extensions" not in str(sheet)]
    context["script_files"] = [script for script in context.get("script_files", []) if "furo" in str(script)]


def grouped_navigation(app, page, template, context, doctree):
    """Groups of the sidebar that open and close; the group of the page is open, on the first page all are."""
    before, *groups = context.get("furo_navigation_tree", "").split('<p class="caption" role="heading">')
    made = []
    for group in groups:
        caption, pages = group.split("</p>", 1)
        opened = " open" if page == app.config.root_doc or "current-page" in pages else ""
        made.append(f'<details class="group"{opened}><summary>{caption}</summary>{pages}</details>')
    context["furo_navigation_tree"] = before + "".join(made)


def setup(app):
    app.add_html_math_renderer("katex", (plain, None), (displayed, None))
    app.connect("html-page-context", without_unused, priority=900)
    app.connect("html-page-context", grouped_navigation, priority=901)


html_math_renderer = "katex"
