#!/usr/bin/env python3
"""altered.py -- that recompute.py sees what is altered in a report.

usage: altered.py REPORT.json

Each alteration below flatters, hides or removes something that follows from runs. Exit 1 and a line for each unseen.
"""
import copy
import json
import sys

import recompute


def each(report, path):
    """The objects at a path of members: lists are all of their elements, `times` all of its times, and None is passed over."""
    found = [report]
    for name in path.split("."):
        found = [o[name] for o in found if o.get(name) is not None]
        found = [e for o in found for e in (o if isinstance(o, list) else o.values() if name == "times" else [o])]
    return found


def put(path, name, value):
    """Sets a member of all objects at a path; a function makes it from what was there."""
    def alter(report):
        for o in each(report, path):
            if o.get(name) is not None:
                o[name] = value(o[name]) if callable(value) else copy.deepcopy(value)
    return alter


def drop(path, name):
    return lambda report: [o.pop(name, None) for o in each(report, path)]


def keep(name, wanted):
    return lambda report: report.update({name: [e for e in report[name] if wanted(e)]})


flip, twice = lambda value: not value, lambda value: 2 * value
ALTERATIONS = {
    "promises hold": put("scenes.promise", "holds", True),
    "promises hold at other times": put("scenes.times.promise", "holds", True),
    "promises begin later": put("scenes.promise", "above", 1),
    "no promises": put("scenes", "promise", None),
    "other verdicts": put("scenes", "verdicts", ["pop is on the front at all errors"]),
    "other verdicts at other times": put("scenes.times", "verdicts", []),
    "other ranges": put("scenes", "ranges", [{"block": 8, "method": "pop", "low": None, "high": None}]),
    "no ranges": drop("scenes.times", "ranges"),
    "noise of references": put("scenes.reference.noise", "n", 0.001),
    "a reference that is said to be stored": put("scenes.reference", "stored", flip),
    "no scene is missing in a headline": put("headline", "missing", []),
    "no scene is missing in a preset": put("presets", "missing", []),
    "other reasons in headlines": put("headline", "missing", lambda m: [t.split(":")[0] + ": too dark" for t in m]),
    "other reasons in presets": put("presets", "missing", lambda m: [t.split(":")[0] + ": too dark" for t in m]),
    "no why": put("scenes.equal_error", "why", None),
    "no why at other times": put("scenes.times.equal_error", "why", None),
    "no floors": drop("scenes", "floors"),
    "no floors at other times": put("scenes.times", "floors", []),
    "vague floors": put("scenes.floors", "vague", flip),
    "vague errors": put("scenes.runs.errors", "vague", flip),
    "no headline": lambda report: report.pop("headline"),
    "one headline less": lambda report: report["headline"].pop(),
    "a headline more": lambda report: report["headline"].append({**report["headline"][0], "method": "magic"}),
    "presets of one method": keep("presets", lambda p: p["method"] == "pop"),
    "presets of one time": keep("presets", lambda p: p["frame"] == "animated_light"),
    "more scenes in means": put("presets", "scenes", twice),
    "smaller errors of presets": put("presets", "error", lambda e: 0.8 * e),
    "larger means": put("headline", "geometric_mean", twice),
    "nothing extrapolated": put("presets", "extrapolated", 0),
    "other raw errors": put("scenes.runs.errors", "rel_l1", 9),
    "smaller errors": put("scenes.runs.errors", "error", lambda e: 0.5 * e),
    "an error of a picture that is not finite": put("scenes.runs.errors", "nan", 1),
    "other fronts": put("scenes.fronts", "runs", lambda keys: keys[1:]),
    "slower baselines": put("scenes.equal_error", "baseline_ms", twice),
    "slower baselines of runs": put("scenes.runs.equal_error", "baseline_ms", twice),
    "worse baselines at equal time": put("scenes.runs.equal_error", "baseline_error", twice),
    "measured, not extrapolated": put("scenes.equal_error", "measured", True),
    "other runs at an error": put("scenes.equal_error", "run", "0"),
    "no comparisons of runs": put("scenes.runs", "equal_error", []),
    "other pictures shown": put("scenes.runs", "shown", flip),
}


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        stored = json.load(file)
    unseen = []
    for name, alter in ALTERATIONS.items():
        report = copy.deepcopy(stored)
        alter(report)
        assert report != stored, name
        recompute.failures.clear()
        recompute.check(report)
        if not recompute.failures:
            unseen.append(f"unseen: {name}")
    print("\n".join(unseen))
    sys.exit(bool(unseen))


if __name__ == "__main__":
    main()
