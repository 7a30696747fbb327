#!/usr/bin/env python3
"""Makes two archives for Windows from an installed tree: the program, for people, and the libraries, for programmers.

usage: tools/windows/make_archives.py INSTALLED SCRIPT PLAYGROUND VERSION FOLDER

INSTALLED is the prefix of `cmake --install`, SCRIPT the completion for PowerShell. PLAYGROUND is the page that `make web`
builds; the archive lacks it if it does not exist. The archives are written to FOLDER. Each contains one folder.
"""

import re
import sys
import zipfile
from pathlib import Path

import markdown

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/site"))
from build_site import LINK, relinked  # noqa: E402 (the path is set above)

# Pages about other systems and other interfaces than the program. Links to them lead to nothing, and become plain words.
LEFT_OUT = {"index.md", "macos.md", "javascript.md", "python.md", "architecture.md", "dependencies.md", "cores.md", "paper.md",
            "benchmarks.md", "howto/embedding.md"}
STYLE = ("body{max-width:50em;margin:2em auto;padding:0 1em;font:16px/1.5 'Segoe UI',sans-serif;color:#222;background:#fff}"
         "img{max-width:100%}pre,code{font:14px/1.4 Consolas,monospace;background:#f3f3f3}pre{padding:.7em;overflow:auto}"
         "table{border-collapse:collapse}td,th{border:1px solid #ccc;padding:.2em .5em;text-align:left;vertical-align:top}")


def main(installed, script, playground, version, folder):
    program = f"lamella-{version}"
    texts = {name: text.encode() for name, text in pages().items()}
    texts |= {image.relative_to(ROOT).as_posix(): image.read_bytes() for image in images(texts)}
    texts["README.txt"] = with_crlf((ROOT / "tools/windows/README.txt").read_text(encoding="utf-8").replace("VERSION", version))
    for name in ("LICENSE", "LICENSES-third-party.txt"):
        texts[name.removesuffix(".txt") + ".txt"] = with_crlf((ROOT / name).read_text(encoding="utf-8"))
    texts |= {f"licences/{one.name}": one.read_bytes() for one in sorted((installed / "share/licences").iterdir())}
    texts["lamella.exe"] = (installed / "bin/lamella.exe").read_bytes()
    texts["lamella.ps1"] = with_crlf(script.read_text(encoding="utf-8"))
    if playground.is_file():
        texts["playground.html"] = playground.read_bytes()
    write(folder / f"{program}-windows-x86_64.zip", program, texts)

    of_program = ("bin/lamella.exe", "share/man/", "share/bash-completion/", "share/zsh/", "share/fish/")
    sdk = {path: (installed / path).read_bytes()
           for path in sorted(one.relative_to(installed).as_posix() for one in installed.rglob("*") if one.is_file())
           if not path.startswith(of_program)}
    write(folder / f"lamella-sdk-{version}-windows-x86_64.zip", f"lamella-sdk-{version}", sdk)


def write(path, folder, files):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in sorted(files.items()):
            archive.writestr(f"{folder}/{name}", content)
    print(f"{path}: {path.stat().st_size / 1e6:.1f} MB")


def with_crlf(text):
    return text.replace("\n", "\r\n").encode()


def pages():
    """Returns the pages of docs/ as HTML, by their names in the archive."""
    docs = ROOT / "docs"
    chosen = {page.relative_to(docs).as_posix(): page for page in sorted(docs.rglob("*.md"))}
    chosen = {name: page for name, page in chosen.items() if name not in LEFT_OUT}

    def follow(match, name):
        target = match[2]
        if "://" in target:
            return match[0]
        found = (docs / name).parent.joinpath(target).resolve()
        inside = found.relative_to(docs).as_posix() if found.is_relative_to(docs) else None
        if target.endswith(".md"):
            return match[1] + (target.removesuffix(".md") + ".html" + match[3] if inside in chosen else "#)")
        return match[0] if found.is_file() else match[1] + "#)"

    written = {}
    for name, page in chosen.items():
        blocks = re.split(r"(^```.*?^```$)", relinked(page), flags=re.MULTILINE | re.DOTALL)
        blocks[::2] = [re.sub(r"\[([^\]]*)\]\(#\)", r"\1", LINK.sub(lambda match: follow(match, name), text)) for text in blocks[::2]]
        body = markdown.markdown("".join(blocks), extensions=["tables", "fenced_code", "toc", "sane_lists"])
        title = re.search(r"^# (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)[1]
        written[f"docs/{name.removesuffix('.md')}.html"] = (
            f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{title}: Lamella</title><style>{STYLE}</style>\n{body}\n</html>\n')
    return written


def images(texts):
    """Returns the images that pages show."""
    for name, text in texts.items():
        for image in re.findall(r'<img[^>]* src="([^"]+)"', text.decode()):
            yield (ROOT / name).parent.joinpath(image).resolve()


if __name__ == "__main__":
    if len(sys.argv) != 6:
        sys.exit(__doc__.strip())
    main(*map(Path, sys.argv[1:4]), sys.argv[4], Path(sys.argv[5]))
