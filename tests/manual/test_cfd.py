"""The script that export-kinematics writes for PteraSoftware runs against a package of the same signatures: every call
is one that they take, the motion is that of the CSV file, and compare-loads reads what the script writes. The solver
behind it is none: no load is checked here."""

import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import types
import unittest

try:
    import numpy as np
except ImportError:
    np = None

PROGRAM = pathlib.Path(os.environ["WINGBEAT_PROGRAM"])
VEHICLE = ("pitch-hinge-crank", "--frequency", "22 Hz")


class Airfoil:
    def __init__(self, name, outline_A_lp=None, resample=True, n_points_per_side=400):
        self.name = name


class WingCrossSection:
    def __init__(self, airfoil, num_spanwise_panels, chord=1.0, Lp_Wcsp_Lpp=(0.0, 0.0, 0.0),
                 angles_Wcsp_to_Wcs_ixyz=(0.0, 0.0, 0.0), control_surface_symmetry_type=None,
                 control_surface_hinge_point=0.75, control_surface_deflection=0.0, spanwise_spacing=None):
        assert isinstance(airfoil, Airfoil) and chord > 0.0
        assert (num_spanwise_panels is None) == (spanwise_spacing is None)
        self.chord, self.offset, self.panels = chord, Lp_Wcsp_Lpp, num_spanwise_panels


class Panel:
    """As heavily loaded as another."""

    def __init__(self):
        self.forces_W = np.array([1e-4, 0.0, 2e-4])
        self.moments_W_CgP1 = np.array([3e-6, 0.0, 0.0])


class Wing:
    def __init__(self, wing_cross_sections, name="Untitled Wing", Ler_Gs_Cgs=(0.0, 0.0, 0.0),
                 angles_Gs_to_Wn_ixyz=(0.0, 0.0, 0.0), symmetric=False, mirror_only=False, symmetryNormal_G=None,
                 symmetryPoint_G_Cg=None, explode_into_strips=False, num_chordwise_panels=8,
                 chordwise_spacing="cosine"):
        assert symmetric and symmetryNormal_G and symmetryPoint_G_Cg and Ler_Gs_Cgs[1] > 0.0
        assert all(-90.0 <= angle <= 90.0 for angle in angles_Gs_to_Wn_ixyz)
        assert wing_cross_sections[0].offset == (0.0, 0.0, 0.0) and wing_cross_sections[-1].panels is None
        self.wing_cross_sections, self.angles = tuple(wing_cross_sections), angles_Gs_to_Wn_ixyz
        self.panels = np.array([[Panel(), Panel()], [Panel(), Panel()]], dtype=object)


class Airplane:
    def __init__(self, wings, name="Untitled Airplane", Cg_GP1_CgP1=(0.0, 0.0, 0.0), weight=0.0, s_ref=None, c_ref=None,
                 b_ref=None):
        self.wings = (wings[0], wings[0])  # and its mirror image
        self.forces_W = np.array([2 * 4 * 1e-4, 0.0, 0.0])


class WingCrossSectionMovement:
    def __init__(self, base_wing_cross_section):
        assert isinstance(base_wing_cross_section, WingCrossSection)


class WingMovement:
    made = []

    def __init__(self, base_wing, wing_cross_section_movements, ampLer_Gs_Cgs=(0.0, 0.0, 0.0),
                 periodLer_Gs_Cgs=(0.0, 0.0, 0.0), spacingLer_Gs_Cgs=("sine", "sine", "sine"),
                 phaseLer_Gs_Cgs=(0.0, 0.0, 0.0), ampAngles_Gs_to_Wn_ixyz=(0.0, 0.0, 0.0),
                 periodAngles_Gs_to_Wn_ixyz=(0.0, 0.0, 0.0), spacingAngles_Gs_to_Wn_ixyz=("sine", "sine", "sine"),
                 phaseAngles_Gs_to_Wn_ixyz=(0.0, 0.0, 0.0), rotationPointOffset_Gs_Ler=(0.0, 0.0, 0.0)):
        assert len(wing_cross_section_movements) == len(base_wing.wing_cross_sections)
        self.base, self.amplitude = base_wing.angles, ampAngles_Gs_to_Wn_ixyz
        self.period, self.spacing = periodAngles_Gs_to_Wn_ixyz, spacingAngles_Gs_to_Wn_ixyz
        WingMovement.made.append(self)


class AirplaneMovement:
    def __init__(self, base_airplane, wing_movements):
        assert len(wing_movements) == len(base_airplane.wings)
        self.airplane = base_airplane


class OperatingPoint:
    def __init__(self, rho=1.225, vCg__E=10.0, alpha=5.0, beta=0.0, nu=15.06e-6):
        assert rho > 0.0 and vCg__E > 0.0 and nu > 0.0 and alpha == 0.0


