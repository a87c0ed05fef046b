#!/usr/bin/env python3
"""totals.py TOTALS -- what tools/totals makes of a log of `meson test`."""
import json
import os
import subprocess
import sys
import tempfile

LOG = [
    ("tyndall:unit / half", "OK", "[  OK ] a\nnot skipped: this\n", ""),
    ("tyndall:accuracy / pop_walls", "OK", "todo: a door: light leaks\nskipped: slabs (no shared data: slabs.csv)\n", ""),
    ("tyndall:cli+cli-broken / page", "SKIP", "skipped: the page in a browser (no Chromium)\n", ""),
    ("tyndall:gpu / beam", "SKIP", "", ""),
    ("tyndall:gpu / hg", "OK", "", "todo: b: c\n"),
]
ALLOWED = """# what may be skipped
page: * (no Chromium*) -- it cannot be had everywhere
beam: *                -- no reason is said
"""
wrong = 0


def check(what, log, arguments, code, last, inside=(), apart=1, outside=()):
    global wrong
    with tempfile.TemporaryDirectory() as folder:
        os.makedirs(f"{folder}/build/meson-logs")
        with open(f"{folder}/build/meson-logs/testlog.json", "w", encoding="utf-8") as file:
            for at, (name, result, out, err) in enumerate(log):
                file.write(json.dumps({"name": name, "result": result, "stdout": out, "stderr": err, "starttime": 1000 + at * apart,
                                       "duration": 10 + at}) + "\n")
        with open(f"{folder}/allowed", "w", encoding="utf-8") as file:
            file.write(ALLOWED)
        run = subprocess.run([os.path.abspath(sys.argv[1]), *arguments, "build"], cwd=folder, capture_output=True, text=True)
    lines = run.stdout.splitlines()
    if run.returncode != code or lines[-2:] != last or any(line not in lines for line in inside) or any(line in lines for line in outside):
        print(f"FAILED: {what}: exit {run.returncode}\n{run.stdout}{run.stderr}")
        wrong += 1


check("everything is counted", LOG, [], 0, ["2 known failures", "3 passed, 0 failed, 3 skipped"],
      ["skipped: pop_walls: slabs (no shared data: slabs.csv)", "known failure: pop_walls: a door: light leaks",
       "known failure: hg: b: c", "skipped: beam: all cases (no reason given)"])
MAY = ["--may-be-skipped", "allowed"]
check("known failures of two builds are one", LOG[4:] * 2, [], 0, ["1 known failures", "2 passed, 0 failed, 0 skipped"])
check("data may not be missing", LOG, MAY, 1, ["2 known failures", "3 passed, 0 failed, 3 skipped"],
      ["may not be skipped (allowed): pop_walls: slabs (no shared data: slabs.csv)"])
check("where there are none they may", LOG, MAY + ["--without-data"], 0, ["2 known failures", "3 passed, 0 failed, 3 skipped"])
check("another reason may not", [("page", "SKIP", "skipped: the page in a browser (out of memory)", "")], MAY, 1,
      ["0 known failures", "0 passed, 0 failed, 1 skipped"])
check("a failure", LOG + [("x", "TIMEOUT", "", "")], [], 1, ["2 known failures", "3 passed, 1 failed, 3 skipped"],
      ["failed: x (TIMEOUT)"])
check("a step that broke", LOG, ["--failed-steps", "2"], 1, ["2 known failures", "3 passed, 2 failed, 3 skipped"])
LONG = "build: the tests took 20.0 minutes, more than 20: hg 14 s, beam 13 s, page 12 s, pop_walls 11 s, half 10 s"
check("tests that take long", LOG, [], 0, ["2 known failures", "3 passed, 0 failed, 3 skipped"], [LONG], apart=297)
check("tests that do not", LOG, [], 0, ["2 known failures", "3 passed, 0 failed, 3 skipped"], apart=296, outside=[LONG])
check("no test at all", [], [], 1, ["0 known failures", "0 passed, 0 failed, 0 skipped"])
print("all right" if not wrong else f"{wrong} failed")
sys.exit(1 if wrong else 0)
