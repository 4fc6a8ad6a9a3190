"""Sphinx settings of the manual; scripts/build-site lays out the pages, runs Sphinx and renders the equations."""
import pathlib
import re

from docutils import nodes

here = pathlib.Path(__file__).resolve().parent
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
html_show_sourcelink = False
html_show_sphinx = False
html_show_copyright = False
html_last_updated_fmt = None
pygments_style = "friendly"
pygments_dark_style = "monokai"
html_theme_options = {
    "light_css_variables": {
        "font-stack": "system-ui, 'DejaVu Sans', 'Helvetica Neue', Arial, sans-serif",
        "font-stack--monospace": "'DejaVu Sans Mono', ui-monospace, Menlo, Consolas, monospace",
        "color-brand-primary": "#005a8c",
        "color-brand-content": "#00639c",
    },
    "dark_css_variables": {"color-brand-primary": "#7cc4ee", "color-brand-content": "#7cc4ee"},
    "navigation_with_keys": False,
}


def plain(self, node):
    """TeX between marks that scripts/build-site replaces."""
    self.body.append(f'<span class="tex">{self.encode(node.astext())}</span>')
    raise nodes.SkipNode


def displayed(self, node):
    self.body.append(f'<div class="tex">{self.encode(node.astext())}</div>\n')
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("katex", (plain, None), (displayed, None))


html_math_renderer = "katex"
