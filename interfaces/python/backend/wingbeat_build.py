"""PEP 517 backend: configures and builds with CMake, and packs what its component `python` installs. Needs no network.

Settings of `pip install --config-settings=NAME=VALUE .`:
  build-dir  a build folder, configured before or not; default build/python
  jobs       compilations at a time; default: as many as there are cores
"""

from __future__ import annotations

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import tomllib
import zipfile

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


def _build(settings: dict | None) -> pathlib.Path:
    """The build folder, with the module built."""
    settings = settings or {}
    folder = pathlib.Path(settings.get("build-dir", ROOT / "build" / "python")).resolve()
    # A build folder outlives the virtual environment.
    python = getattr(sys, "_base_executable", sys.executable)
    options = ["-DWINGBEAT_PYTHON=ON", f"-DPython_EXECUTABLE={python}"]
    if not (folder / "CMakeCache.txt").exists():
        options += ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON", "-DWINGBEAT_PROGRAM=OFF"]
        options += ["-DWINGBEAT_TESTS=OFF"]
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, *options], check=True)
    jobs = settings.get("jobs", os.cpu_count() or 1)
    subprocess.run(["cmake", "--build", folder, "--target", "wingbeat_python", "-j", str(jobs)], check=True)
    return folder


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
