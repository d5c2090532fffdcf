#!/usr/bin/env python3
"""Makes manual pages and shell completions of the programs from their own --help.

    manual.py FOLDER PROGRAM...

writes FOLDER/man/NAME.1, FOLDER/bash/NAME and FOLDER/zsh/_NAME for each program.
"""
from __future__ import annotations

import dataclasses
import pathlib
import re
import subprocess
import sys

COLUMN = 30  # CLI11 starts an option's text in this column; a longer name has a line of its own
CHECKS = {"POSITIVE": "above 0", "NONNEGATIVE": "not below 0"}

# What --help does not say.
FILES = {"palpate-node": [("/etc/palpate/node.textproto", "Options of the system's service, palpate-node.service. "
                           "palpate-node --print-config prints all of them.")],
         "palpate-gateway": [("/etc/palpate/gateway-NAME.conf", "Options of palpate-gateway@NAME.service."),
                             ("/usr/share/palpate/plant/", "Examples of these, and of nats-server's own.")]}
SEE_ALSO = ["palpate", "palpate-gateway", "palpate-node", "palpate-sim"]


@dataclasses.dataclass
class Entry:
    """A line of --help: an option, a positional or a subcommand."""
    names: list[str]
    value: str = ""  # as in FILE; of options that take one
    takes_value: bool = False
    choices: list[str] = dataclasses.field(default_factory=list)
    remark: str = ""  # range, default, what it needs
    text: str = ""


@dataclasses.dataclass
class Command:
    name: str
    description: list[str]
    usage: str
    sections: dict[str, list[Entry]]
    commands: list[Command]

    def options(self) -> list[Entry]:
        return [entry for entries in self.sections.values() for entry in entries if entry.names[0].startswith("-")]


def option_of(head: str) -> Entry:
    """--sigma,--sigma-m NUMBER:FLOAT in [0 - 1000]=0 ... Needs: --class"""
    head, _, excludes = head.partition(" Excludes: ")
    head, _, needs = head.partition(" Needs: ")
    names, rest = re.fullmatch(r"([\w,!-]+)(?:\{\w+\})?(.*)", head).groups()
    takes_value = bool(rest)
    rest = rest.removesuffix(" ...")
    left, _, default = rest.partition("=")
    value, _, check = left.strip().removesuffix(",...").partition(":")
    choices, remarks = [], []
    if check.startswith("{"):
        choices = check[1:-1].split(",")
        remarks.append(" or ".join(choices))
    elif " in [" in check:
        remarks.append(check[check.index("["):].replace(" - ", " to "))
    elif check in CHECKS:
        remarks.append(CHECKS[check])
    elif check:
        value += ":" + check
    if default.strip('"'):
        remarks.append("default " + default.strip('"'))
    if needs:
        remarks.append("needs " + needs.replace(" ", ", "))
    if excludes:
        remarks.append("not with " + excludes.replace(" ", ", "))
    return Entry(names.split(","), value or ("VALUE" if takes_value else ""), takes_value, choices, "; ".join(remarks))


def command_of(call: list[str]) -> Command:
    lines = subprocess.run([*call, "--help"], check=True, capture_output=True, text=True).stdout.splitlines()
    usage_at = next(i for i, line in enumerate(lines) if line.startswith("Usage: "))
    command = Command(call[-1], lines[:usage_at], lines[usage_at].removeprefix("Usage: "), {}, [])
    entries: list[Entry] = []
    title = ""
    for line, following in zip(lines[usage_at + 1:], lines[usage_at + 2:] + [""]):
        if re.fullmatch(r"\S.*:", line):
            title = line[:-1]
            entries = command.sections.setdefault(title, [])
        elif line.startswith(COLUMN * " "):
            entries[-1].text = (entries[-1].text + " " + line.strip()).strip()
        elif line.startswith("  "):
            # An option's text is always one line. If more text follows, this line is a name alone.
            whole = line.startswith("  -") and following.startswith(COLUMN * " ")
            head, text = (line.strip(), "") if whole else (line[:COLUMN].strip(), line[COLUMN:].strip())
            entry = option_of(head) if head.startswith("-") else Entry([head.split()[0]])
            if " REQUIRED" not in head and not head.startswith("-") and title == "Positionals":
                entry.remark = "optional"
            entry.text = text
            entries.append(entry)
        else:
            assert not line, f"not understood: {line!r}"
    return command


def program_of(path: pathlib.Path) -> Command:
    program = command_of([str(path)])
    program.name = path.name
    for entry in program.sections.get("Subcommands", []):
        program.commands.append(command_of([str(path), entry.names[0]]))
    return program


# The manual page.

def roff(text: str) -> str:
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("`", "\\(ga")
    return "\\&" + text if text.startswith((".", "'")) else text


def term(entry: Entry) -> str:
    names = ", ".join(f"\\fB{roff(name)}\\fR" for name in entry.names)
    if not entry.names[0].startswith("-"):
        names = f"\\fI{roff(entry.names[0])}\\fR"
    return names + (f" \\fI{roff(entry.value)}\\fR" if entry.value else "")


def paragraph(entry: Entry) -> list[str]:
    text = entry.text + (f" ({entry.remark})" if entry.remark else "")
    return [".TP", term(entry), roff(text) if text.strip() else "\\&"]


def prose(lines: list[str]) -> list[str]:
    return [roff(line) for line in lines if line]


