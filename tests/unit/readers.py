#!/usr/bin/env python3
"""readers.py SOURCE_ROOT -- who reads which file, from the #include lines.

A file in shaders/ is there because several passes read it, or the engine: what one pass alone reads stands in its
folder, what the passes of one module alone read in its common/. Of a pass nothing else sees but its header, NAME/NAME.h. Modules see
the headers of a shared module, which has a module.c and no method.c. Files of different folders include each other in no
circle; a header and the source of its name are one.
"""
import os
import re
import sys
import tempfile

FOLDERS = ("engine", "passes", "shaders", "tools", "samples")
CODE = (".c", ".h", ".cpp", ".comp", ".vert", ".frag", ".glsl")
ROOTS = ("engine/include/", "engine/", "", "tools/")


def files_below(root):
    for folder in FOLDERS:
        for path, _, names in os.walk(os.path.join(root, folder)):
            for name in names:
                if name.endswith(CODE) and not re.match(r"passes/\w+/tests\b", os.path.relpath(path, root)):
                    yield os.path.relpath(os.path.join(path, name), root)


def includes(root):
    """For each file the files of the tree that it includes."""
    files = set(files_below(root))
    found = {}
    for file in files:
        found[file] = set()
        with open(os.path.join(root, file), encoding="utf-8") as text:
            for name in re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', text.read(), re.M):
                beside = os.path.normpath(os.path.join(os.path.dirname(file), name))
                for target in [beside] + [root_of + name for root_of in ROOTS]:
                    if target in files:
                        found[file].add(target)
                        break
    return found


def module_of(file, graph):
    """passes/MODULE, whose passes are folders in it; None: no module's."""
    module = "/".join(file.split("/")[:2])
    return module if module + "/module.c" in graph else None


def readers(of, graph):
    """Passes and modules that read a shader, straight or through others, and folders of the engine that do so straight."""
    folders, seen, wanted = set(), set(), [of]
    while wanted:
        target = wanted.pop()
        for file, targets in graph.items():
            if target in targets and file not in seen:
                seen.add(file)
                if file.startswith("shaders/"):
                    wanted.append(file)
                elif file.startswith("passes/") or target == of:
                    folders.add(module_of(file, graph) or os.path.dirname(file))
    return folders


def circles(graph):
    """Groups of files that include each other and are not all of one folder (Tarjan's components)."""
    def whole(file):
        return re.sub(r"\.(c|h|cpp)$", "", file)
    edges = {}
    for file, targets in graph.items():
        edges.setdefault(whole(file), set()).update(whole(t) for t in targets if whole(t) != whole(file))
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for target in edges.get(node, ()):
            if target not in index:
                visit(target)
                low[node] = min(low[node], low[target])
            elif target in stack:
                low[node] = min(low[node], index[target])
        if low[node] == index[node]:
            group = [stack.pop()]
            while group[-1] != node:
                group.append(stack.pop())
            if len({os.path.dirname(f) for f in group}) > 1:
                found.append(sorted(group))

    for node in sorted(edges):
        if node not in index:
            visit(node)
    return found


def faults(root):
    graph = includes(root)
    lines = []
    for file in sorted(graph):
        if file.startswith("shaders/"):
            folders = readers(file, graph)
            if len(folders) < 2:
                lines.append(f"{file}: is read by {' '.join(folders) or 'nobody'} alone")
        if not file.startswith("shaders/"):
            for target in sorted(graph[file]):
                folder, name = os.path.split(target)
                shared = folder.startswith("passes/methods") or os.path.basename(folder) == "common" \
                    or folder + "/module.c" in graph and folder + "/method.c" not in graph
                own = folder == os.path.dirname(file)
                if folder.startswith("passes/") and not own and not shared and name != os.path.basename(folder) + ".h":
                    lines.append(f"{file}: includes {target}, which is private to its pass")
    return lines + ["circle: " + " ".join(group) for group in circles(graph)]


def check_itself():
    """Every line of `expected` is a fault of this tree, and nothing else is."""
    tree = {
        "shaders/x/several.glsl": "", "shaders/x/one.glsl": "", "shaders/x/deep.glsl": "", "shaders/x/none.glsl": "",
        "shaders/x/way.glsl": '#include "shaders/x/deep.glsl"',
        "passes/a/a.comp": '#include "shaders/x/several.glsl"\n#include "shaders/x/way.glsl"\n#include "a_args.h"',
        "passes/b/b.comp": '#include "shaders/x/several.glsl"\n#include "shaders/x/one.glsl"\n'
                           '#include "shaders/x/way.glsl"',
        "passes/a/a.h": "", "passes/a/a_args.h": "",
        "shaders/x/module.glsl": "", "passes/mod/module.c": '#include "one/one.h"\n#include "one/one_args.h"',
        "passes/mod/one/one.comp": '#include "shaders/x/module.glsl"', "passes/mod/two/two.comp": '#include "shaders/x/module.glsl"',
        "passes/mod/one/one.h": "", "passes/mod/one/one_args.h": "", "passes/mod/common/c.glsl": "",
        "passes/mod/two/more.comp": '#include "../common/c.glsl"', "passes/mod/tests/t.c": '#include "shaders/x/module.glsl"',
        "passes/methods/m.c": '#include "passes/a/a_args.h"\n#include "passes/methods/light/l.h"', "passes/methods/light/l.h": "",
        "engine/m/m.c": '#include "passes/a/a.h"\n#include "passes/a/a_args.h"',
        "engine/m/round.h": '#include "n/back.h"', "engine/n/back.c": '#include "m/round.h"\n#include "n/back.h"',
        "engine/n/back.h": "",
    }
    expected = [
        "engine/m/m.c: includes passes/a/a_args.h, which is private to its pass",
        "passes/methods/m.c: includes passes/a/a_args.h, which is private to its pass",
        "passes/mod/module.c: includes passes/mod/one/one_args.h, which is private to its pass",
        "shaders/x/module.glsl: is read by passes/mod alone",
        "shaders/x/none.glsl: is read by nobody alone",
        "shaders/x/one.glsl: is read by passes/b alone",
        "circle: engine/m/round engine/n/back",
    ]
    with tempfile.TemporaryDirectory() as root:
        for name, text in tree.items():
            os.makedirs(os.path.join(root, os.path.dirname(name)), exist_ok=True)
            with open(os.path.join(root, name), "w", encoding="utf-8") as file:
                file.write(text + "\n")
        found = faults(root)
    if found != expected:
        sys.exit("the check itself is broken: it found\n" + "\n".join(found))


check_itself()
lines = faults(sys.argv[1])
print("\n".join(lines))
sys.exit(1 if lines else 0)
