"""Manual pages and completions say what --help says, all of it and nothing else."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from programs import BUILD, NODE, SIM, TOOL
from strangers import call

MANUAL = BUILD / "manual"
GATEWAY = BUILD / "node/gateway/palpate-gateway"  # where there was libnats
PROGRAMS = (TOOL, NODE, SIM) + ((GATEWAY,) if GATEWAY.exists() else ())


def calls():
    """Each program and subcommand: (program, subcommand or "", its --help)."""
    for program in PROGRAMS:
        text = call(program, "--help")
        yield program, "", text
        if "\nSubcommands:\n" in text:
            for name in re.findall(r"^  (\w+)", text.partition("\nSubcommands:\n")[2], re.MULTILINE):
                yield program, name, call(program, name, "--help")


def options_in(text):
    """Names at the beginning of a line of --help."""
    found = set()
    for names in re.findall(r"^  (-[\w,-]+)", text, re.MULTILINE):
        found.update(names.split(","))
    return found


def plain(page):
    """A page as a terminal shows it, in one line."""
    text = subprocess.run(["man", "--local-file", str(page)], capture_output=True, text=True, check=True,
                          env=os.environ | {"MANWIDTH": "5000", "LC_ALL": "C.UTF-8", "MAN_KEEP_FORMATTING": ""}).stdout
    return re.sub(r"\s+", " ", re.sub(r".\x08", "", text))


class Manual(unittest.TestCase):
    @unittest.skipUnless(shutil.which("man"), "man is not installed")
    def test_every_line_of_help_stands_in_the_page(self):
        for program, command, text in calls():
            page = plain(MANUAL / f"man/{program.name}.1")
            if command:
                page = page.partition(f" {program.name} {command} [OPTIONS]")[2].partition("[OPTIONS]")[0]
            for option in options_in(text):
                self.assertRegex(page, rf"[ ,]{re.escape(option)}[ ,]", f"{program.name} {command}")
            lines = text.splitlines()
            for line, following in zip(lines, lines[1:] + [""]):
                # A long name has a line to itself, and its text the next one.
                name_alone = line.startswith("  -") and following.startswith(30 * " ")
                if line.startswith("  ") and not name_alone:
                    self.assertIn(re.sub(r"\s", "", line[30:]), page.replace(" ", ""), f"{program.name} {command}")

    @unittest.skipUnless(shutil.which("man"), "man is not installed")
    def test_pages_are_clean(self):
        for program in PROGRAMS:
            done = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-Tutf8", "-Z", "--local-file",
                                   str(MANUAL / f"man/{program.name}.1")], capture_output=True, text=True,
                                  env=os.environ | {"LC_ALL": "C.UTF-8", "MANROFFSEQ": ""})
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            name, _, about = re.search(r"^\.SH NAME\n(.*?) (\\-) (.*)$", (MANUAL / f"man/{program.name}.1").read_text(),
                                       re.MULTILINE).groups()
            self.assertEqual(name.replace("\\", ""), program.name)
            self.assertGreater(len(about), 20)

    def complete(self, program, *words):
        script = f"""
source {MANUAL}/bash/{program.name}
COMP_WORDS=({program.name} {' '.join(repr(word) for word in words)})
COMP_CWORD={len(words)}
_{program.name.replace('-', '_')}
printf '%s\\n' "${{COMPREPLY[@]}}"
"""
        return set(call("bash", "-c", script).split())

    def test_bash_completes_what_help_names(self):
        for program, command, text in calls():
            before = [command] if command else []
            self.assertEqual(self.complete(program, *before, "-"), options_in(text), f"{program.name} {command}")
            for option, values in re.findall(r"^  (--[\w-]+) [A-Z]+:\{([\w,]+)\}", text, re.MULTILINE):
                self.assertEqual(self.complete(program, *before, option, ""), set(values.split(",")))
        self.assertEqual(self.complete(TOOL, ""), {command for program, command, _ in calls() if command})
        self.assertEqual(self.complete(TOOL, "fit", "--plo"), {"--plot", "--plot-invariants"})
        # A file's name is bash's own matter.
        self.assertEqual(self.complete(TOOL, "fit", "--plot", "--"), set())

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh_completes_what_help_names(self):
        # What _arguments would be told: each option with its text, in the order of the file.
        for program, command, text in calls():
            script = f"""
_arguments() {{ print -rl -- "$@"; state={'argument' if command else 'none'}; line=({command}) }}
_describe() {{ }}
source {MANUAL}/zsh/_{program.name}
"""
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "complete"
                path.write_text("run() {\n" + script + "}\nrun\n")
                said = call("zsh", "--no-rcs", path)
            if command:
                said = said.partition("*::argument:->argument\n")[2]
            found = set(re.findall(r"^\*(-[\w-]+)\[", said, re.MULTILINE))
            self.assertEqual(found, options_in(text), f"{program.name} {command}")

    def test_the_configuration_names_every_option_and_sets_none(self):
        text = (MANUAL / "node.textproto").read_text()
        self.assertFalse([line for line in text.splitlines() if not line.startswith("#")])
        for line in call(NODE, "--print-config").splitlines():
            self.assertIn(f"# {line}\n", text)
        self.assertEqual(call(NODE, "--config", MANUAL / "node.textproto", "--print-config"), call(NODE, "--print-config"))


if __name__ == "__main__":
    unittest.main()
