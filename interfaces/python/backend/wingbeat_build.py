"""PEP 517 backend: configures and builds with CMake, and packs what its component `python` installs. Needs no network.

Settings of `pip install --config-settings=NAME=VALUE .`:
  build-dir  a build folder, configured before or not; default build/python
  jobs       compilations at a time; default: as many as there are cores
  progress   no: nothing on the terminal. Otherwise lines there say how far compiling is, which pip, unless it is given
             -v, keeps to itself with all that a build prints.
"""

from __future__ import annotations

import base64
import contextlib
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import time
import tomllib
import zipfile
from typing import TextIO

ROOT = pathlib.Path(__file__).resolve().parents[3]
# The earliest time that a zip archive can state, so that two builds are the same.
ZIP_TIME = (1980, 1, 1, 0, 0, 0)


def _project() -> dict:
    return tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def _version() -> str:
    found = re.search(r"project\(wingbeat VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    if not found:
        raise RuntimeError("CMakeLists.txt states no version")
    return found[1]


def _configure(settings: dict) -> pathlib.Path:
    """The build folder, configured."""
    folder = pathlib.Path(settings.get("build-dir", ROOT / "build" / "python")).resolve()
    # A build folder outlives the virtual environment.
    python = getattr(sys, "_base_executable", sys.executable)
    options = ["-DWINGBEAT_PYTHON=ON", f"-DPython_EXECUTABLE={python}"]
    if not (folder / "CMakeCache.txt").exists():
        options += ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON", "-DWINGBEAT_PROGRAM=OFF"]
        options += ["-DWINGBEAT_TESTS=OFF"]
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, *options], check=True)
    return folder


def _build(settings: dict | None) -> pathlib.Path:
    """The build folder, with the module built."""
    settings = settings or {}
    folder = _configure(settings)
    jobs = settings.get("jobs", os.cpu_count() or 1)
    command = ["cmake", "--build", os.fspath(folder), "--target", "wingbeat_python", "-j", str(jobs)]
    with contextlib.ExitStack() as stack:
        terminal = None
        if settings.get("progress", "yes") != "no":
            with contextlib.suppress(OSError):  # there is none
                terminal = stack.enter_context(open("/dev/tty", "w", encoding="utf-8"))
        _compile(command, Progress(terminal, folder))
    return folder


def _compile(command: list[str], progress: Progress) -> None:
    """Runs a build, whose lines go on to where they went as they come, and reports them."""
    begin = time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace") as build:
        assert build.stdout
        for line in build.stdout:
            sys.stdout.write(line)
            sys.stdout.flush()
            progress.read(line, time.monotonic() - begin)
    if build.returncode != 0:
        raise subprocess.CalledProcessError(build.returncode, command)


class Progress:
    """Says on a terminal, in lines of its own, how far a build is: at the start, at every tenth and every minute."""

    STEP = re.compile(r"\[\s*(\d+)/(\d+)\]|\[\s*(\d+)%\]")  # of Ninja, and of Make

    def __init__(self, terminal: TextIO | None, folder: pathlib.Path) -> None:
        self.terminal = terminal
        self.folder = folder
        self.share = -1.0
        self.seconds = 0.0

    def read(self, line: str, seconds: float) -> None:
        """A line of the build, so long after its begin."""
        step = self.STEP.match(line)
        if not step or self.terminal is None:
            return
        done, steps = (int(step[1]), int(step[2])) if step[1] else (int(step[3]), 100)
        share = done / max(steps, 1)
        if self.share < 0.0:
            # pip's own line is not ended yet.
            self.say(f"compiling in {self.folder}; pip install -v shows every line", start="\n")
        elif int(10 * share) <= int(10 * self.share) and seconds < self.seconds + 60.0:
            return
        self.share, self.seconds = share, seconds
        self.say(f"{100 * share:3.0f} % of {steps} steps, {int(seconds) // 60}:{int(seconds) % 60:02d} min" if step[1]
                 else f"{100 * share:3.0f} %, {int(seconds) // 60}:{int(seconds) % 60:02d} min")

    def say(self, text: str, start: str = "\r\033[K") -> None:
        """A line, in place of the spinner that pip turns at the left edge."""
        assert self.terminal
        with contextlib.suppress(OSError):
            self.terminal.write(f"{start}  wingbeat: {text}\n")
            self.terminal.flush()


def _metadata(requires: str) -> str:
    project = _project()
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {_version()}"]
    lines += [f"Summary: {project['description']}", f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {line}" for line in requires.split("\n") if line]
    for extra, packages in project["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {package}; extra == "{extra}"' for package in packages]
    lines += ["Description-Content-Type: text/markdown", "", (ROOT / project["readme"]).read_text()]
    return "\n".join(lines)


def _tag() -> str:
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def _pack(wheel: pathlib.Path, files: dict[str, bytes]) -> None:
    info = f"wingbeat-{_version()}.dist-info"
    record = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:

        def add(name: str, content: bytes) -> None:
            entry = zipfile.ZipInfo(name, ZIP_TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            archive.writestr(entry, content)

        for name, content in sorted(files.items()):
            add(name, content)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record.append(f"{name},sha256={digest},{len(content)}")
        add(f"{info}/RECORD", "\n".join([*record, f"{info}/RECORD,,", ""]).encode())


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):  # noqa: ANN001, ANN201
    """What pip asks for first: without it, it would build the wheel to see the metadata."""
    requires = (_configure(config_settings or {}) / "python" / "requires.txt").read_text()
    info = pathlib.Path(metadata_directory) / f"wingbeat-{_version()}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(_metadata(requires), encoding="utf-8")
    return info.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):  # noqa: ANN001, ANN201
    folder = _build(config_settings)
    info = f"wingbeat-{_version()}.dist-info"
    with tempfile.TemporaryDirectory() as staging:
        command = ["cmake", "--install", folder, "--component", "python", "--prefix", staging, "--strip"]
        subprocess.run(command, check=True)
        installed = (path for path in pathlib.Path(staging).rglob("*") if path.is_file())
        files = {path.relative_to(staging).as_posix(): path.read_bytes() for path in installed}
    requires = (folder / "python" / "requires.txt").read_text()
    files[f"{info}/METADATA"] = _metadata(requires).encode()
    wheel_text = f"Wheel-Version: 1.0\nGenerator: wingbeat_build\nRoot-Is-Purelib: false\nTag: {_tag()}\n"
    files[f"{info}/WHEEL"] = wheel_text.encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    name = f"wingbeat-{_version()}-{_tag()}.whl"
    _pack(pathlib.Path(wheel_directory) / name, files)
    return name


def build_sdist(sdist_directory, config_settings=None):  # noqa: ANN001, ANN201
    """The files that git tracks."""
    base = f"wingbeat-{_version()}"
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    name = f"{base}.tar.gz"
    with tempfile.NamedTemporaryFile("w", suffix="PKG-INFO") as info:
        info.write(_metadata(""))
        info.flush()
        with tarfile.open(pathlib.Path(sdist_directory) / name, "w:gz") as archive:
            archive.add(info.name, f"{base}/PKG-INFO")
            for file in filter(None, listed.split("\0")):
                archive.add(ROOT / file, f"{base}/{file}")
    return name


def get_requires_for_build_wheel(config_settings=None):  # noqa: ANN001, ANN201
    return []


def get_requires_for_build_sdist(config_settings=None):  # noqa: ANN001, ANN201
    return []
