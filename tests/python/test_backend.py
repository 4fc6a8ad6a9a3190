"""The PEP 517 backend: what it shows while it compiles, and what a build that fails ends with."""

import io
import os
import pathlib
import pty
import select
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

BACKEND = ROOT / "interfaces/python/backend"
sys.path.insert(0, str(BACKEND))
import wingbeat_build  # noqa: E402

NINJA = ["[1/40] Building CXX object a.cpp.o\n", "note: of a compiler\n", *(f"[{n}/40] Building b\n" for n in range(2, 41))]


def shown(lines, times):
    terminal = io.StringIO()
    progress = wingbeat_build.Progress(terminal, pathlib.Path("/folder"))
    for line, seconds in zip(lines, times):
        progress.read(line, seconds)
    return [line.removeprefix("\r\033[K") for line in terminal.getvalue().split("\n") if line]


class ProgressOfABuild(unittest.TestCase):
    def test_tenths(self):
        rows = shown(NINJA, range(41))
        self.assertEqual(rows[0], "  wingbeat: compiling in /folder; pip install -v shows every line")
        self.assertEqual(rows[1], "  wingbeat:   2 % of 40 steps, 0:00 min")
        self.assertEqual(rows[-1], "  wingbeat: 100 % of 40 steps, 0:40 min")
        self.assertEqual(len(rows), 12)

    def test_a_long_step_is_seen_by_the_minute(self):
        rows = shown(["[1/1000] a\n", "[2/1000] b\n", "[3/1000] c\n", "[4/1000] d\n"], [0, 59, 61, 62])
        self.assertEqual(rows[2:], ["  wingbeat:   0 % of 1000 steps, 1:01 min"])

    def test_make_counts_in_hundredths(self):
        self.assertEqual(shown(["[  3%] Building CXX\n", "[ 50%] Linking\n"], [1, 70])[1:],
                         ["  wingbeat:   3 %, 0:01 min", "  wingbeat:  50 %, 1:10 min"])

    def test_without_a_terminal_nothing_is_said(self):
        progress = wingbeat_build.Progress(None, pathlib.Path("/folder"))
        progress.read("[1/2] a\n", 0.0)
        self.assertEqual(progress.share, -1.0)

    def test_nothing_to_do(self):
        self.assertEqual(shown(["ninja: no work to do.\n"], [0]), [])


class Builds(unittest.TestCase):
    """By a `cmake` that prints what a test needs; under a terminal, as pip runs it: with its output taken away."""

    def run_build(self, script, setting=""):
        with tempfile.TemporaryDirectory() as folder:
            cmake = pathlib.Path(folder) / "cmake"
            cmake.write_text(f"#!/bin/sh\ncase \"$1\" in --build) {script} ;; esac\n")
            cmake.chmod(0o755)
            act = (f"import sys; sys.path.insert(0, {str(BACKEND)!r}); import wingbeat_build as b; "
                   f"b._build({{'build-dir': {folder!r}, 'jobs': '3', {setting}}})")
            pid, terminal = pty.fork()
            if pid == 0:  # the terminal is its controlling one
                environment = os.environ | {"PATH": f"{folder}:{os.environ['PATH']}"}
                done = subprocess.run([sys.executable, "-B", "-c", act], env=environment, text=True,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                pathlib.Path(folder, "out").write_text(done.stdout)
                os._exit(done.returncode)
            seen = b""
            while select.select([terminal], [], [], 30)[0]:
                try:
                    more = os.read(terminal, 4096)
                except OSError:  # the other end is closed
                    break
                if not more:
                    break
                seen += more
            status = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
            os.close(terminal)
            return status, seen.decode(), pathlib.Path(folder, "out").read_text()

    def test_the_terminal_shows_how_far_it_is_and_the_output_every_line(self):
        status, terminal, out = self.run_build('echo "[1/2] Building $3 $6"; echo "[2/2] Linking"')
        self.assertEqual(status, 0, out)
        self.assertIn("compiling in ", terminal)
        self.assertIn("wingbeat:  50 % of 2 steps, 0:0", terminal)
        self.assertIn("wingbeat: 100 % of 2 steps", terminal)
        self.assertIn("[1/2] Building --target 3\n[2/2] Linking\n", out)
        self.assertNotIn("wingbeat:", out)

    def test_metadata_are_there_before_anything_is_compiled(self):
        with tempfile.TemporaryDirectory() as folder:
            cmake = pathlib.Path(folder) / "cmake"
            requires = 'mkdir -p "$4/python"; echo "numpy>=1.24" > "$4/python/requires.txt"'
            cmake.write_text(f"#!/bin/sh\ncase \"$1\" in -S) {requires} ;; *) exit 9 ;; esac\n")
            cmake.chmod(0o755)
            before = os.environ["PATH"]
            self.addCleanup(os.environ.__setitem__, "PATH", before)
            os.environ["PATH"] = f"{folder}:{before}"
            made = pathlib.Path(folder) / "metadata"
            made.mkdir()
            name = wingbeat_build.prepare_metadata_for_build_wheel(made, {"build-dir": f"{folder}/build"})
            text = (made / name / "METADATA").read_text()
        self.assertIn("\nName: wingbeat\n", text)
        self.assertIn("\nRequires-Dist: numpy>=1.24\n", text)

    def test_it_can_be_turned_off(self):
        status, terminal, out = self.run_build('echo "[1/2] Building"', "'progress': 'no'")
        self.assertEqual((status, terminal), (0, ""))
        self.assertIn("[1/2] Building\n", out)

    def test_a_build_that_fails_ends_with_its_output_and_an_error(self):
        status, _, out = self.run_build('echo "[1/2] Building"; echo "error: no such type"; exit 7')
        self.assertNotEqual(status, 0)
        self.assertIn("error: no such type\n", out)
        self.assertRegex(out, "CalledProcessError: Command .* returned non-zero exit status 7")


if __name__ == "__main__":
    unittest.main()
