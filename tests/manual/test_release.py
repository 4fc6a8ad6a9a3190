"""scripts/make-release and scripts/check-words, on small checkouts of their own."""

import pathlib
import shutil
import subprocess
import tarfile
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILES = ("CMakeLists.txt", "CHANGELOG.md", "CITATION.cff", ".zenodo.json", "scripts/make-release", "scripts/check-words")
GIT = ("git", "-c", "user.name=a test", "-c", "user.email=test@example.org", "-c", "commit.gpgsign=false")


class Checkout(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="wingbeat-release-")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in FILES:
            (self.root / name).parent.mkdir(exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        (self.root / ".gitignore").write_text("out/\n")
        self.git("init", "-q")
        self.commit()

    def git(self, *words):
        subprocess.run([*GIT, *words], cwd=self.root, check=True, capture_output=True)

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "A commit")

    def run_script(self, name, *words):
        return subprocess.run([self.root / "scripts" / name, *words], capture_output=True, text=True)

    def edit(self, name, before, after):
        file = self.root / name
        text = file.read_text()
        self.assertIn(before, text)
        file.write_text(text.replace(before, after))


class Release(Checkout):
    def test_a_clean_checkout_can_be_released(self):
        found = self.run_script("make-release", "--check")
        self.assertEqual(found.returncode, 0, found.stderr)
        self.assertRegex(found.stdout, r"wingbeat [0-9.]+ of 20\d\d-\d\d-\d\d, commit")

    def test_the_source_archive_holds_what_git_tracks(self):
        (self.root / "out").mkdir()
        found = self.run_script("make-release", "source")
        self.assertEqual(found.returncode, 0, found.stderr)
        archive = next((self.root / "out/release").glob("wingbeat-*.tar.gz"))
        prefix = archive.name.removesuffix(".tar.gz")
        with tarfile.open(archive) as tar:
            files = sorted(member.name for member in tar if member.isfile())
        self.assertEqual(files, sorted(f"{prefix}/{name}" for name in (*FILES, ".gitignore")))
        sums = (self.root / "out/release/SHA256SUMS").read_text()
        self.assertIn(archive.name, sums)
        check = subprocess.run(["sha256sum", "-c", "SHA256SUMS"], cwd=archive.parent, capture_output=True)
        self.assertEqual(check.returncode, 0)

    def test_two_archives_of_one_commit_are_the_same(self):
        sums = []
        for _ in range(2):
            self.assertEqual(self.run_script("make-release", "source").returncode, 0)
            sums.append((self.root / "out/release/SHA256SUMS").read_text())
        self.assertEqual(*sums)

    def refusal(self, expected, *words):
        found = self.run_script("make-release", *(words or ("source",)))
        self.assertEqual(found.returncode, 1)
        self.assertIn(expected, found.stderr)
        self.assertFalse((self.root / "out").exists())

    def test_changes_are_refused(self):
        (self.root / "new.txt").write_text("")
        self.refusal("the checkout has changes; commit or remove them")
        self.commit()
        self.edit("CHANGELOG.md", "# Changelog", "# Changes")
        self.refusal("the checkout has changes; commit or remove them")

    def test_versions_must_agree(self):
        self.edit("CITATION.cff", "\nversion: ", "\nversion: 9.")
        self.commit()
        self.refusal("CITATION.cff states another version than")

    def test_a_version_needs_its_date(self):
        self.edit("CHANGELOG.md", "] - 20", "] planned for 20")
        self.commit()
        self.refusal("CHANGELOG.md has no section")

    def test_unknown_words_are_refused(self):
        self.refusal("unknown word wheels; see --help", "wheels")


class Words(Checkout):
    def check(self, name, text):
        (self.root / name).write_text(text)
        self.git("add", "-A")
        return self.run_script("check-words", name)

    def test_words_that_were_given_up_are_named_with_place_and_replacement(self):
        sto, said = "sto" + "rey", "to" + "ld"
        found = self.check("page.md", f"One\nA {sto} is {said}.\n")
        self.assertEqual(found.returncode, 1)
        self.assertIn(f"page.md:2: '{sto}': use layer", found.stdout)
        self.assertIn("use reported", found.stdout)

    def test_words_of_the_field_are_not(self):
        found = self.check("page.md", "The layer reports kinks at most once; an outcome of a batch.\n")
        self.assertEqual((found.returncode, found.stdout), (0, "check-words: 1 files, 0 words to replace\n"))

    def test_names_are_checked_in_code_and_sentences_are_not(self):
        name = "a" + "t"
        found = self.check("part.cpp", f'const double {name} = 1.0;  // found {name} = 2\nprint("{name} = {{}}");\n')
        self.assertEqual(found.stdout.count("use what it holds"), 1)
        self.assertIn("part.cpp:1:", found.stdout)


if __name__ == "__main__":
    unittest.main()
