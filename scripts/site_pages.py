"""What the site has beside docs/ (mkdocs.yml): pages of the top folder, the pages of the C++ headers, and the files of the
repository that pages link to, so that the links of GitHub hold on the site, too."""

import pathlib
import posixpath
import re
import subprocess

from mkdocs.structure.files import File

root = pathlib.Path(__file__).resolve().parents[1]
top_pages = {
    "README.md": "index.md",
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
    "THIRD-PARTY-NOTICES.md": "third-party-notices.md",
}
headers = root / "build/site-cpp"  # of doxygen (scripts/site)
link = re.compile(r"(\]\()([^)#\s]+)([^)\s]*\))")
fence = re.compile(r"^(```.*?^```)", re.MULTILINE | re.DOTALL)


def in_site(path):
    """Where a file or folder of the repository is on the site; None: it is not there."""
    if path in top_pages:
        return top_pages[path]
    if path.startswith("docs/"):
        return path.removeprefix("docs/")
    if (root / path).is_dir():
        return f"source/{path}/index.md"
    if not (root / path).is_file():
        return None
    return f"source/{path}.txt"  # shown, not loaded


def folder_of(uri):
    """The folder in the repository that the links of a page start from."""
    return "" if uri in top_pages.values() else posixpath.dirname("docs/" + uri)


def targets(text, folder):
    for part in fence.split(text)[::2]:
        for _, path, _ in link.findall(part):
            if ":" not in path:
                yield posixpath.normpath(posixpath.join(folder, path))


def tracked(folder):
    listed = subprocess.run(["git", "ls-files", folder], cwd=root, capture_output=True, text=True, check=True)
    return listed.stdout.split()


def on_files(files, config):
    pages = {uri: (root / name).read_text() for name, uri in top_pages.items()}
    texts = [(text, "") for text in pages.values()]
    texts += [(path.read_text(), str(path.parent.relative_to(root))) for path in (root / "docs").rglob("*.md")]
    for uri, text in pages.items():
        files.append(File.generated(config, uri, content=text))
    made = set()
    for path in sorted({path for text, folder in texts for path in targets(text, folder)}):
        uri = in_site(path)
        if uri is None or not uri.startswith("source/"):
            continue
        contained = tracked(path) if (root / path).is_dir() else [path]
        for name in contained:
            if name not in made:
                made.add(name)
                files.append(File.generated(config, f"source/{name}.txt", content=(root / name).read_bytes()))
        if (root / path).is_dir():
            rows = [f"- [{name}]({posixpath.relpath(name, path)}.txt)" for name in contained]
            files.append(File.generated(config, uri, content=f"# {path}\n\n" + "\n".join(rows) + "\n"))
    for path in sorted(path for path in headers.rglob("*") if path.is_file()):
        uri = f"cpp/{path.relative_to(headers).as_posix()}"
        files.append(File.generated(config, uri, abs_src_path=str(path)))
    return files


def on_page_markdown(markdown, page, **_):
    uri = page.file.src_uri
    if uri.startswith("source/"):
        return markdown

    def moved(match):
        before, path, after = match.groups()
        if ":" in path:
            return match.group()
        there = in_site(posixpath.normpath(posixpath.join(folder_of(uri), path)))
        return before + (posixpath.relpath(there, posixpath.dirname(uri) or ".") if there else path) + after

    parts = fence.split(markdown)
    return "".join(part if k % 2 else link.sub(moved, part) for k, part in enumerate(parts))