class OperatingPointMovement:
    def __init__(self, base_operating_point):
        assert isinstance(base_operating_point, OperatingPoint)


class Movement:
    def __init__(self, airplane_movements, operating_point_movement, delta_time=None, num_cycles=None, num_chords=None,
                 num_steps=None):
        assert isinstance(operating_point_movement, OperatingPointMovement)
        self.airplane, self.num_steps = airplane_movements[0].airplane, round(num_cycles / (22.0 * delta_time))


class UnsteadyProblem:
    def __init__(self, movement, only_final_results=False):
        one = types.SimpleNamespace(airplanes=(movement.airplane,))
        self.steady_problems = (one,) * movement.num_steps


class UnsteadyRingVortexLatticeMethodSolver:
    def __init__(self, unsteady_problem):
        self.problem = unsteady_problem

    def run(self, prescribed_wake=True, calculate_streamlines=True, show_progress=True):
        pass


def package():
    """What the script calls of PteraSoftware, in its modules."""
    ps = types.ModuleType("pterasoftware")
    for name, members in {
            "geometry.airfoil": [Airfoil], "geometry.wing_cross_section": [WingCrossSection], "geometry.wing": [Wing],
            "geometry.airplane": [Airplane], "movements.wing_cross_section_movement": [WingCrossSectionMovement],
            "movements.wing_movement": [WingMovement], "movements.airplane_movement": [AirplaneMovement],
            "movements.operating_point_movement": [OperatingPointMovement], "movements.movement": [Movement],
            "operating_point": [OperatingPoint], "problems": [UnsteadyProblem],
            "unsteady_ring_vortex_lattice_method": [UnsteadyRingVortexLatticeMethodSolver]}.items():
        here = ps
        for part in name.split("."):
            if not hasattr(here, part):
                setattr(here, part, types.SimpleNamespace())
            here = getattr(here, part)
        for member in members:
            setattr(here, member.__name__, member)
    return ps


@unittest.skipUnless(np, "python3-numpy is not installed")
class Cfd(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="wingbeat-cfd-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        WingMovement.made.clear()

    def run_program(self, *arguments):
        done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=280)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_script_for_pterasoftware(self):
        script, motion, loads = (self.folder / name for name in ("wings.py", "wings.csv", "loads.csv"))
        written = json.loads(self.run_program("export-kinematics", *VEHICLE, "--format", "pterasoftware", "-o", script,
                                              "--json"))
        self.run_program("export-kinematics", *VEHICLE, "-o", motion)
        names = {"__name__": "script"}
        sys.modules["pterasoftware"] = package()
        self.addCleanup(lambda: sys.modules.pop("pterasoftware"))
        exec(compile(script.read_text(), str(script), "exec"), names)
        problem = names["problem_of_flapping"]()
        self.assertEqual(len(WingMovement.made), 2)

        with open(motion, newline="") as file:
            rows = list(csv.DictReader(file))
        time = np.array([float(row["time_s"]) for row in rows])
        made = WingMovement.made[0]
        for k, (column, sign, series) in enumerate([("stroke_angle_rad", 1.0, "stroke_series"),
                                                    ("pitch_angle_rad", -1.0, "pitch_series")]):
            spacing = made.spacing[k]
            cycle = spacing(np.linspace(0.0, 2.0 * np.pi, 2001))
            self.assertAlmostEqual(float(cycle[0]), 0.0, places=12)
            self.assertAlmostEqual(float(cycle[-1]), 0.0, places=9)
            self.assertAlmostEqual(float(np.ptp(cycle)) / 2.0, 1.0, places=9)
            self.assertIsInstance(float(spacing(0.3)), float)
            angle = made.base[k] + made.amplitude[k] * spacing(2.0 * np.pi * time / made.period[k])
            expected = sign * np.degrees([float(row[column]) for row in rows])
            error = float(np.max(np.abs(angle - expected)))
            self.assertLess(error, 1.01 * np.degrees(written[series]["error_max_rad"]) + 1e-6, column)

        names["write_loads"](problem, loads)
        read = json.loads(self.run_program("compare-loads", *VEHICLE, loads, "--json"))
        lift, moment = read["loads"]
        self.assertAlmostEqual(lift["mean_simulated"], 8e-4, places=12)
        hinge = names["HINGE_OFFSET"]
        self.assertAlmostEqual(moment["mean_simulated"], 2 * 4 * (3e-6 - hinge * 2e-4), places=12)
        area = sum(0.5 * (b[0] - a[0]) * (a[1] + b[1]) for a, b in zip(names["SECTIONS"], names["SECTIONS"][1:]))
        self.assertAlmostEqual(area / (0.25 * np.pi * 63e-3 * 25e-3), 1.0, delta=0.01)


if __name__ == "__main__":
    unittest.main()
