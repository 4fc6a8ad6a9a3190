"""What the tests share."""

import os
import pathlib

import wingbeat as wb

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA, CASES = ROOT / "data", ROOT / "tests" / "cases"
PROGRAM = os.environ.get("WINGBEAT_PROGRAM")


def reference():
    return wb.read(DATA / "designs" / "friction2022.toml")
