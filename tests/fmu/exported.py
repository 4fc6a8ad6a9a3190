"""Exported vehicles that the tests share, and how they are run."""

import json
import os
import pathlib
import subprocess
import tempfile

from importer import Package

PROGRAM = os.environ["WINGBEAT_PROGRAM"]
FOLDER = tempfile.TemporaryDirectory(prefix="wingbeat-fmus-")
CRANK, DIRECT, HINGED = "friction2022", "direct-drive", "pitch-hinge"
PWM = ("--set", "supply.type=\"pwm\"", "--set", "supply.voltage=4", "--set", "supply.duty=0.75",
       "--set", "supply.frequency=2e3")  # fmt: skip
TWO = ("--set", "vehicle.motors=2")
STOPS = ("--set", "pitch.stop=20 deg")
HINGED_CRANK = "pitch-hinge-crank"
FLYING = "flight-friction2022"


def export(vehicle, version=2, *options):
    file = pathlib.Path(FOLDER.name) / f"{vehicle}{version}{abs(hash(options)) if options else ''}.fmu"
    if not file.exists():
        made = [PROGRAM, "export-fmu", vehicle, "-o", file, "--fmi", str(version), *options]
        subprocess.run(made, check=True, capture_output=True)
    return Package(file)


def run(vehicle, *options):
    found = subprocess.run([PROGRAM, "run", vehicle, "--json", "--tolerance", "1e-9", *options], capture_output=True)
    return json.loads(found.stdout)


def steps(instance, begin, end, length=1e-3):
    for k in range(round((end - begin) / length)):
        instance.step(begin + k * length, length)
