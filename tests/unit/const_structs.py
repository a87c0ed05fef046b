#!/usr/bin/env python3
"""const_structs.py SOURCE_ROOT -- a structure that a GLSL function only reads is passed `const`.

glslang gives any other parameter a variable of its own and copies every member into it at each call. A driver has to find
out that they are copies: a kernel of `raymarch` took Mesa's compiler for AMD twice as long with them. Arrays are left out:
an element of a `const` one whose index is not known is read by copying the array.
"""
import os
import re
import sys

FUNCTION = re.compile(r"^\w+ (\w+)\(([^;{}()]*)\)\s*\{\n(.*?)^\}", re.M | re.S)
STRUCT = re.compile(r"\bstruct\s+(\w+)\s*\{")


def is_written(name, body):
    return re.search(rf"(?:\+\+|--)\s*{name}\b|\b{name}(\.\w+|\[[^\]]*\])*\s*(=(?!=)|[-+*/&|^%]=|<<=|>>=|\+\+|--)", body) is not None


def is_given(name, body, changers):
    """As an argument to a function that changes one."""
    for call in re.finditer(r"\b(\w+)\(", body):
        depth, end = 1, call.end()
        while depth and end < len(body):
            depth += {"(": 1, ")": -1}.get(body[end], 0)
            end += 1
        if call[1] in changers and re.search(rf"\b{name}\b", body[call.end():end]):
            return True
    return False


def faults(path, text, structs, changers):
    text = re.sub(r"//[^\n]*|/\*.*?\*/", lambda c: "\n" * c.group().count("\n"), text, flags=re.S)
    for found in FUNCTION.finditer(text):
        for parameter in found[2].split(","):
            words = parameter.split()
            words = words[1:] if words[:1] == ["in"] else words
            if len(words) == 2 and words[0] in structs and "[" not in words[1]:
                if not is_written(words[1], found[3]) and not is_given(words[1], found[3], changers):
                    line = text.count("\n", 0, found.start()) + 1
                    yield f"{path}:{line}: {found[1]}: const {parameter.strip()}"


def main():
    root, texts = sys.argv[1], {}
    for folder, _, names in (place for top in ("engine", "passes", "shaders") for place in os.walk(os.path.join(root, top))):
        for name in names:
            if name.endswith((".glsl", ".comp", ".vert", ".frag", ".geom", ".h")):
                path = os.path.join(folder, name)
                with open(path, encoding="utf-8") as file:
                    texts[os.path.relpath(path, root)] = file.read()
    structs = {name for text in texts.values() for name in STRUCT.findall(text)}
    # A parameter that is handed on to be changed is written too.
    changers = {f[1] for text in texts.values() for f in FUNCTION.finditer(text) if re.search(r"\b(?:inout|out) ", f[2])}
    bad = "struct a {\n};\nfloat f(a x)\n{\n    return x.y == 1.0 ? x.y : 0.0;\n}\n"
    good = bad.replace("return", "x.y += 1.0;\n    return") + bad.replace("(a x", "(const a x") + bad.replace("(a x", "(inout a x")
    wrong = [] if len(list(faults("", bad, {"a"}, set()))) == 1 and not list(faults("", good, {"a"}, set())) else ["the rule finds what it should not, or not what it should"]
    for path, text in sorted(texts.items()):
        if not path.endswith(".h"):
            wrong += faults(path, text, structs, changers)
    print("\n".join(wrong) or "all right")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
