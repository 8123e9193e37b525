"""What mkdocs does not do by itself: pages stay where they lie in the repository, and the site has the repository's folders.

- Every *.md is a page. Files that pages link to come along: pictures as they are, sources as pages with numbers of lines, the headers of the
  plugin as the API reference that doxygen made of them.
- `<!-- include: FILE#heading -->` on a line of its own takes in the section of another page, links kept right; a source file comes as code.
- Formulas in backquotes on the pages of FORMULAS, and $...$ anywhere, are set by KaTeX when the site is built.
- Names of calls and structs of wadi.h in backquotes lead to the API reference."""
import base64
import html
import json
import os
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree

from mkdocs.structure.files import File

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import equations  # noqa: E402

ROOT = HERE.parents[2]
FOLDERS = ("engine", "backends", "shaders", "plugin", "samples", "tests")
HEADERS = "plugin/include/wadi/"
FORMULAS = ("engine/NUMERICS.md", "plugin/docs/concepts.md")
WORK = pathlib.Path(os.environ["WADI_SITE_WORK"])  # what doxygen made: tags.xml, api/
KATEX = pathlib.Path("/usr/share/javascript/katex")
LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s]+)(\))")
INCLUDE = re.compile(r"<!-- include: (\S+) -->")
LANGUAGES = {".c": "c", ".h": "c", ".cpp": "cpp", ".hpp": "cpp", ".cu": "cuda", ".py": "python", ".sh": "bash", ".json": "json", ".glsl": "glsl",
             ".stage": "glsl", ".fused": "glsl", ".gd": "gdscript", ".cs": "csharp", ".cmake": "cmake"}
PICTURES = {".jpg", ".png", ".svg", ".webp", ".mp4"}

formulas = []  # (tex, display) of the page that is being made
api = {}       # name -> address in api/


def pages():
    """Every page of the repository, from its root."""
    found = [*ROOT.glob("*.md"), *(p for top in FOLDERS for p in (ROOT / top).rglob("*.md"))]
    return sorted(p.relative_to(ROOT).as_posix() for p in found)


def slug(text, separator="-"):
    """The fragment of a heading, as the repository's viewers make it."""
    return re.sub(r"[^\w\- ]", "", re.sub(r"<[^>]*>", "", html.unescape(text)).lower()).replace(" ", separator)


def lines_of(text):
    """(line, inside a code block) of every line."""
    code = False
    for line in text.splitlines():
        fence = line.lstrip().startswith("```")
        code = code != fence
        yield line, code or fence


def resolve(page, target):
    """(path from the root, fragment) of a link on a page, None of one that leaves the repository."""
    if re.match(r"[a-z]+:", target):
        return None
    name, _, fragment = target.partition("#")
    return (os.path.normpath(os.path.join(os.path.dirname(page), name)) if name else page), fragment


def relinked(text, change):
    """The text with change(target) in place of the target of every link outside code."""
    def linked(line):
        return LINK.sub(lambda m: m[1] + change(m[2]) + m[3], line)
    return "\n".join(line if code else linked(line) for line, code in lines_of(text))


def section(name, fragment):
    """What stands under a heading, without it."""
    found, depth = [], 0
    for line, code in lines_of((ROOT / name).read_text(encoding="utf-8")):
        heading = None if code else re.match(r"(#+) (.*)", line)
        if heading and depth and len(heading[1]) <= depth:
            break
        if depth:
            found.append(line)
        elif heading and slug(heading[2]) == fragment:
            depth = len(heading[1])
    if not depth:
        raise ValueError(f"{name} has no heading #{fragment}")
    return "\n".join(found)


def fenced(name):
    path = ROOT / name
    language = "cmake" if path.name == "CMakeLists.txt" else LANGUAGES.get(path.suffix, "text")
    return f"```{language}\n{path.read_text(encoding='utf-8').rstrip()}\n```\n"


def expanded(page, text):
    """Includes taken in."""
    def take(found):
        name, fragment = resolve(page, found[1])
        if not name.endswith(".md"):
            return fenced(name)
        def rebased(target):
            there = resolve(name, target)
            if there is None:
                return target
            way = os.path.relpath(there[0], os.path.dirname(page) or ".")
            return way + ("#" + there[1] if there[1] else "")
        return relinked(section(name, fragment), rebased)
    return "\n".join(INCLUDE.sub(take, line) if not code and INCLUDE.fullmatch(line) else line for line, code in lines_of(text))


