"""What the tests share."""

import os
import pathlib

import wingbeat as wb

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
PROGRAM = os.environ.get("WINGBEAT_PROGRAM")


def reference():
    return wb.read(DATA / "designs" / "friction2022.toml")
