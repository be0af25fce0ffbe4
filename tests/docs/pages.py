"""What the pages have of commands: blocks of `sh`, files that they take, and commands within sentences."""

import re
from dataclasses import dataclass, field

fence = re.compile(r"(?:^<!-- (.+?) -->\n)?^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
comment = re.compile(r"(?:^|\s)#\s.*$|^#.*$")
folders = ("scripts/", "tests/", "benchmarks/", "examples/", ".ci/", "build/")
programs = {"treacle", "python", "python3", "pip", "cmake", "ctest", "mpirun", "srun", "ssh", "rsync", "man", "gpu-run",
            "source", "nohup"}  # fmt: skip
alone = {"keys", "schema", "man", "info"}  # commands of treacle that are whole without an argument


@dataclass
class Block:
    """A fenced block. mark: kind and text of the comment before it, `<!-- KIND: TEXT -->`."""

    line: int
    language: str
    text: str
    kind: str
    mark: str

    @property
    def commands(self):
        """(line, command) of each line, those that are continued together, without comments."""
        found, begun = [], ""
        for number, text in enumerate(self.text.splitlines(), self.line):
            begun += comment.sub("", text).strip()
            if begun.endswith("\\"):
                begun = begun[:-1]
            elif begun:
                found.append((number, plain(begun)))
                begun = ""
        return found


@dataclass
class Page:
    """A page. names, files: options of treacle, as words, and paths that its sentences name, each with its line."""

    name: str
    blocks: list
    inline: list = field(default_factory=list)  # (line, command)
    names: list = field(default_factory=list)
    files: list = field(default_factory=list)
    indented: list = field(default_factory=list)  # lines of fences that do not begin a line


def plain(command):
    return " ".join(command.split())


def is_command(text):
    """Whether a line or span begins with a program; variables may be set before it."""
    words = [word for word in text.split() if not re.match(r"[A-Z_]+=", word)]
    return bool(words) and (words[0] in programs or words[0].startswith(folders))


def read(path, name):
    text = path.read_text()

    def line(position):
        return text.count("\n", 0, position) + 1

    blocks = []
    for found in fence.finditer(text):
        kind, _, mark = (found[1] or "").partition(": ")
        blocks.append(Block(line(found.start(3)), found[2], found[3], kind, mark))
    page = Page(name, blocks)
    page.indented = [line(found.start()) for found in re.finditer(r"^[ >]+```", text, re.MULTILINE)]
    sentences = fence.sub(lambda block: re.sub(r"[^\n]", " ", block[0]), text)
    for found in re.finditer(r"`([^`]+)`", sentences):
        words = found[1].split()
        if not words or not is_command(found[1]):
            continue
        if len(words) == 1:
            if words[0].startswith(folders[:-1]) and not re.search(r"[<*]", words[0]):
                page.files.append((line(found.start()), words[0]))
        elif words[0] == "treacle" and len(words) == 3 and words[2].startswith("--") and words[2] != "--help":
            page.names.append((line(found.start()), words))
        elif words[0] != "treacle" or len(words) > 2 or words[1] in alone:
            page.inline.append((line(found.start()), plain(found[1])))
    of_blocks = {command for block in blocks for _, command in block.commands}
    page.inline = [one for one in page.inline if one[1] not in of_blocks]  # they name one that is run there
    return page


def all_of(source):
    """All pages of the repository."""
    files = [*source.glob("*.md"), *source.glob("docs/*.md"), source / "tests/fuzz/README.md"]
    return [read(file, str(file.relative_to(source))) for file in sorted(files)]
