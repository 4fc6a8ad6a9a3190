"""Manual pages and completions hold every command and option that --help shows, and complete as a shell asks them.

What is expected comes from --help alone, so that nothing here follows the generator.
"""

import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import tempfile
import time
import unittest

PROGRAM = pathlib.Path(os.environ["WINGBEAT_PROGRAM"])
MANUAL = pathlib.Path(os.environ["WINGBEAT_MANUAL"])


def output_of(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, timeout=250, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def help_of(command):
    """The options that --help lists: their names, and whether a value follows."""
    text = output_of(PROGRAM, *command, "--help")
    lines = re.findall(r"^  (-\S+)(.*)$", text.split("\nOptions:\n")[1].split("\n\n")[0], re.M)
    return {tuple(names.split(",")): bool(re.match(r" \S", rest)) for names, rest in lines}


COMMANDS = re.findall(r"^  (\S+)", output_of(PROGRAM, "--help").split("Subcommands:\n")[1].split("\n\n")[0], re.M)
OPTIONS = {command: help_of([command]) for command in COMMANDS}
NAMES = {command: sorted(name for names in options for name in names) for command, options in OPTIONS.items()}
DESIGNS = sorted(file.stem for file in (PROGRAM.parent / "share/wingbeat/designs").glob("*.toml"))
KEYS = re.findall(r'"key": "(\S+)"', output_of(PROGRAM, "keys", "--json"))
METRICS = re.findall(r'"key": "(\S+)"', output_of(PROGRAM, "metrics", "--json"))


class Reference(unittest.TestCase):
    def test_help_was_understood(self):
        self.assertIn("identify-motor", COMMANDS)
        self.assertGreaterEqual(len(COMMANDS), 12)
        self.assertIn(("-o", "--output"), OPTIONS["sweep"])
        self.assertTrue(OPTIONS["run"]["--set",])
        self.assertFalse(OPTIONS["run"]["--json",])
        self.assertIn("friction2022", DESIGNS)
        self.assertGreater(len(KEYS), 100)
        self.assertIn("lift_mean_n", METRICS)


class ManPages(unittest.TestCase):
    def page(self, name):
        environment = {**os.environ, "MANWIDTH": "400", "LC_ALL": "C.UTF-8"}
        file = MANUAL / "man" / f"{name}.1"
        done = subprocess.run(["man", "--warnings", "--nh", "--nj", "-l", file], capture_output=True, text=True,
                              env=environment, timeout=250)
        self.assertEqual((done.returncode, done.stderr), (0, ""), name)
        return done.stdout

    def test_the_program_names_every_command(self):
        text = self.page("wingbeat")
        for command in COMMANDS:
            self.assertIn(f"       wingbeat-{command}(1)\n", text)
        self.assertEqual(sorted(path.name for path in (MANUAL / "man").iterdir()),
                         sorted(["wingbeat.1", *(f"wingbeat-{command}.1" for command in COMMANDS)]))

    def test_pages_list_the_options_of_help(self):
        for command in COMMANDS:
            section = re.search(r"^OPTIONS\n(.*?)^\S", self.page(f"wingbeat-{command}"), re.M | re.S)[1]
            listed = {}
            for line in re.findall(r"^ {7}(-\S.*)$", section, re.M):
                named = re.split(r" {2,}|(?<=--json) ", line)[0]
                words = [part.split(" ") for part in named.split(", ")]
                listed[tuple(word[0] for word in words)] = len(words[0]) > 1
            self.assertEqual(listed, OPTIONS[command], command)

    def test_pages_show_the_examples_and_statuses_of_help(self):
        for command in COMMANDS:
            shown = output_of(PROGRAM, command, "--help")
            text = self.page(f"wingbeat-{command}")
            for line in shown.split("Example:\n")[1].split("\n\n")[0].rstrip("\n").split("\n"):
                self.assertIn(line.strip() + "\n", text, command)
            statuses = shown.partition("Exit status: ")[2]
            for status in re.findall(r"(?:^|, )(\d) ", statuses):
                self.assertRegex(text, rf"(?m)^       {status}      \S", command)

    def test_mandoc_and_groff_find_nothing_wrong(self):
        pages = sorted((MANUAL / "man").iterdir())
        lint = subprocess.run(["mandoc", "-Tlint", "-Wstyle", *pages], capture_output=True, text=True)
        self.assertEqual((lint.returncode, lint.stdout + lint.stderr), (0, ""))
        for page in pages:
            groff = subprocess.run(["groff", "-man", "-ww", "-Tutf8", page], capture_output=True, text=True)
            self.assertEqual((groff.returncode, groff.stderr), (0, ""), page.name)


class Terminal:
    """A shell at a terminal: what is typed, and what then stands on its screen."""

    def __init__(self, command, folder):
        self.child, self.descriptor = pty.fork()
        if self.child == 0:
            os.chdir(folder)
            os.environ.update(TERM="dumb", PS1="", HISTFILE="/dev/null")
            os.execvp(command[0], command)

    def type(self, text):
        os.write(self.descriptor, text.encode())

    def read_until(self, end, seconds=20):
        text, limit = "", time.monotonic() + seconds
        while end not in text:
            if not select.select([self.descriptor], [], [], max(0, limit - time.monotonic()))[0]:
                raise AssertionError(f"{end!r} did not come; on the screen: {text!r}")
            text += os.read(self.descriptor, 4096).decode()
        return text

    def drain(self, seconds):
        """Takes what is shown, without which the shell would wait."""
        if select.select([self.descriptor], [], [], seconds)[0]:
            os.read(self.descriptor, 65536)

    def close(self):
        os.close(self.descriptor)
        os.waitpid(self.child, 0)


class Completions:
    """Completion in each shell, which gives complete(line): the words offered at the line's end."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ["flapper.toml", "sweep.nc", "cycle.svg", "notes.txt", "two words.toml"]:
            (self.folder / name).touch()
        (self.folder / "results").mkdir()

    def test_commands(self):
        self.assertEqual(self.complete("wingbeat "), sorted(COMMANDS))
        self.assertEqual(self.complete("wingbeat re"), ["read-bench", "reproduce"])
        self.assertEqual([name for name in self.complete("wingbeat --") if name.startswith("--")],
                         ["--help", "--version"])

    def test_options_are_those_of_help(self):
        for command in COMMANDS:
            long_names = [name for name in NAMES[command] if name.startswith("--")]
            self.assertEqual(self.complete(f"wingbeat {command} --"), long_names, command)
            self.assertTrue(set(self.complete(f"wingbeat {command} -")) >= {name for name in NAMES[command]}, command)

    def test_choices(self):
        self.assertEqual(self.complete("wingbeat run friction2022 --condition "), ["air", "vacuum", "wingless"])
        self.assertEqual(self.complete("wingbeat run --method t"), ["transient"])
        self.assertEqual(self.complete("wingbeat sweep --isa "), ["avx2", "avx512", "sse2"])
        self.assertEqual(self.complete("wingbeat new --transmission "),
                         ["direct", "four-bar", "slider-crank", "tabulated"])
        self.assertEqual(self.complete("wingbeat reproduce "), ["friction2022"])
        self.assertEqual(self.complete("wingbeat run --voltage "), [])

    def test_files_by_extension(self):
        files = ["flapper.toml", "results/", "two words.toml"]
        self.assertEqual(self.complete("wingbeat run "), sorted(files + DESIGNS))
        self.assertEqual(self.complete("wingbeat run fla"), ["flapper.toml"])
        self.assertEqual(self.complete("wingbeat run x --plot "), ["cycle.svg", "results/"])
        self.assertEqual(self.complete("wingbeat sweep x -o "), ["results/", "sweep.nc"])
        self.assertEqual(self.complete("wingbeat reproduce friction2022 -o "), ["results/"])

    def test_keys_and_metrics(self):
        self.assertEqual(self.complete("wingbeat run x --set "), sorted(key + "=" for key in KEYS))
        self.assertEqual(self.complete("wingbeat run x --set motor.armature_i"), ["motor.armature_inductance="])
        self.assertEqual(self.complete("wingbeat run x --set motor.armature_inductance="), [])
        self.assertEqual(self.complete("wingbeat tolerance x --plot-metric "), sorted(METRICS))
        self.assertEqual(self.complete("wingbeat metrics "), sorted(METRICS))
        self.assertEqual(self.complete("wingbeat keys motor.armature_i"), ["motor.armature_inductance"])

    def test_after_a_key_and_its_value(self):
        self.assertEqual(self.complete("wingbeat run x --set motor.armature_inductance=1e-4 --cond"), ["--condition"])


@unittest.skipUnless(shutil.which("bash"), "there is no bash")
class Bash(Completions, unittest.TestCase):
    script = MANUAL / "completions/wingbeat.bash"

    def complete(self, line):
        # As Readline splits a line: "=" is a word of its own.
        words = re.findall(r"=|[^\s=]+", line) + ([""] if line.endswith((" ", "=")) else [])
        if line.endswith("="):
            words.pop()
        quoted = " ".join(f"'{word}'" for word in words)
        code = (f"source '{self.script}'; COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; _wingbeat 2>/dev/null; "
                'for reply in "${COMPREPLY[@]}"; do [[ -d $reply ]] && reply+=/; echo "$reply"; done')
        text = output_of("bash", "--norc", "-c", code, cwd=self.folder)
        return sorted(set(text.splitlines()))

    def test_values_after_an_equals_sign(self):
        self.assertEqual(self.complete("wingbeat run x --condition=v"), ["vacuum"])
        self.assertEqual(self.complete("wingbeat run x --plot=cy"), ["cycle.svg"])
        self.assertEqual(self.complete("wingbeat identify-motor x --fallback inertia="), ["solid-steel-cylinder"])

    def test_lists_with_commas(self):
        self.assertEqual(self.complete("wingbeat sweep x --plot-metric lift_mean_n,frequency"),
                         ["lift_mean_n,frequency_hz"])

    def test_at_a_terminal(self):
        terminal = Terminal(["bash", "--norc", "--noprofile", "-i"], self.folder)
        self.addCleanup(terminal.close)
        terminal.type(f"bind 'set bell-style none'; set +o history; wingbeat() {{ printf '<%s>' \"$@\"; echo :end; }}; "
                      f"source '{self.script}'; echo rea''dy\n")
        terminal.read_until("ready\r\n")
        for typed, given in [
            ("wingbeat ru\tfla\t--cond\tvac\t\n", "<run><flapper.toml><--condition><vacuum>"),
            ("wingbeat sweep two\\ w\t-o res\tx.nc\n", "<sweep><two words.toml><-o><results/x.nc>"),
            ("wingbeat run x --set motor.armature_i\t1e-4 --plot=cy\t\n",
             "<run><x><--set><motor.armature_inductance=1e-4><--plot=cycle.svg>"),
        ]:
            terminal.type(typed)
            self.assertIn(given, terminal.read_until(":end\r\n"))


@unittest.skipUnless(shutil.which("fish"), "there is no fish")
class Fish(Completions, unittest.TestCase):
    script = MANUAL / "completions/wingbeat.fish"

    def complete(self, line):
        text = output_of("fish", "--no-config", "-c", f"source '{self.script}'; complete -C '{line}'", cwd=self.folder,
                         env={**os.environ, "HOME": str(self.folder)})
        offers = {offer.split("\t")[0].replace("\\ ", " ") for offer in text.splitlines()}
        return sorted(offers - {line.split(" ")[-1]})

    def test_values_after_an_equals_sign(self):
        self.assertEqual(self.complete("wingbeat run x --condition=v"), ["--condition=vacuum"])
        self.assertEqual(self.complete("wingbeat run x --plot=cy"), ["--plot=cycle.svg"])

    def test_lists_with_commas(self):
        self.assertIn("lift_mean_n,frequency_hz", self.complete("wingbeat sweep x --plot-metric lift_mean_n,frequency"))


@unittest.skipUnless(shutil.which("zsh"), "there is no zsh")
class Zsh(Completions, unittest.TestCase):
    """At a terminal: compadd, which every completion ends in, tells what it is given."""

    setup = r"""
    PROMPT=
    unsetopt zle_bracketed_paste 2>/dev/null; unset zle_bracketed_paste
    fpath=({completions} $fpath)
    autoload -U compinit
    compinit -u -D
    zmodload zsh/zutil
    bindkey '^I' complete-word
    zstyle ':completion:*' completer _complete
    zstyle ':completion:*' insert-tab false
    setopt no_list_beep no_auto_menu
    finished() {{ comppostfuncs=(finished); : > offered.done }}
    comppostfuncs=(finished)
    compadd() {{
      if [[ ${{@[1,(i)(-|--)]}} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return; fi
      local -a hits prefix suffix
      builtin compadd -A hits "$@"
      local kept=("$@")
      zparseopts -E -D p:=prefix S:=suffix
      local hit folder
      for hit in $hits; do
        folder=; [[ -n ${{kept[(r)-*f*]}} && -d $prefix[2]$hit ]] && folder=/
        print -r -- "$IPREFIX$prefix[2]$hit$folder${{suffix[2]#/}}" >> offered
      done
      builtin compadd "${{kept[@]}}"
    }}
    print rea''dy
    """

    def setUp(self):
        super().setUp()
        self.home = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.home)
        (self.home / "setup.zsh").write_text(self.setup.format(completions=MANUAL / "completions"))
        self.terminal = Terminal(["zsh", "-f", "-i"], self.folder)
        self.addCleanup(self.terminal.close)
        self.terminal.type(f"source '{self.home}/setup.zsh'\n")
        self.terminal.read_until("ready\r\n")

    def complete(self, line):
        offered, done = self.folder / "offered", self.folder / "offered.done"
        offered.unlink(missing_ok=True)
        done.unlink(missing_ok=True)
        self.terminal.type("\x15" + line + "\t")
        limit = time.monotonic() + 20
        while not done.exists():
            self.assertLess(time.monotonic(), limit, line)
            self.terminal.drain(0.005)
        text = offered.read_text() if offered.exists() else ""
        return sorted({name.replace("\\ ", " ") for name in text.splitlines() if name not in ("", "offered")})

    def test_values_after_an_equals_sign(self):
        self.assertEqual(self.complete("wingbeat run x --condition=v"), ["--condition=vacuum"])
        self.assertEqual(self.complete("wingbeat run x --plot=cy"), ["--plot=cycle.svg"])

    def test_options_that_exclude_each_other(self):
        offered = self.complete("wingbeat run x --voltage 3 --")
        self.assertNotIn("--lift", offered)
        self.assertNotIn("--voltage", offered)
        self.assertIn("--set", offered)


if __name__ == "__main__":
    unittest.main()
