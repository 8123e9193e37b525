#!/usr/bin/env python3
"""What others wrote and ends up in the library: their licences' texts as one file, or a list of parts in SPDX's JSON.

Usage: third_party.py texts [--zig ZIGLANG] [--windows] [--programs] FILE
       third_party.py sbom --version V --commit C [--zig ZIGLANG] [--windows] [--file PATH ...] FILE
  --zig FOLDER  the library was built by zig: its package ziglang, whose C++ library is inside
  --windows     and MinGW's start-up code
  --programs    and what is in wadi-recorder, wadi-import and wadi-tune alone
Texts are those of Debian's packages (/usr/share/doc/PACKAGE/copyright) and of zig's. Exit status 1 names a text that is not there."""
import argparse
import datetime
import hashlib
import json
import pathlib
import re
import subprocess
import sys

# package of Debian: name, licence in SPDX's words, home, what it is in the library
DEBIAN = {
    "libvulkan-volk-dev": ("volk", "MIT", "https://github.com/zeux/volk", "finds Vulkan's functions"),
    "libvulkan-dev": ("Vulkan-Headers", "Apache-2.0", "https://github.com/KhronosGroup/Vulkan-Headers", "Vulkan's types"),
    "nlohmann-json3-dev": ("JSON for Modern C++", "MIT", "https://github.com/nlohmann/json", "reads level files"),
    "libstb-dev": ("stb_image", "MIT", "https://github.com/nothings/stb", "reads PNG"),
}
PROGRAMS = {
    "libdeflate-dev": ("libdeflate", "MIT", "https://github.com/ebiggers/libdeflate", "writes PNG"),
    "libcli11-dev": ("CLI11", "BSD-3-Clause", "https://github.com/CLIUtils/CLI11", "reads command lines"),
    "libglm-dev": ("GLM", "MIT", "https://github.com/g-truc/glm", "vectors of pictures"),
}
# file of the package ziglang: the same
LLVM = "Apache-2.0 WITH LLVM-exception"
ZIG = {
    "lib/libcxx/LICENSE.TXT": ("libc++", LLVM, "https://libcxx.llvm.org", "C++'s library"),
    "lib/libcxxabi/LICENSE.TXT": ("libc++abi", LLVM, "https://libcxxabi.llvm.org", "C++'s exceptions"),
    "lib/libunwind/LICENSE.TXT": ("libunwind", LLVM, "https://github.com/llvm/llvm-project", "C++'s exceptions"),
    "LICENSE": ("zig's compiler-rt", "MIT", "https://ziglang.org", "arithmetic that a processor lacks"),
}
MINGW = {"lib/libc/mingw/COPYING": ("mingw-w64", "ZPL-2.1", "https://www.mingw-w64.org", "start-up code on Windows")}


def parts(zig, windows, programs=False):
    """(name, version, licence, home, use, text) of each."""
    for package, (name, licence, home, use) in {**DEBIAN, **(PROGRAMS if programs else {})}.items():
        text = pathlib.Path("/usr/share/doc") / package / "copyright"
        version = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True, check=False).stdout or "unknown"
        yield name, version, licence, home, use, text
    if zig:
        version = subprocess.run([zig / "zig", "version"], capture_output=True, text=True, check=True).stdout.strip()
        for text, (name, licence, home, use) in {**ZIG, **(MINGW if windows else {})}.items():
            yield name, f"of zig {version}", licence, home, use, zig / text


def texts(found):
    lines = ["Parts of Wadi's library that others wrote, and their licences.", ""]
    lines += [f"- {name} ({version}), {use}: {licence}, {home}" for name, version, licence, home, use, _ in found]
    titled = [(name, text.read_text(encoding="utf-8")) for name, _, _, _, _, text in found]
    common = sorted({name for _, text in titled for name in re.findall(r"/usr/share/common-licenses/([\w.-]*\w)", text)})  # named there, not repeated
    titled += [(name, (pathlib.Path("/usr/share/common-licenses") / name).read_text(encoding="utf-8")) for name in common]
    for title, text in titled:
        lines += ["", "=" * 78, title, "=" * 78, "", text.strip()]
    return "\n".join(lines) + "\n"


def sbom(found, version, commit, files):
    """https://spdx.github.io/spdx-spec/v2.3"""
    def identity(name):
        return "SPDXRef-" + "".join(c if c.isalnum() else "-" for c in name)

    def package(name, version, licence, home):
        return {"name": name, "SPDXID": identity(name), "versionInfo": version, "downloadLocation": home, "filesAnalyzed": False,
                "licenseConcluded": licence, "licenseDeclared": licence, "copyrightText": "NOASSERTION"}

    wadi = package("Wadi", version, "LicenseRef-Wadi-NoLicenceYet", "NOASSERTION")
    wadi["sourceInfo"] = f"commit {commit}"
    unchosen = [{"licenseId": "LicenseRef-Wadi-NoLicenceYet", "name": "No licence yet", "extractedText": "No licence has been chosen yet, so none is granted: see NOTICE.md."}]
    entries, relations = [], [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": identity("Wadi")}]
    for path in files:
        data = path.read_bytes()
        entries.append({"fileName": f"./{path.name}", "SPDXID": identity(f"File-{path.name}"), "licenseConcluded": "NOASSERTION", "copyrightText": "NOASSERTION",
                        "checksums": [{"algorithm": "SHA1", "checksumValue": hashlib.sha1(data).hexdigest()}, {"algorithm": "SHA256", "checksumValue": hashlib.sha256(data).hexdigest()}]})
        relations.append({"spdxElementId": identity("Wadi"), "relationshipType": "GENERATES", "relatedSpdxElement": identity(f"File-{path.name}")})
    packages = [wadi]
    for name, part_version, licence, home, _, _ in found:
        packages.append(package(name, part_version, licence, home))
        relations.append({"spdxElementId": identity("Wadi"), "relationshipType": "STATIC_LINK", "relatedSpdxElement": identity(name)})
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"wadi-{version}",
            "documentNamespace": f"urn:wadi:{version}:{commit}",
            "creationInfo": {"created": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: plugin/packaging/third_party.py"]},
            "packages": packages, "files": entries, "relationships": relations, "hasExtractedLicensingInfos": unchosen}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("texts", "sbom"))
    parser.add_argument("--zig", type=pathlib.Path)
    parser.add_argument("--windows", action="store_true")
    parser.add_argument("--version", default="")
    parser.add_argument("--commit", default="")
    parser.add_argument("--programs", action="store_true")
    parser.add_argument("--file", type=pathlib.Path, action="append", default=[])
    parser.add_argument("output", type=pathlib.Path)
    options = parser.parse_args()
    found = list(parts(options.zig, options.windows, options.programs))
    for name, _, _, _, _, text in found:
        if not text.is_file():
            sys.exit(f"third_party.py: the licence of {name} is not at {text}: what contains {name} may not be passed on without it")
    if options.what == "texts":
        options.output.write_text(texts(found), encoding="utf-8")
    else:
        options.output.write_text(json.dumps(sbom(found, options.version, options.commit, options.file), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
