#!/usr/bin/env python3
"""Reads the built site as a browser would. Usage: check_site.py SITE PAGE ...     PAGE: addresses below SITE that must be there.
Every link leads to a file and every fragment to an anchor, every picture, style and script is there, nothing is loaded from elsewhere, and
every page can be reached from index.html. Exit status 1 names every breach."""
import html
import os
import pathlib
import re
import sys
import tempfile
import urllib.parse

TAG = re.compile(r"<(\w+)\b((?:\"[^\"]*\"|'[^']*'|[^'\">])*)>")
ATTRIBUTE = re.compile(r"([\w:-]+)\s*=\s*(?:\"([^\"]*)\"|'([^']*)')")
NOT_TEXT = re.compile(r"<!--.*?-->|<script\b[^>]*>.*?</script>", re.DOTALL)
LOADED = {("img", "src"), ("script", "src"), ("link", "href"), ("source", "src"), ("video", "src"), ("iframe", "src")}


class Page:
    def __init__(self, path):
        text = path.read_text(encoding="utf-8", errors="replace")
        # Scripts have no links of their own, but they are loaded from somewhere.
        text = NOT_TEXT.sub(lambda m: m[0][:m[0].index(">") + 1] if m[0].startswith("<script") else "", text)
        self.anchors, self.links, self.loaded = set(), [], []
        for name, rest in TAG.findall(text):
            given = {key: html.unescape(double or single) for key, double, single in ATTRIBUTE.findall(rest)}
            self.anchors.update(given[key] for key in ("id", "name") if key in given)
            if name == "a" and "href" in given:
                self.links.append(given["href"])
            if name == "link" and given.get("rel") in ("canonical", "prev", "next"):
                continue
            self.loaded += [given[key] for tag, key in LOADED if tag == name and key in given]


def check(site, wanted):
    site = site.resolve()
    pages = {path.resolve(): Page(path) for path in site.rglob("*.html")}
    found = [f"{name}: is not there" for name in wanted if (site / name).resolve() not in pages]
    counts = {"links": 0, "loaded": 0}
    ways = {}

    def target(page, address):
        """(file, fragment) or None where an address leaves the site."""
        parts = urllib.parse.urlsplit(address)
        if parts.scheme or parts.netloc:
            return None
        path = pathlib.Path(os.path.normpath(page.parent / urllib.parse.unquote(parts.path))) if parts.path else page
        return path / "index.html" if path.is_dir() else path, urllib.parse.unquote(parts.fragment)

    for page, has in pages.items():
        name = page.relative_to(site).as_posix()
        for address in dict.fromkeys(has.links):
            there = target(page, address)
            if there is None or address.startswith("javascript:"):
                continue
            counts["links"] += 1
            path, fragment = there
            if not path.is_file() or site not in path.parents:
                found.append(f"{name}: links to {address}, which is not there")
            elif fragment and path in pages and fragment not in pages[path].anchors and not fragment.startswith("__"):
                found.append(f"{name}: links to {address}, where nothing has that name")
            else:
                ways.setdefault(page, set()).add(path)
        for address in dict.fromkeys(has.loaded):
            if address.startswith(("data:", "javascript:")):
                continue
            counts["loaded"] += 1
            there = target(page, address)
            if there is None:
                found.append(f"{name}: loads {address} from elsewhere")
            elif not there[0].is_file():
                found.append(f"{name}: loads {address}, which is not there")
    for menu in site.rglob("menudata.js"):  # doxygen's
        for address in re.findall(r'url:"([^"]+)"', menu.read_text(encoding="utf-8")):
            path, fragment = target(menu.resolve(), address)
            if not path.is_file() or fragment and fragment not in pages[path].anchors:
                found.append(f"{menu.relative_to(site)}: links to {address}, which is not there")
    for style in site.rglob("*.css"):
        for address in re.findall(r"url\(\s*['\"]?([^)'\"]+)", style.read_text(encoding="utf-8", errors="replace")):
            if re.match(r"https?:|//", address):
                found.append(f"{style.relative_to(site)}: loads {address} from elsewhere")
    reached, open_ends = set(), [site / "index.html"]
    while open_ends:
        page = open_ends.pop()
        if page not in reached:
            reached.add(page)
            open_ends += ways.get(page, ())
    for page in pages:
        # Doxygen's own lists are reached by its menu, which is a script.
        if page not in reached and page.parent.name != "search" and "api" not in page.relative_to(site).parts and page.name != "404.html":
            found.append(f"{page.relative_to(site)}: no link leads there")
    return found, len(pages), counts


def control():
    """Planted breaches must be seen, and nothing else."""
    with tempfile.TemporaryDirectory() as folder:
        site = pathlib.Path(folder)
        (site / "sub").mkdir()
        (site / "there.png").write_bytes(b"")
        (site / "index.html").write_text('<a href="sub/">s</a> <a href="sub/index.html#right">r</a> <a href="sub/index.html#wrong">w</a> <a href="gone.html">g</a>'
                                         '<img src="there.png"><img src="gone.png"><script src="https://example.org/x.js">"<a href=\'no.html\'>"</script>'
                                         '<!-- <a href="no.html"> --><a href="https://example.org">e</a> <pre>&lt;a href="no.html"&gt;</pre>')
        (site / "sub/index.html").write_text('<h1 id="right">s</h1><a href="../index.html">up</a><link rel="stylesheet" href="../gone.css"><a href="#nowhere">n</a>')
        (site / "lonely.html").write_text("<p>alone</p>")
        (site / "style.css").write_text("a { background: url(https://example.org/y.png) }")
        (site / "menudata.js").write_text('var menudata={children:[{text:"a",url:"sub/index.html#right"},{text:"b",url:"sub/none.html"}]}')
        seen, _, _ = check(site, ["index.html", "missing.html"])
    wanted = ("#wrong, where", "gone.html, which", "gone.png, which", "x.js from elsewhere", "gone.css, which", "#nowhere, where", "lonely.html: no link",
              "missing.html: is not there", "y.png from elsewhere", "sub/none.html, which")
    missing = [sign for sign in wanted if sum(sign in breach for breach in seen) != 1]
    return missing + ([] if len(seen) == len(wanted) else seen)


def main():
    wrong = control()
    if wrong:
        print("the checker does not see what is planted, or sees what is none:", *wrong, sep="\n")
        return 1
    found, pages, counts = check(pathlib.Path(sys.argv[1]), sys.argv[2:])
    print(*found, f"{pages} pages, {counts['links']} links, {counts['loaded']} files that pages load; {len(found)} breaches", sep="\n")
    return 1 if found or pages < 60 or counts["links"] < 1000 else 0


if __name__ == "__main__":
    sys.exit(main())
