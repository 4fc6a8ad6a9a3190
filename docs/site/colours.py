"""Colours of the manual in both themes, and the contrast of text on its ground (WCAG 2.1: at least 4.5 to 1)."""
import re

from pygments.style import Style
from pygments.token import (
    Comment, Error, Generic, Keyword, Literal, Name, Number, Operator, Punctuation, String, Text, Token, Whitespace,
)

required = 4.5

# Of the theme (furo), all of them: Debian's build of its style sheet lacks its rules for a dark system.
light = {
    "color-foreground-primary": "#1b1f24", "color-foreground-secondary": "#50555c", "color-foreground-muted": "#5c626a",
    "color-foreground-border": "#878787", "color-background-primary": "#ffffff",
    "color-background-secondary": "#f8f9fb", "color-background-hover": "#eaeff4",
    "color-background-hover--transparent": "#eaeff400", "color-background-border": "#e2e5e9",
    "color-background-item": "#d0d3d7", "color-brand-primary": "#005a8c", "color-brand-content": "#00639c",
    "color-highlighted-background": "#d7e9fb", "color-highlight-on-target": "#fff8d6",
    "color-admonition-background": "#f4f6f8", "color-card-border": "#f8f9fb", "color-card-background": "#f6f8fa",
    "color-card-marginals-background": "#eaeff4", "color-problematic": "#b3261e",
    "color-inline-code-background": "#f3f5f7", "color-mark": "#fff1a8",
}
dark = {
    "color-foreground-primary": "#dfe2e6", "color-foreground-secondary": "#a8adb4", "color-foreground-muted": "#979da5",
    "color-foreground-border": "#666666", "color-background-primary": "#131416",
    "color-background-secondary": "#1a1c1e", "color-background-hover": "#23272b",
    "color-background-hover--transparent": "#23272b00", "color-background-border": "#303335",
    "color-background-item": "#444444", "color-brand-primary": "#7cc4ee", "color-brand-content": "#7cc4ee",
    "color-highlighted-background": "#083563", "color-highlight-on-target": "#333300",
    "color-admonition-background": "#18181a", "color-card-border": "#1a1c1e", "color-card-background": "#1d2024",
    "color-card-marginals-background": "#23272b", "color-problematic": "#ff8a80",
    "color-inline-code-background": "#1d2125", "color-mark": "#5a4a00",
}
# What stands on what.
pairs = [(text, ground) for text in ("color-foreground-primary", "color-foreground-secondary", "color-foreground-muted",
                                     "color-brand-primary", "color-brand-content", "color-problematic")
         for ground in ("color-background-primary", "color-background-secondary", "color-background-hover",
                        "color-card-background", "color-admonition-background", "color-inline-code-background")]
pairs += [("color-foreground-primary", ground) for ground in ("color-mark", "color-highlighted-background",
                                                              "color-highlight-on-target")]


def _styles(text, comment, keyword, string, number, name, error):
    return {
        Token: text, Text: text, Whitespace: text, Punctuation: text, Operator: text, Name: text,
        Comment: f"italic {comment}", Comment.Preproc: f"noitalic {keyword}",
        Comment.PreprocFile: f"noitalic {string}", Keyword: keyword, Operator.Word: keyword, Name.Builtin: name,
        Name.Function: name, Name.Class: name, Name.Decorator: name,
        Name.Tag: name, Name.Attribute: name, Literal: number, Number: number, String: string, Error: error,
        Generic: text, Generic.Output: text, Generic.Prompt: comment, Generic.Traceback: error, Generic.Error: error,
    }


class Light(Style):
    """Code and program output by day."""
    background_color = "#f3f5f7"
    highlight_color = "#fff1a8"
    styles = _styles("#1b1f24", "#57606a", "#8a2b7c", "#0a5c36", "#0b5394", "#7a3e00", "#b3261e")


class Dark(Style):
    """Code and program output by night."""
    background_color = "#1d2125"
    highlight_color = "#5a4a00"
    styles = _styles("#dfe2e6", "#9aa4ae", "#e59ccb", "#7fd4a8", "#7cc4ee", "#f0b775", "#ff8a80")


def channels(colour):
    """Red, green and blue of #rrggbb or #rgb from 0 to 255."""
    digits = colour.lstrip("#")
    digits = "".join(2 * digit for digit in digits) if len(digits) == 3 else digits
    if not re.fullmatch("[0-9a-fA-F]{6}", digits):
        raise ValueError(f"{colour} is not an opaque colour")
    return [int(digits[n:n + 2], 16) for n in (0, 2, 4)]


def luminance(colour):
    """Relative luminance, WCAG 2.1."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in (v / 255 for v in channels(colour))]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(text, ground):
    """Contrast of two colours, 1 to 21."""
    lighter, darker = sorted((luminance(text), luminance(ground)), reverse=True)
    return (lighter + 0.05) / (darker + 0.05)


def code_colours(style):
    """The colours in which a style shows code: (token, text, ground)."""
    return [(str(token), f"#{kind['color'] or '000000'}",
             f"#{kind['bgcolor']}" if kind["bgcolor"] else style.background_color) for token, kind in style]


def too_faint():
    """What is hard to read, a sentence each."""
    found = []
    for theme, colours, style in (("light", light, Light), ("dark", dark, Dark)):
        shown = [(f"{text} on {ground}", colours[text], colours[ground]) for text, ground in pairs]
        shown += code_colours(style)
        found += [f"{theme}: {what}: {contrast(text, ground):.2f}" for what, text, ground in shown
                  if contrast(text, ground) < required]
    return found
