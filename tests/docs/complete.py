"""Whether every command of the pages is run by a test or stands in not_run.toml, and whether what they name is there.

usage: complete.py TREACLE SOURCE PAGE...    PAGE: those that run_commands.py runs
"""

import pathlib
import re
import subprocess
import sys
import tomllib

import pages
from run_commands import here

of_python = ("movie", "report")  # commands whose help needs a Python with packages
kinds = {"", "first steps only"}  # of the comments before blocks of sh


def blocks(page, listed):
    """What is wrong with the blocks of a page, of whose commands only some need not be run."""
    found = [f"{line}: a block that is indented is not seen: begin it in the first column" for line in page.indented]
    for block in page.blocks:
        if block.language == "sh" and block.kind not in kinds:
            found.append(f"{block.line}: unknown comment before the block: '{block.kind}'")
        for line, command in block.commands if block.language == "sh" else ():
            if command not in listed:
                found.append(
                    f"{line}: neither run, as the page is not in tests/docs/CMakeLists.txt, nor in not_run.toml: {command}"
                )
        if block.language != "sh" and block.kind not in ("synopsis", "file"):
            lines = [line for line, command in block.commands if pages.is_command(command)]
            found += [f"{line}: a command in a block of '{block.language}': expected 'sh'" for line in lines]
    return found


def not_run(listed, everything):
    """Entries of not_run.toml that are on no page, or there twice."""
    there = {command for page in everything for block in page.blocks for _, command in block.commands}
    there |= {command for page in everything for _, command in page.inline}
    return [f"not_run.toml: on no page: {command}" for command in listed if command not in there] + [
        f"not_run.toml: there twice: {command}" for command in set(listed) if listed.count(command) > 1
    ]


class Help:
    """The options of the program's commands."""

    def __init__(self, program):
        self.program, self.known = program, {}

    def of(self, command):
        """(names, argument) of each option; none for an unknown command."""
        if command not in self.known:
            done = subprocess.run([self.program, command, "--help"], capture_output=True, text=True)
            lines = re.finditer(r"^  (-\S+)(?: (\S+))?", done.stdout if done.returncode == 0 else "", re.MULTILINE)
            self.known[command] = [(set(line[1].split(",")), line[2] or "") for line in lines]
        return self.known[command]


def names(page, program_help):
    """Options that sentences name and the program does not have; files that do not exist."""
    for line, (_, command, option) in page.names:
        if not any(option in names for names, _ in program_help.of(command)):
            yield f"{line}: treacle {command} has no option {option}"


def synopsis(text, program_help):
    """Differences between the lines `treacle COMMAND [OPTION ARGUMENT]...` and the help of each command."""
    for line in re.sub(r"\n +", " ", text).splitlines():
        command, said = line.split()[1], re.findall(r"\[(--?[\w-]+)(?: (\"[^\"]*\"|[^\]]+))?\]", line)
        options = program_help.of(command)
        if not said or command in of_python:
            continue
        for option, argument in said:
            same = [known for names, known in options if option in names]
            if not same or ("|" in same[0] and same[0] != argument):
                yield f"synopsis: treacle {command} {option} {argument}; the program: {same or 'no such option'}"
        for words, _ in options:
            if not words & ({option for option, _ in said} | {"-h"}):
                yield f"synopsis: treacle {command}: {', '.join(sorted(words))} is missing"


def main(program, source, *tested):
    source = pathlib.Path(source).resolve()
    everything, program_help = pages.all_of(source), Help(program)
    entries = tomllib.loads((here / "not_run.toml").read_text())["not_run"]
    listed = [command for entry in entries for command in entry["commands"]]
    failures = not_run(listed, everything)
    failures += [f"{name}: no such page with commands" for name in tested if name not in {p.name for p in everything}]
    for page in everything:
        run = {command for block in page.blocks for _, command in block.commands} if page.name in tested else set()
        wrong = [*blocks(page, run.union(listed)), *names(page, program_help)]
        wrong += [f"{line}: no such file: {file}" for line, file in page.files if not (source / file).exists()]
        for block in page.blocks:
            if block.kind == "synopsis":
                wrong += synopsis(block.text, program_help)
        failures += [f"{page.name}:{what}" for what in wrong]
    count = sum(len(block.commands) for page in everything for block in page.blocks if block.language == "sh")
    print(
        *failures, f"{count} commands in blocks, {sum(len(page.inline) for page in everything)} in sentences", sep="\n"
    )
    return not failures and count > 100


if __name__ == "__main__":
    sys.exit(not main(*sys.argv[1:]))
