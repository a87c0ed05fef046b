"""full_runs.py -- which modules' long tests tools/full_runs asks for: in a tree of its own, file by file.

usage: full_runs.py TOOLS/FULL_RUNS
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

FILES = {
    "engine/include/tyndall/pass.h": "int pass;\n",
    "shaders/light/sky.glsl": "float sky;\n",
    "passes/a/module.c": "int a;\n",
    "passes/a/method.c": "int a_method;\n",
    "passes/a/meson.build": "a\n",
    "passes/a/tests/accuracy/a.c": "int test;\n",
    "passes/b/module.c": "int b;\n",
    "passes/b/method.c": "int b_method;\n",
    "passes/b/meson.build": "b\n",
    "passes/left_out/module.c": "int left_out;\n",
    "passes/left_out/method.c": "int left_out_method;\n",
    "passes/shared/module.c": "int shared;\n",
    "tests/golden/a.exr": "picture",
    "tests/golden/golden.c": "int golden;\n",
    "build/libtyndall-core.a.p/core.c.o": "core",
    "build/passes/libtyndall-a.a.p/module.c.o": "a",
    "build/passes/libtyndall-a.a.p/method.c.o": "a method",
    "build/passes/libtyndall-a.a.p/gone.c.o": "of a source that is gone",
    "build/passes/libtyndall-b.a.p/module.c.o": "b",
    "build/passes/libtyndall-shared.a.p/module.c.o": "shared",
}
COMPILED = [path[len("build/"):] for path in FILES if path.endswith(".o") and "gone" not in path]


def write(root, path, text):
    os.makedirs(os.path.dirname(os.path.join(root, path)), exist_ok=True)
    with open(os.path.join(root, path), "w", encoding="utf-8") as file:
        file.write(text)


def compiled(root, outputs):
    write(root, "build/compile_commands.json", json.dumps([{"output": output} for output in outputs]))


def full_runs(root, *arguments):
    run = subprocess.run([os.path.join(root, "tools/full_runs"), arguments[0], os.path.join(root, "build"), *arguments[1:]],
                         check=True, capture_output=True, text=True)
    return run.stdout


def kept(root):
    return full_runs(root, "--kept").split()


def pass_tests(root, tests, before=None):
    """Notes a run of the tests, [suites, result] each."""
    lines = (json.dumps({"name": f"tyndall:{suites} / test", "result": result}) for suites, result in tests)
    write(root, "build/meson-logs/testlog.json", "\n".join(lines) + "\n")
    full_runs(root, "--done", before or full_runs(root, "--hashes"))


def main():
    with tempfile.TemporaryDirectory() as root:
        os.makedirs(os.path.join(root, "tests"))
        os.makedirs(os.path.join(root, "tools"))
        shutil.copy(sys.argv[1], os.path.join(root, "tools"))
        for path, text in FILES.items():
            write(root, path, text)
        compiled(root, COMPILED)
        assert kept(root) == [], "nothing has run yet"
        pass_tests(root, [["accuracy+full-a", "OK"], ["stress+full-a", "FAIL"], ["accuracy+full-b", "OK"], ["unit", "OK"]])
        assert kept(root) == ["full-b"], "a test of a failed"
        pass_tests(root, [["accuracy+full-a", "OK"], ["stress+full-a", "SKIP"]])
        assert kept(root) == ["full-b"], "a test of a was skipped"
        pass_tests(root, [["accuracy+full-a", "OK"], ["stress+full-a", "OK"]])
        assert kept(root) == ["full-a", "full-b"], "both have passed"
        start = full_runs(root, "--hashes")
        write(root, "build/passes/libtyndall-b.a.p/module.c.o", "changed")
        pass_tests(root, [["accuracy+full-b", "OK"]], start)
        assert kept(root) == ["full-a"], "b was changed while its tests ran"
        write(root, "build/passes/libtyndall-b.a.p/module.c.o", FILES["build/passes/libtyndall-b.a.p/module.c.o"])
        # Sources count by their objects alone, tests and their options by their text, golden pictures by their bytes.
        for path, left in {
            "engine/include/tyndall/pass.h": ["full-a", "full-b"], "shaders/light/sky.glsl": ["full-a", "full-b"], "passes/a/method.c": ["full-a", "full-b"],
            "build/libtyndall-core.a.p/core.c.o": ["full-a", "full-b"], "build/passes/libtyndall-a.a.p/gone.c.o": ["full-a", "full-b"],
            "build/passes/libtyndall-a.a.p/method.c.o": ["full-b"], "build/passes/libtyndall-b.a.p/module.c.o": ["full-a"],
            "build/passes/libtyndall-shared.a.p/module.c.o": [], "passes/a/tests/accuracy/a.c": ["full-b"], "passes/b/meson.build": ["full-a"],
            "tests/golden/a.exr": ["full-b"], "tests/golden/golden.c": [],
        }.items():
            write(root, path, FILES[path] + "int more;\n")
            assert kept(root) == left, f"{path}: {kept(root)} are kept"
            write(root, path, FILES[path])
        write(root, "passes/a/tests/accuracy/a.c", "// a word\nint  test;\n")
        assert kept(root) == ["full-a", "full-b"], "a comment and spaces of a test count"
        write(root, "build/passes/libtyndall-a.a.p/more.c.o", "more")
        compiled(root, COMPILED + ["passes/libtyndall-a.a.p/more.c.o"])
        assert kept(root) == ["full-b"], "an object more"


main()
