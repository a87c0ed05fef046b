#!/usr/bin/env python3
"""presets.py -- do the presets lie on the front of what the settings reach? As geometric means over all scenes.

usage: presets.py REPORT.json

A preset is beaten by a run that is in all scenes with it, takes less than 0.95 of its time, and has no more than 1.01 times its
error over 8x8 pixels and over single ones: nobody waits for less. With normal and high only runs are compared of which the
imbalance is nowhere above 1.5 %: three sweeps have the same errors in less time, but 3 % of the light of clouds is not there yet.
Exit 1 and a line for each that is beaten.
"""
import json
import math
import sys

FRAME, FASTER, AS_NEAR, SOLVED = "animated_light", 0.95, 1.01, 0.015


def mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def main(path):
    with open(path, encoding="utf-8") as file:
        scenes = json.load(file)["scenes"]
    runs = {}
    for scene in scenes:
        for run in scene["runs"]:
            if run["failed"] or run["baseline"] or run["method"] != "pop":
                continue
            errors = {e["block"]: max(e["error"], e["n"] or 0) for e in run["errors"] if e["error"] is not None}
            times = run["frame_ms"].get(FRAME)
            if times and 8 in errors and 1 in errors:
                name = run["preset"] or json.dumps(run["settings"], sort_keys=True)
                solved = max(abs(v) for v in run["imbalance"]) <= SOLVED
                runs.setdefault(name, []).append((times, errors[8], errors[1], solved))
    runs = {name: values for name, values in runs.items() if len(values) == len(scenes)}
    means = {name: [mean(v) for v in list(zip(*values))[:3]] for name, values in runs.items()}
    solved = {name for name, values in runs.items() if all(v[3] for v in values)}
    beaten = 0
    for preset in ("draft", "normal", "high"):
        if preset not in means:
            sys.exit(f"{path}: '{preset}' is not measured in all {len(scenes)} scenes")
        ms, *errors = means[preset]
        print(f"{preset}: {ms:.0f} ms, {100 * errors[0]:.2f} % over 8x8 pixels, {100 * errors[1]:.2f} % over single ones")
        for name, (other_ms, *others) in means.items():
            if preset != "draft" and name not in solved:
                continue
            if other_ms < FASTER * ms and others[0] < AS_NEAR * errors[0] and others[1] < AS_NEAR * errors[1]:
                beaten += 1
                print(f"{preset} is beaten by {name}: {other_ms:.0f} ms, {100 * others[0]:.2f} and {100 * others[1]:.2f} %")
    return 1 if beaten else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
