"""The gallery: docs/gallery.md with the figures that its commands draw."""
import concurrent.futures
import html
import os
import pathlib
import re
import shlex
import shutil
import subprocess

entry = re.compile(r"^(?P<text>[^\n#`|<][^\n]*(?:\n[^\n]+)*)\n\n```\n(?P<command>wingbeat [^\n]*)\n```\n", re.M)


def figure_of(command):
    """The file that a command draws."""
    words = shlex.split(command)
    drawn = [words[n + 1] for n, word in enumerate(words[:-1]) if word in ("--plot", "--plot-power", "--plot-cycles")]
    if len(drawn) != 1:
        raise LookupError(f"docs/gallery.md: {command} does not draw one figure")
    return drawn[0]


def draw(commands, program, data, work, figures):
    """Runs the commands in a folder of their own and puts what they draw into the folder `figures`."""
    names = [figure_of(command) for command in commands]
    if len(set(names)) < len(names):
        raise LookupError("docs/gallery.md draws one file twice")
    (work / "gallery").mkdir()
    (work / "gallery/data").symlink_to(data)
    figures.mkdir(parents=True)

    def one(command):
        return subprocess.run([program, *shlex.split(command)[1:]], cwd=work / "gallery", capture_output=True,
                              text=True)

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for command, name, done in zip(commands, names, pool.map(one, commands)):
            if done.returncode != 0 or not (work / "gallery" / name).exists():
                raise LookupError(f"docs/gallery.md: {command} failed:\n{done.stderr}")
            shutil.copyfile(work / "gallery" / name, figures / name)


def card(text, command, address):
    """A figure of the gallery. Markdown stands between the tags."""
    about = re.sub(r"\s+", " ", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)).split(":")[0].rstrip(".")
    return (f'<figure>\n<a href="{address}"><img src="{address}" alt="{html.escape(about)}" loading="lazy"></a>\n'
            f"<figcaption>\n\n{text.strip()}\n\n</figcaption>\n<pre>{html.escape(command)}</pre>\n</figure>\n")


def page(text, program, data, work, figures, reproduction):
    """The Markdown of the gallery with its figures, which are drawn into `figures`, and those of the reproduction:
    [(address, caption), ...]."""
    commands = [found["command"] for found in entry.finditer(text)]
    draw(commands, program, data, work, figures)
    sections = []
    for section in re.split(r"(?=^## )", text, flags=re.M):
        cards = [card(found["text"], found["command"], f"gallery/{figure_of(found['command'])}")
                 for found in entry.finditer(section)]
        if cards:
            heading = section.split("\n", 1)[0]
            sections.append(f'{heading}\n\n<div class="gallery">\n\n' + "\n".join(cards) + "\n</div>\n\n")
        else:
            sections.append(section)
    command = "wingbeat reproduce friction2022 -o reproduction"
    cards = [card(caption, command, address) for address, caption in reproduction]
    return "".join(sections) + '\n<div class="gallery">\n\n' + "\n".join(cards) + "\n</div>\n"


def reproduced(folder):
    """The figures of a reproduction with their captions, from its report."""
    report = (pathlib.Path(folder) / "report.html").read_text()
    found = []
    for path in sorted(pathlib.Path(folder).glob("figure-*.svg")):
        number = re.fullmatch(r"figure-0*(\d+)", path.stem)
        if not number:
            continue
        title = re.search(rf"<b>Figure {number[1]}\. ([^<]*)</b>", report)
        text = f"Figure {number[1]}" + (f": {html.unescape(title[1]).strip()}" if title else "")
        found.append((f"reproduce/{path.name}", text + "."))
    return found
