#!/usr/bin/env python3
"""ages.py SOURCE_ROOT -- a stored table grows old with its kernels, and with nothing else; and every table is in the manifest.

Works on a copy of the tree: tools/docs/all --stale reads sources alone.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = sys.argv[1]
TABLE = "docs/costs.md#smoke"
failures = 0


def check(what, is_so, detail=""):
    global failures
    if not is_so:
        failures += 1
        print(f"FAILED: {what} {detail}")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def stale(*names):
    """The lines that the command prints, by table."""
    result = subprocess.run(["tools/docs/all", "--stale", *names], capture_output=True, text=True, check=False)
    check("the list is no failure", result.returncode == 0, result.stderr)
    return dict(re.fullmatch(r"stale: (\S+): (.*)", line).groups() for line in result.stdout.splitlines())


def edit(path, change):
    """What is stale with an edit of a file; all is fresh before and after it."""
    text = read(path)
    write(path, change(text))
    found = stale()
    write(path, text)
    return found


def make_fresh():
    """Every table is of the kernels as they are."""
    sys.path.insert(0, "tools/docs")
    import ages
    kernels = ages.Kernels(".")
    kept = json.loads(read("tools/docs/ages.json"))
    for entry in kept.values():
        entry["kernels"] = kernels.hashes_of(name for name in entry["kernels"] if kernels.hash_of(name))
    write("tools/docs/ages.json", json.dumps(kept))


def check_hashes():
    begun = time.monotonic()
    check("all is fresh", not stale(), ", ".join(stale()))
    print(f"tools/docs/all --stale: {(time.monotonic() - begun) / 2:.2f} s")
    kernel, shared, other = (subprocess.run(["find", "passes", "shaders", "-name", name], capture_output=True, text=True,
                                            check=True).stdout.split()[0]
                             for name in ("lattice_sweep.comp", "medium.glsl", "path_trace.comp"))
    found = edit(kernel, lambda text: re.sub(r"(\bmain\(\)\s*\{)", r"\1;", text))
    check("a byte of a kernel", found.get(TABLE, "").endswith("since then changed: lattice"), found.get(TABLE))
    check("and what does not run it is fresh", "docs/choosing.md#single" not in found)
    check("a comment is none", not edit(kernel, lambda text: "// of other words\n" + text + "\n/* and\nmore */\n"))
    check("nor are spaces", not edit(kernel, lambda text: text.replace("\n", "  \n\n")))
    found = edit(shared, lambda text: text + "\n#define ANOTHER 1\n")
    check("a file that kernels include", "changed: beam" in found.get(TABLE, ""), found.get(TABLE))
    check("a kernel of another method", TABLE not in edit(other, lambda text: text + "\n#define ANOTHER 1\n"))
    folder = os.path.dirname(kernel)
    shutil.move(folder, "passes/elsewhere")
    check("where it lies", TABLE not in stale(), stale().get(TABLE))
    shutil.move("passes/elsewhere", folder)


def check_unknown():
    kept = json.loads(read("tools/docs/ages.json"))
    write("tools/docs/ages.json", json.dumps({k: v for k, v in kept.items() if k != TABLE}))
    check("no hash: unknown", stale("docs/costs.md").get(TABLE) == "unknown version", str(stale("docs/costs.md")))
    no_page = subprocess.run(["tools/docs/all", "--stale", "nowhere"], capture_output=True, text=True, check=False)
    report = "tools/bench/results/full.json"
    write("tools/docs/ages.json", json.dumps({**kept, report: {**kept[report], "kernels": {}}}))
    check("an older report", stale("README.md").get("README.md") == f"made from an older {report}", str(stale("README.md")))
    check("no such page", no_page.returncode != 0 and no_page.stderr.count("\n") == 1, no_page.stderr)


def check_resume():
    """A run goes on where it was: what was made is skipped, and a command that fails stops no other."""
    def entry(page, command):
        return {"page": page, "methods": [], "scenes": [], "minutes": 1.5, "command": command}

    write("tools/docs/ages.json", "{}")
    write("tools/docs/manifest.json", json.dumps([entry("a.md", "test -e go && echo a >>ran"), entry("b.md", "echo b >>ran"),
                                                  entry("c.md", "echo b >>ran")]))
    def run():
        result = subprocess.run(["tools/docs/all"], capture_output=True, text=True, check=False)
        return result.returncode, read("ran"), result.stdout

    first = run()
    check("what can be made is, a command for two tables once", first[:2] == (1, "b\n"), str(first))
    check("with the minutes of each page", "a.md: 1 to make, about 1.5 minutes\n" in first[2], first[2])
    write("go", "")
    check("then what is left", run()[:2] == (0, "b\na\n"))
    check("and then nothing", run()[:2] == (0, "b\na\n"))


def check_manifest():
    """Each table stands in its page, with its version; each mark of a page is in the manifest."""
    manifest, tables = json.loads(read("tools/docs/manifest.json")), set()
    for entry in manifest:
        for script in re.findall(r"\btools/docs/[\w-]+", entry["command"]):
            check(f"{entry['page']}: there is {script}", os.path.exists(script) or os.path.exists(script + ".c"))
        check("its page is there", os.path.exists(entry["page"]), entry["page"])
        if "table" in entry:
            tables.add((entry["page"], entry["table"]))
            block = re.search(rf"^<!-- tables {entry['table']} -->\n(.*?)^<!-- end of tables -->$", read(entry["page"]), re.M | re.S)
            check("its marks are there", block, str(entry))
            check("it says its version", block and re.search(r"^Version \d+\.\d+\.\d+ of \d{4}-\d\d-\d\d[.,]", block[1], re.M), str(entry))
    for folder, _, names in os.walk("."):
        for name in names:
            page = os.path.relpath(os.path.join(folder, name), ".")
            if name.endswith(".md"):
                for table in re.findall(r"^<!-- tables (\S+) -->$", read(page), re.M):
                    check("a table is in the manifest", (page, table) in tables, f"{page}#{table}")
    names = {e["page"] + ("#" + e["table"] if "table" in e else "") for e in manifest}
    check("ages.json has no other tables", set(json.loads(read("tools/docs/ages.json"))) <= names)


with tempfile.TemporaryDirectory() as copy:
    for part in "docs", "engine/include", "passes", "shaders", "tools/docs", "tools/bench":
        shutil.copytree(os.path.join(ROOT, part), os.path.join(copy, part))
    for part in "README.md", "meson.build":
        shutil.copy(os.path.join(ROOT, part), copy)
    os.chdir(copy)
    check_manifest()
    make_fresh()
    check_hashes()
    check_unknown()
    check_resume()
sys.exit(1 if failures else 0)