ITEM = re.compile(r"( *)(?:[-*]|\d+\.) ")


def spaced(text):
    """As mkdocs' Markdown wants it where the repository's viewers are content with less: a blank line ahead of lists and tables and in place of
    comments, and what is in lists indented by four."""
    found, before, levels = [], "", []  # levels: where the items of the open lists begin
    for line, code in lines_of(text):
        bare = line.lstrip(" ")
        indent, item = len(line) - len(bare), None if code else ITEM.match(line)
        if re.fullmatch(r"<!--.*-->", line) and not code:
            line = bare = ""
        if item:
            if not levels and before.strip():
                found.append("")
            while levels and levels[-1] > indent:
                levels.pop()
            if not levels or levels[-1] < indent:
                levels.append(indent)
            line = "    " * (len(levels) - 1) + bare
        elif levels and bare and indent:
            line = "    " * len(levels) + (line[min(indent, levels[-1] + 3):] if code else bare)
        elif bare and not indent:
            if not before.strip() or code or bare.startswith(("#", "|")):
                levels.clear()
            if bare.startswith("|") and not code and before.strip() and not before.startswith("|"):
                found.append("")
        found.append(line)
        before = line
    return "\n".join(found)


def text_of(page):
    return expanded(page, (ROOT / page).read_text(encoding="utf-8"))


def on_config(config):
    config["mdx_configs"].setdefault("toc", {})["slugify"] = slug
    for compound in xml.etree.ElementTree.parse(WORK / "tags.xml").getroot().iter("compound"):
        if compound.get("kind") == "struct":
            api[compound.findtext("name")] = compound.findtext("filename")
        for member in compound.iter("member"):
            if member.get("kind") in ("function", "typedef"):
                api.setdefault(member.findtext("name"), f"{member.findtext('anchorfile')}#{member.findtext('anchor')}")
    return config


def on_files(files, config):
    """Pages, and whatever they link to."""
    def add(name):
        files.append(File(name, str(ROOT), config["site_dir"], False))
    names = pages()
    others = set()
    for page in names:
        def note(target, page=page):
            there = resolve(page, target)
            if there and not there[0].endswith(".md"):
                others.add(there[0])
            return target
        relinked(text_of(page), note)
        add(page)
    for name in sorted(others):
        path = ROOT / name
        if path.is_dir() and f"{name}/README.md" not in names:
            add(f"{name}/README.md")  # a list of its files
        if not path.is_file() or name.startswith(HEADERS):
            continue  # a folder; a dead link, at which mkdocs stops; the API reference
        add(name if path.suffix in PICTURES else name + ".md")
    for path in sorted((WORK / "api").rglob("*")):
        if path.is_file():
            files.append(File(path.relative_to(WORK).as_posix(), str(WORK), config["site_dir"], False))
    return files


def on_page_read_source(page, config):
    name = page.file.src_path
    if (ROOT / name).is_file():
        return None
    folder = (ROOT / name).parent
    if name.endswith("/README.md") and folder.is_dir():
        listed = "\n".join(f"- {path.name}" for path in sorted(folder.iterdir()))
        return f"# {folder.name}\n\n`{folder.relative_to(ROOT)}` holds\n\n{listed}\n"
    source = name.removesuffix(".md")
    return f"# {pathlib.Path(source).name}\n\n`{source}`\n\n{fenced(source)}"


def site_link(page):
    def change(target):
        there = resolve(page, target)
        if there is None or there[0].endswith(".md"):
            return target
        name, fragment = there
        path = ROOT / name
        if name.startswith(HEADERS):
            mangled = pathlib.Path(name).name.replace("_", "__").replace(".", "_8") + ".html"
            return os.path.relpath("api/" + mangled, os.path.dirname(page) or ".") + ("#" + fragment if fragment else "")
        if path.is_dir():
            return os.path.relpath(f"{name}/README.md", os.path.dirname(page) or ".")
        return target if path.suffix in PICTURES or not path.is_file() else target.partition("#")[0] + ".md"
    return change


def placed(tex, display):
    formulas.append((tex, display))
    return f"\u27e6{len(formulas) - 1}\u27e7"


