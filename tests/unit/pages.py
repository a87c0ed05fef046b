#!/usr/bin/env python3
"""pages.py SOURCE_ROOT -- what pages and sources point to is there: a relative link of a page and its heading, a page and its
heading that a source names ("docs/choosing.md, "Samples""), and a file that a page names by its path.
"""
import os
import re
import sys
import tempfile

SOURCES = (".c", ".h", ".cpp", ".in", ".comp", ".vert", ".frag", ".glsl", ".py", ".sh", ".build", ".md", "")  # "": scripts
FILES = r"(?:engine|passes|shaders|tools|samples|tests|docs)/[\w./-]+"


def walk(root):
    for folder, folders, files in os.walk(root):
        folders[:] = [f for f in folders if not f.startswith(".") and not f.startswith("build") and f != "out"]
        for name in files:
            yield os.path.relpath(os.path.join(folder, name), root)


def read(root, path):
    with open(os.path.join(root, path), encoding="utf-8", errors="replace") as file:
        return file.read()


def anchor(heading):
    """As GitHub makes them."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def headings(text):
    text = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    return re.findall(r"^#+ +(.*)$", text, re.M)


def check(root):
    """One line for each fault."""
    faults = []
    paths = sorted(walk(root))
    pages = {path: read(root, path) for path in paths if path.endswith(".md")}
    for page, text in pages.items():
        for link in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)):
            if re.match(r"[a-z]+:", link):
                continue
            name, _, part = link.partition("#")
            target = os.path.normpath(os.path.join(os.path.dirname(page), name)) if name else page
            if not os.path.exists(os.path.join(root, target)):
                faults.append(f"{page}: {link}: there is no {target}")
            elif part and part not in [anchor(h) for h in headings(pages.get(target, ""))]:
                faults.append(f"{page}: {link}: {target} has no such heading")
        for named in re.findall(rf"[`\s(]({FILES}\.(?:c|h|cpp|comp|glsl|py|sh|json))\b", text):
            if not os.path.exists(os.path.join(root, named)):
                faults.append(f"{page}: there is no {named}")
        for named in re.findall(r"\btools/docs/[\w-]+(?:\.\w+)?", text):
            if not os.path.exists(os.path.join(root, named)) and not os.path.exists(os.path.join(root, named + ".c")):
                faults.append(f"{page}: there is no {named}")
    for path in paths:
        if os.path.splitext(path)[1] not in SOURCES or os.path.basename(path) == os.path.basename(__file__):
            continue
        text = read(root, path)
        for named, heading in re.findall(r'\b((?:docs|passes/\w+)/[\w-]+\.md|README\.md(?=, \\?"))(?:, \\?"([^"\\]+)\\?")?', text):
            if named not in pages:
                faults.append(f"{path}: there is no {named}")
            elif heading and heading not in [h.replace("`", "") for h in headings(pages[named])]:
                faults.append(f'{path}: {named} has no heading "{heading}"')
    return faults


def check_itself():
    """Every line but the good ones is a fault, and nothing else is."""
    with tempfile.TemporaryDirectory(prefix="tyndall-pages-") as root:
        for name, text in {
            "README.md": "[a](docs/a.md) [b](docs/a.md#a-heading-of-a) [w](https://example.org/none.md)\n"
                         "[gone](docs/gone.md)\n[no](docs/a.md#none)\n`engine/none.c`\n",
            "CHANGELOG.md": "docs/gone.md\n",
            "docs/a.md": "# Page\n\n## A `heading` of a\n\n[up](../README.md) [here](#page) `engine/good.c` tools/docs/none\n",
            "engine/good.c": '// docs/a.md, "A heading of a" passes/m/m.md\n',
            "passes/m/m.md": "# Module\n",
            "engine/bad.c": '"docs/gone.md" passes/m/gone.md passes/m/m.md, "None" "docs/a.md, \\"None\\"" README.md, "None"\n',
        }.items():
            os.makedirs(os.path.dirname(os.path.join(root, name)), exist_ok=True)
            with open(os.path.join(root, name), "w", encoding="utf-8") as file:
                file.write(text)
        return check(root)


expected = 11
found = check_itself()
if len(found) != expected:
    sys.exit(f"the check itself is broken: {expected} faults expected, found:\n" + "\n".join(found))
faults = check(sys.argv[1])
print("\n".join(faults) or "all right")
sys.exit(1 if faults else 0)
