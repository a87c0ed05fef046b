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
    "engine/include/tyndall/extend/job.h": "int job;\n",
    "engine/include/tyndall/scene.h": "int scene;\n",
    "shaders/light/sky.glsl": "float sky;\n",
    "passes/medium/medium.c": "int medium;\n",
    "passes/a/module.c": "int a;\n",
    "passes/a/method.c": "int a_method;\n",
    "passes/a/tests/accuracy/a.c": "int test;\n",
    "passes/b/module.c": "int b;\n",
    "passes/b/method.c": "int b_method;\n",
    "passes/shared/module.c": "int shared;\n",
    "passes/b/b.comp": "float b;\n",
    "passes/b/meson.build": "b\n",
}


def write(root, path, text):
    os.makedirs(os.path.dirname(os.path.join(root, path)), exist_ok=True)
    with open(os.path.join(root, path), "w", encoding="utf-8") as file:
        file.write(text)


def kept(root):
    run = subprocess.run([os.path.join(root, "tools/full_runs"), "--kept"], check=True, capture_output=True, text=True)
    return run.stdout.split()


def hashes(root):
    return subprocess.run([os.path.join(root, "tools/full_runs"), "--hashes"], check=True, capture_output=True, text=True).stdout


def pass_tests(root, tests, before=None):
    """Notes a run of the tests, [suites, result] each."""
    lines = (json.dumps({"name": f"tyndall:{suites} / test", "result": result}) for suites, result in tests)
    write(root, "build/meson-logs/testlog.json", "\n".join(lines) + "\n")
    subprocess.run([os.path.join(root, "tools/full_runs"), "--done", os.path.join(root, "build"), before or hashes(root)], check=True, capture_output=True)


def main():
    with tempfile.TemporaryDirectory() as root:
        os.makedirs(os.path.join(root, "tests"))
        os.makedirs(os.path.join(root, "tools"))
        shutil.copy(sys.argv[1], os.path.join(root, "tools"))
        for path, text in FILES.items():
            write(root, path, text)
        assert kept(root) == [], "nothing has run yet"
        pass_tests(root, [["accuracy+full-a", "OK"], ["stress+full-a", "FAIL"], ["accuracy+full-b", "OK"], ["unit", "OK"]])
        assert kept(root) == ["full-b"], "a test of a failed"
        pass_tests(root, [["accuracy+full-a", "OK"], ["stress+full-a", "SKIP"]])
        assert kept(root) == ["full-b"], "a test of a was skipped"
        pass_tests(root, [["accuracy+full-a", "OK"], ["stress+full-a", "OK"]])
        assert kept(root) == ["full-a", "full-b"], "both have passed"
        start = hashes(root)
        write(root, "passes/b/b.comp", "float changed;\n")
        pass_tests(root, [["accuracy+full-b", "OK"]], start)
        assert kept(root) == ["full-a"], "b was changed while its tests ran"
        write(root, "passes/b/b.comp", FILES["passes/b/b.comp"])
        for path, left in {
            "engine/include/tyndall/pass.h": [], "engine/include/tyndall/scene.h": [], "engine/include/tyndall/extend/job.h": [], "shaders/light/sky.glsl": [],
            "passes/medium/medium.c": ["full-a", "full-b"], "passes/a/tests/accuracy/a.c": ["full-b"], "passes/b/b.comp": ["full-a"],
            "passes/shared/module.c": [], "passes/b/meson.build": ["full-a"],
        }.items():
            if not path.endswith("meson.build"):
                write(root, path, "// a word\n" + FILES[path].replace(" ", "  "))
            assert kept(root) == ["full-a", "full-b"], f"{path}: a comment and spaces count"
            write(root, path, FILES[path] + "int more;\n")
            assert kept(root) == left, f"{path}: {kept(root)} are kept"
            write(root, path, FILES[path])
        write(root, "shaders/light/more.glsl", "float more;\n")
        assert kept(root) == [], "a new shared shader"


main()