# Names in the prose of FORMULAS that have an index: h_m, sigma_xy.
INDEXED = re.compile(rf"(?<![\w`/.])(?:[A-Za-z]{{1,2}}|{'|'.join(equations.GREEK)})_[A-Za-z0-9]{{1,3}}(?:(?<=_[a-z]),[A-Z])?'?(?![\w/]|\.\w)")
WIDE = 45  # characters; a longer formula has a line of its own


def with_formulas(page, text):
    """Formulas become marks, which on_page_content turns into what KaTeX made."""
    if page in FORMULAS:  # what begins with a bold word is a paragraph there
        text = re.sub(r"(?m)(?<=[^\n])\n(?=\*\*[A-Z][^*]*\*\*(?: \(|:|\.))", "\n\n", text)
    done = []
    paragraph = []

    def end():
        block = "\n".join(paragraph)
        paragraph.clear()
        if not block:
            return
        pieces = re.split(r"(``[^`]+``|`[^`]+`)", block)
        for n, piece in enumerate(pieces):
            if piece.startswith("`"):
                tex = equations.formula(piece.strip("`")) if page in FORMULAS else None
                pieces[n] = placed(tex, len(piece) > WIDE and not block.startswith("|")) if tex else piece
            else:
                piece = re.sub(r"\$\$([^$]+)\$\$", lambda m: placed(m[1], True), piece)
                piece = re.sub(r"(?<![\w$])\$([^$\n]+)\$(?![\w$])", lambda m: placed(m[1], False), piece)
                if page in FORMULAS and not block.startswith("#"):
                    piece = INDEXED.sub(lambda m: placed(tex, False) if (tex := equations.formula(m[0])) else m[0], piece)
                pieces[n] = piece
        done.append("".join(pieces))

    for line, code in lines_of(text):
        if code or not line.strip():
            end()
            done.append(line)
        else:
            paragraph.append(line)
            if line.startswith("#"):
                end()
    end()
    return "\n".join(done)


def on_page_markdown(markdown, page, config, files):
    name = page.file.src_path
    formulas.clear()
    if not (ROOT / name).is_file():
        return markdown
    return with_formulas(name, spaced(relinked(expanded(name, markdown), site_link(name))))


def on_page_content(html, page, config, files):
    if formulas:
        done = subprocess.run(["node", HERE / "render_math.js", KATEX / "katex.js"], input=json.dumps(formulas), capture_output=True, text=True)
        if done.returncode != 0:
            raise ValueError(f"{page.file.src_path}: {done.stderr}")
        made = json.loads(done.stdout)
        html = re.sub("\u27e6(\\d+)\u27e7", lambda m: made[int(m[1])], html)
        page.meta["math"] = True
    up = os.path.relpath("api", os.path.dirname(page.file.dest_path) or ".")
    def linked(found):
        return f'<a class="api" href="{up}/{api[found[2]]}">{found[0]}</a>' if found[2] in api else found[0]
    # Not inside links: those say already where they lead.
    parts = re.split(r"(<a\b.*?</a>)", html, flags=re.DOTALL)
    return "".join(part if part.startswith("<a") else re.sub(r"<code>((wadi_\w+)(?:\(\))?)</code>", linked, part) for part in parts)


def on_post_build(config):
    """What the theme cannot load from a file system, and KaTeX's style with its fonts inside."""
    site = pathlib.Path(config["site_dir"])
    index = (site / "search/search_index.json").read_text(encoding="utf-8")
    (site / "search/search_index.js").write_text(f"wadi_search_index({index});\n", encoding="utf-8")
    style = (KATEX / "katex.min.css").read_text(encoding="utf-8")
    fonts = {}
    def inside(found):
        fonts[found[1]] = base64.b64encode((KATEX / "fonts" / f"{found[1]}.ttf").read_bytes()).decode()
        return f'src:url(data:font/ttf;base64,{fonts[found[1]]}) format("truetype")'
    style = re.sub(r'src:url\(fonts/([\w-]+)\.woff2\)[^;}]*', inside, style)
    (site / "katex").mkdir(exist_ok=True)
    (site / "katex/katex.css").write_text(style, encoding="utf-8")
    for name in ("404.html", "sitemap.xml", "sitemap.xml.gz"):  # a server's
        (site / name).unlink(missing_ok=True)


def on_post_page(output, page, config):
    """A link to a folder is a list of files where there is no server."""
    return re.sub(r'href="((?:\.\./)*\.\.?)/?"', r'href="\1/index.html"', output)