def manual(program: Command, version: str) -> str:
    exits = [line.removeprefix("Exit codes: ") for line in program.description if line.startswith("Exit codes: ")]
    said = [line for line in program.description if not line.startswith("Exit codes: ")]
    short = re.split(r"[:.]", said[0])[0]
    page = [f'.TH {program.name.upper()} 1 "" "palpate {version}" "User Commands"',
            ".SH NAME", f"{roff(program.name)} \\- {roff(short[0].lower() + short[1:])}",
            ".SH SYNOPSIS", f"\\fB{roff(program.name)}\\fR {roff(program.usage.partition(' ')[2])}",
            ".SH DESCRIPTION", *prose(said)]
    for title, entries in program.sections.items():
        if title == "Subcommands":
            page.append(".SH COMMANDS")
            for command in program.commands:
                page += [f".SS {roff(program.name)} {roff(command.usage.partition(' ')[2])}", *prose(command.description)]
                page += [line for entries in command.sections.values() for entry in entries for line in paragraph(entry)]
        else:
            page.append(f".SH {'ARGUMENTS' if title == 'Positionals' else title.upper()}")
            page += [line for entry in entries for line in paragraph(entry)]
    if exits:
        page += [".SH EXIT STATUS", *prose(exits)]
    if program.name in FILES:
        page.append(".SH FILES")
        page += [line for path, text in FILES[program.name] for line in (".TP", f"\\fI{roff(path)}\\fR", roff(text))]
    page += [".SH SEE ALSO",
             ", ".join(f"\\fB{roff(name)}\\fR(1)" for name in SEE_ALSO if name != program.name)]
    return "\n".join(page) + "\n"


# Completions.

def function_name(program: Command) -> str:
    return "_" + program.name.replace("-", "_")


def bash(program: Command) -> str:
    everywhere = [("", program)] + [(command.name, command) for command in program.commands]
    options = "\n".join(f"    '{name}') options='{' '.join(n for o in c.options() for n in o.names)}' ;;"
                        for name, c in everywhere)
    values = "\n".join(f"    '{name} {option_name}') choices='{' '.join(o.choices)}' ;;"
                       for name, c in everywhere for o in c.options() if o.choices for option_name in o.names)
    taking = "\n".join(f"    {' | '.join(repr(f'{name} {n}') for o in c.options() if o.takes_value for n in o.names)}) return ;;"
                       for name, c in everywhere if any(o.takes_value for o in c.options()))
    commands = " ".join(command.name for command in program.commands)
    return f"""# bash completion of {program.name}, made from its --help. Without an answer of ours bash completes file names.
{function_name(program)}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} commands='{commands}'
  local command='' options='' choices='' word
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case " $commands " in *" $word "*) command=$word; break ;; esac
  done
  COMPREPLY=()
  case "$command $before" in
{values or "    '') ;;"}
  esac
  if [ -n "$choices" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$current")
    return
  fi
  case "$command $before" in
{taking or "    '') ;;"}
  esac
  case "$command" in
{options}
  esac
  if [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  elif [ -z "$command" ] && [ -n "$commands" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
  fi
}}
complete -o default -F {function_name(program)} {program.name}
"""


def zsh_quoted(text: str) -> str:
    return "'" + text.replace("'", "'\\''") + "'"


def zsh_option(option: Entry) -> list[str]:
    text = re.sub(r"([\[\]\\:])", r"\\\1", option.text.split(";")[0])
    value = ""
    if option.takes_value:
        action = f"({' '.join(option.choices)})" if option.choices else "_files" if option.value in ("FILE", "VALUE") else " "
        value = f":{option.value.replace(':', ' ')}:{action}"
    return [zsh_quoted(f"*{name}[{text}]{value}") for name in option.names]


def zsh_arguments(command: Command, more: list[str]) -> str:
    specs = [spec for option in command.options() for spec in zsh_option(option)] + more
    return " \\\n        ".join(["_arguments -s -S"] + specs)


def zsh(program: Command) -> str:
    if not program.commands:
        return f"#compdef {program.name}\n# Made from its --help.\n{zsh_arguments(program, [zsh_quoted('*:file:_files')])}\n"
    described = " ".join(zsh_quoted(f"{c.name}:{c.description[0].rstrip('.')}") for c in program.commands)
    cases = "\n".join(f"      {c.name})\n        {zsh_arguments(c, [zsh_quoted('*:file:_files')])} ;;"
                      for c in program.commands)
    first = zsh_arguments(program, ["'1:command:->command'", "'*::argument:->argument'"])
    return f"""#compdef {program.name}
# Made from its --help.
local context state state_descr line
typeset -A opt_args
{first.replace("_arguments", "_arguments -C", 1)}
case $state in
  command)
    local -a commands=({described})
    _describe command commands ;;
  argument)
    case $line[1] in
{cases}
    esac ;;
esac
"""


def main() -> None:
    out = pathlib.Path(sys.argv[1])
    for path in map(pathlib.Path, sys.argv[2:]):
        program = program_of(path)
        version = subprocess.run([path, "--version"], check=True, capture_output=True, text=True).stdout.strip()
        for name, text in ((f"man/{program.name}.1", manual(program, version)), (f"bash/{program.name}", bash(program)),
                           (f"zsh/_{program.name}", zsh(program))):
            (out / name).parent.mkdir(parents=True, exist_ok=True)
            (out / name).write_text(text)


if __name__ == "__main__":
    main()
