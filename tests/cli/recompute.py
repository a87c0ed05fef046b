#!/usr/bin/env python3
"""recompute.py -- what a report says of its runs, computed again from their errors and times alone.

usage: recompute.py [--stored] REPORT.json...

Shares no code with the bench. All that docs/report-schema.md says to follow from runs is made anew and must be there,
whole and with the same figures and words: errors without noise, fronts, floors, ranges, verdicts, promises, times at
equal error, means over scenes and why scenes are not in them. What a report lacks differs as what it has wrong does.
Of a reference that is stored with the suite, its samples and seconds are those of the file; --stored: every reference
that is there must have been used. Exit 1 and a line for each difference.
"""
import json
import math
import os
import sys

FRAMES = ["first_picture", "animated_medium", "animated_light", "camera_moved"]
SUBJECT = "pop"  # of promises and peers
ERRORS, FLIPS, PEER_ERRORS = [0.10, 0.05, 0.03], [0.05, 0.02, 0.01], [0.10, 0.05, 0.02]  # that times are told at
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
failures = []


def differ(where, said, computed):
    failures.append(f"{where}: the report has {str(said)[:200]}, its runs give {str(computed)[:200]}")


def same(a, b):
    if isinstance(a, bool) or isinstance(b, bool) or not isinstance(a, (int, float)) or not isinstance(b, (int, float)):
        return a == b
    return abs(a - b) <= 2e-5 * max(abs(a), abs(b), 1e-30)


def compare(where, said, computed):
    """All members of an object."""
    said = said if isinstance(said, dict) else {}
    for name, value in computed.items():
        if name not in said or not same(said[name], value):
            differ(f"{where}, {name}", said.get(name, "nothing"), value)


def compare_lists(where, said, computed, names):
    """Objects that are told apart by the members `names`: each of the computed once in the report, and no other."""
    left = list(said or [])
    for entry in computed:
        found = [s for s in left if all(n in s and same(s[n], entry[n]) for n in names)]
        what = f"{where} {[entry[n] for n in names]}"
        if len(found) != 1:
            differ(what, f"{len(found)} of these", "one")
        for s in found:
            compare(what, s, entry)
            left.remove(s)
    if left:
        differ(where, [[s.get(n) for n in names] for s in left], "none of these")


# ---- points of error and time ------------------------------------------------------------------


class Point:
    """A run in the plane of error and time; what the noise of the reference hides stands at it."""

    def __init__(self, run, error, ms):
        noise = error["n"] or 0
        self.run, self.ms, self.group = run, ms, run["group"]
        self.bound = error["error"] < noise
        self.error = max(error["error"], noise)


class Plane:
    """The runs of a scene by one measure and one of their times."""

    def __init__(self, runs, measure, block, frame, noise):
        self.block, self.frame, self.noise = block, frame, noise
        self.groups = {r["group"]: r for r in runs}
        self.baselines = [g for g, r in self.groups.items() if r["baseline"]]
        self.own = [g for g, r in self.groups.items() if not r["sampling"]]
        self.points = []
        for run in runs:
            ms = None if run["failed"] else run["frame_ms"].get(frame)
            if ms and run["errors"][measure]["error"] is not None and not run["errors"][measure].get("nan"):
                self.points.append(Point(run, run["errors"][measure], ms))
        self.front = envelope(self.points)
        self.curves = {g: envelope([p for p in self.points if p.group == g]) for g in self.groups}

    def time(self, group, error):
        """(ms, measured) that a group takes to an error."""
        curve = self.curves[group]
        if not curve or error <= 0:
            return None, False
        if self.groups[group]["sampling"]:
            return time_by_samples(curve, error)
        there = [p.ms for p in curve if p.error <= error]
        return (min(there), True) if there else (None, False)

    def best_baseline(self, error):
        """(ms, measured, group) of the fastest, whether it was measured there or is extrapolated."""
        times = [(*self.time(g, error), g) for g in self.baselines]
        return min((t for t in times if t[0] is not None), key=lambda t: t[0], default=(None, False, None))

    def best_error(self, ms):
        """(error, measured) of the best baseline after a time."""
        errors = [error_by_samples(self.curves[g], ms) for g in self.baselines]
        return min((e for e in errors if e[0] is not None), key=lambda e: e[0], default=(None, False))

    def is_vague(self, error):
        return error < 2 * self.noise

    def least(self, group):
        return min((p.error for p in self.curves[group]), default=None)


def envelope(points):
    kept = []
    for p in sorted(points, key=lambda p: (p.ms, p.error)):
        if not kept or p.error < kept[-1].error:
            kept.append(p)
    return kept


def time_by_samples(curve, error):
    """Noise falls as 1 / sqrt(time) beyond the points, log-log between them."""
    rule = lambda p: p.ms * (p.error / error) ** 2
    if error > curve[0].error:
        return rule(curve[0]), False
    for i, b in enumerate(curve):
        if b.error > error:
            continue
        if i == 0 or b.error == error:
            return b.ms, True
        a = curve[i - 1]
        if b.bound:
            return min(rule(a), b.ms), True
        share = math.log(a.error / error) / math.log(a.error / b.error)
        return a.ms * (b.ms / a.ms) ** share, True
    return (None, False) if curve[-1].bound else (rule(curve[-1]), False)


def error_by_samples(curve, ms):
    """(error, measured) after a time."""
    before = [i for i, p in enumerate(curve) if p.ms <= ms]
    if not before:
        return None, False
    a = curve[before[-1]]
    if before[-1] + 1 < len(curve):
        b = curve[before[-1] + 1]
        return a.error * (b.error / a.error) ** (math.log(ms / a.ms) / math.log(b.ms / a.ms)), True
    return (a.error, True) if a.ms == ms else (None, False) if a.bound else (a.error * math.sqrt(a.ms / ms), False)


# ---- times at equal error ----------------------------------------------------------------------


def percent(error):
    return f"{100 * error:.{2 if error < 0.01 else 1 if error < 0.1 else 0}f} %"


def why_vague(plane, error):
    return f"the noise of its reference, {percent(plane.noise)}, is more than half of this" if plane.is_vague(error) else None


def comparison(plane, ms, error):
    """A time of a method against the baselines at an error."""
    base, measured, name = (None, False, None) if plane.is_vague(error) else plane.best_baseline(error)
    return {"frame": plane.frame, "block": plane.block, "baseline": name, "baseline_ms": base, "measured": measured,
            "speedup": base / ms if base is not None and ms is not None else None}


def equal_errors(plane):
    found = []
    for error in (ERRORS if plane.block else FLIPS) if plane.baselines else []:
        for group in plane.own:
            ms = None if plane.is_vague(error) else plane.time(group, error)[0]
            run = next((p.run["key"] for p in plane.curves[group] if p.ms == ms), None)
            found.append({"error": error, "method": group, "ms": ms, "run": run, "why": why_vague(plane, error), **comparison(plane, ms, error)})
    return found


def own_equal_errors(plane):
    """{key of a run: what a baseline takes to its error, and has after its time}."""
    found = {}
    for p in plane.points if plane.baselines else []:
        if not p.run["sampling"] and (plane.frame == "animated_light" or p.run["preset"]):
            error, measured = plane.best_error(p.ms)
            found[p.run["key"]] = {**comparison(plane, p.ms, p.error), "baseline_error": error, "error_measured": measured}
    return found


def peer_times(plane, peer):
    for error in PEER_ERRORS:
        vague = plane.is_vague(error)
        ms, measured = (None, False) if vague else plane.time(peer, error)
        base, base_measured, name = (None, False, None) if vague else plane.best_baseline(error)
        yield {"block": plane.block, "error": error, "ms": ms, "measured": measured, "baseline": name, "baseline_ms": base,
               "baseline_measured": base_measured, "method": SUBJECT,
               "method_ms": None if vague or SUBJECT not in plane.groups else plane.time(SUBJECT, error)[0], "why": why_vague(plane, error)}


def floors(plane):
    return [{"block": plane.block, "method": g, "error": plane.least(g), "vague": plane.is_vague(plane.least(g))}
            for g in plane.own if plane.least(g) is not None]


# ---- who is fastest ----------------------------------------------------------------------------


def fastest(plane, error):
    """No group is faster than its fastest point, nor gets where it was not seen."""
    best, best_ms = None, math.inf
    for group, curve in plane.curves.items():
        ms, measured = plane.time(group, error)
        if ms is not None and not measured:
            ms = None if error < curve[-1].error else curve[0].ms
        if ms is not None and ms < best_ms:
            best, best_ms = group, ms
    return best


def ranges(plane):
    """[[group, low, high]] from small errors to large ones; None: no end."""
    if not plane.front:
        return []
    last = plane.front[-1]
    error = max(last.error, 1e-4) * (1 + 1e-6)
    high = max(plane.front[0].error * (1 + 1e-6), error)
    found = []
    while True:
        group = fastest(plane, error)
        if group is not None and (not found or group != found[-1][0]):
            if found:
                found[-1][2] = error
            found.append([group, error if found or last.bound else None, error])
        if error >= high:
            break
        error = min(1.01 * error, high)
    found[-1][2] = None
    sliver = lambda r: r[1] is not None and r[2] is not None and r[2] < 1.05 * r[1]
    kept = []
    for r in found:  # what is narrower than 5 % goes to the range below, the first to the one above
        if kept and (sliver(r) or kept[-1][0] == r[0]):
            kept[-1][2] = r[2]
        else:
            kept.append(r)
    if len(kept) > 1 and sliver(kept[0]):
        kept[1][1] = kept[0][1]
        del kept[0]
    return kept


def verdicts(plane, found):
    said = []
    for i, (group, low, high) in reversed(list(enumerate(found))):
        does = f"{group} is on the front" if group == SUBJECT else f"{group} wins"
        noise = ", the noise of the reference" if i == 0 and low is not None else ""
        if low is None and high is None:
            said.append(f"{does} at all errors")
        elif high is None:
            said.append(f"{does} above {percent(low)}{noise}")
        elif low is None:
            said.append(f"{does} below {percent(high)}")
        else:
            said.append(f"{does} from {percent(low)}{noise}{',' * bool(noise)} to {percent(high)}")
    if SUBJECT in plane.groups and found and all(r[0] != SUBJECT for r in found):
        said.append(f"{SUBJECT} is nowhere the fastest" + (f" above {percent(found[0][1])}" if found[0][1] is not None else ""))
    return said


def promise(plane, found):
    floor = plane.least(SUBJECT) if SUBJECT in plane.groups else None
    if floor is None:
        return None
    above, beaten = max(0.03, 1.2 * floor), []
    for group, low, high in found:
        low = max(low or 0, above)
        if group != SUBJECT and (high is None or high > 1.05 * low):
            beaten.append({"method": group, "low": low, "high": high})
    wins = [f"{b['method']} wins " + (f"above {percent(b['low'])}" if b["high"] is None else f"from {percent(b['low'])} to {percent(b['high'])}")
            for b in reversed(beaten)]
    text = f"{SUBJECT} is {'not ' * bool(beaten)}on the front at all errors above {percent(above)}{': ' * bool(beaten)}{'; '.join(wins)}"
    return {"block": plane.block, "method": SUBJECT, "floor": floor, "above": above, "holds": not beaten, "beaten": beaten, "text": text}


def is_shown(plane, run):
    """Whether a page should show its picture: what no sweep made, what is on the front, the best of each group."""
    own = next((p for p in plane.points if p.run is run), None)
    others = [(p.error, p.ms) for p in plane.curves[run["group"]]]
    return own is not None and (not run["swept"] or own in plane.front or (own.error, own.ms) <= min(others))


# ---- a scene -----------------------------------------------------------------------------------


class Scene:
    def __init__(self, scene):
        self.json, self.name = scene, scene["name"]
        self.all_runs = scene["runs"]
        self.runs = [r for r in scene["runs"] if not r.get("peer")]
        self.blocks = [n["block"] for n in scene["reference"]["noise"]]
        self.noise = {n["block"]: n["n"] for n in scene["reference"]["noise"]}
        self.planes = {(f, b): Plane(self.runs, i, b, f, self.noise[b] or 0) for f in FRAMES for i, b in enumerate(self.blocks)}
        self.equal = {f: [e for b in self.blocks for e in equal_errors(self.planes[f, b])] for f in FRAMES}
        self.own = {k: own_equal_errors(p) for k, p in self.planes.items()}


def check_errors(scene):
    for run in scene.all_runs:
        where = f"{scene.name}, {run['name']}"
        if run["failed"]:
            continue
        if [e["block"] for e in run["errors"]] != scene.blocks:
            differ(f"{where}, blocks", [e["block"] for e in run["errors"]], scene.blocks)
            continue
        known = not any(e.get("nan") for e in run["errors"])
        for e in run["errors"]:
            what, n = f"{where}, block {e['block']}", scene.noise[e["block"]]
            if not same(e["n"], n):
                differ(f"{what}, noise of the reference", n, e["n"])
            if not known or e["error"] is None:
                if e["error"] is not None or known:
                    differ(f"{what}, error", e["error"], "none" if not known else "a number")
                continue
            # The difference of squares loses digits where noise is most of it.
            if e["block"] and abs(e["error"] ** 2 - max(0, e["rel_l1"] ** 2 - (n or 0) ** 2)) > 1e-5 * e["rel_l1"] ** 2:
                differ(f"{what}, error", e["error"], f"sqrt({e['rel_l1']}^2 - {n}^2)")
            if ("vague" in e or not run.get("peer")) and e.get("vague") != (max(e["error"], n or 0) < 2 * (n or 0)):
                differ(f"{what}, vague", e.get("vague"), not e.get("vague"))


def stored_reference(scene, suite):
    """What the file of a stored reference tells in its attribute `comments`; None: there is none of this scene."""
    size = scene["size"]
    try:
        with open(f"{ROOT}/tools/bench/suites/{suite}.json", encoding="utf-8") as file:
            folder = json.load(file)["references"]
        with open(f"{ROOT}/tools/bench/suites/{folder}/{scene['slug']}-{size[0]}x{size[1]}.exr", "rb") as file:
            head = file.read(4096).decode("latin-1")
        said = json.JSONDecoder().raw_decode(head, head.index('{"schema":"tyndall-reference"'))[0]
    except (OSError, ValueError, KeyError):
        return None
    return said if said["scene"] == scene["hash"] else None


def check_reference(scene, suite, must_be_stored):
    said, reference = stored_reference(scene.json, suite), scene.json["reference"]
    if reference["stored"] != bool(said) and (reference["stored"] or must_be_stored):
        differ(f"{scene.name}, reference, stored", reference["stored"], bool(said))
    elif reference["stored"]:
        compare(f"{scene.name}, reference", reference, {name: said[name] for name in ("method", "spp", "seconds")})


def check_peers(scene):
    """Renderers of others: their times beside those of the baselines and of the runs."""
    groups = list(dict.fromkeys(r["group"] for r in scene.all_runs if r.get("peer")))
    listed = scene.json.get("peers") or []
    if [p["peer"] for p in listed] != groups:
        differ(f"{scene.name}, peers", [p["peer"] for p in listed], groups)
        return
    for peer in listed:
        planes = [Plane(scene.all_runs, i, b, "animated_light", scene.noise[b] or 0) for i, b in enumerate(scene.blocks) if b]
        compare_lists(f"{scene.name}, {peer['peer']}", peer["equal_error"], [e for p in planes for e in peer_times(p, peer["peer"])], ["block", "error"])


def check_frame(scene, frame):
    said = scene.json if frame == "animated_light" else scene.json["times"].get(frame, {})
    where = f"{scene.name}, {frame}"
    planes = [scene.planes[frame, b] for b in scene.blocks]
    compare_lists(f"{where}, front", said.get("fronts"), [{"block": p.block, "runs": [q.run["key"] for q in p.front]} for p in planes], ["block"])
    compare_lists(f"{where}, floor", said.get("floors"), [f for p in planes for f in floors(p)], ["block", "method"])
    compare_lists(f"{where}, equal error", said.get("equal_error"), scene.equal[frame], ["block", "error", "method"])
    found = ranges(planes[0])
    listed = [{"block": planes[0].block, "method": g, "low": low, "high": high} for g, low, high in found]
    if len(said.get("ranges") or []) != len(listed):
        differ(f"{where}, ranges", said.get("ranges"), listed)
    for i, (a, b) in enumerate(zip(said.get("ranges") or [], listed)):
        compare(f"{where}, range {i}", a, b)
    if said.get("verdicts") != verdicts(planes[0], found):
        differ(f"{where}, verdicts", said.get("verdicts"), verdicts(planes[0], found))
    check_promise(where, said.get("promise"), promise(planes[0], found))


def check_promise(where, said, computed):
    if not said or not computed:
        if said != computed:
            differ(f"{where}, promise", said, computed)
        return
    beaten = computed.pop("beaten")
    compare(f"{where}, promise", said, computed)
    compare_lists(f"{where}, promise, beaten by", said.get("beaten"), beaten, ["method", "low", "high"])


def check_runs(scene):
    for run in scene.runs:
        where = f"{scene.name}, {run['name']}"
        if run["failed"]:
            continue
        shown = is_shown(scene.planes["animated_light", scene.blocks[0]], run)
        if run["shown"] != shown:
            differ(f"{where}, shown", run["shown"], shown)
        if "equal_error" in run and run["equal_error"] is None and not shown and not run["preset"]:
            continue  # left away in a report that is kept
        computed = [own[run["key"]] for own in scene.own.values() if run["key"] in own]
        compare_lists(f"{where}, equal error", run.get("equal_error"), computed, ["frame", "block"])


# ---- over all scenes ---------------------------------------------------------------------------


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values)) if values else None


def why_unknown(run, frame, block):
    """Why a run has no part in a comparison; None: it has one."""
    if run["failed"]:
        return "it cannot do this scene"
    if any(e.get("nan") for e in run["errors"]):
        return "not finite"
    error = next((e["error"] for e in run["errors"] if e["block"] == block), None)
    return None if error is not None and run["frame_ms"].get(frame) else "not measured"


def why_no_speedup(scene, frame, block, group, entry):
    """Why a scene is not in the mean of a headline."""
    if entry and entry["why"]:
        return entry["why"]
    if not any(r["baseline"] for r in scene.runs):
        return "no baseline was measured"
    if entry and entry["ms"] is not None:
        return "no baseline is known to get there"
    least = scene.planes[frame, block].least(group) if group in scene.planes[frame, block].groups else None
    if least is not None:
        return f"its least error is {100 * least:.1f} %" if block else f"its least error is {least:.4f}"
    reasons = {why_unknown(r, frame, block) for r in scene.runs if r["group"] == group}
    return reasons.pop() if len(reasons) == 1 else "not measured"


def mean(entries, scenes, missing):
    return {"geometric_mean": geometric_mean([e["speedup"] for e in entries]), "scenes": len(entries), "of": len(scenes),
            "extrapolated": sum(not e["measured"] for e in entries), "missing": missing}


def headlines(scenes):
    for frame in FRAMES:
        for block, error, group in dict.fromkeys((e["block"], e["error"], e["method"]) for s in scenes for e in s.equal[frame]):
            entries, missing = [], []
            for s in scenes:
                entry = next((e for e in s.equal[frame] if (e["block"], e["error"], e["method"]) == (block, error, group)), None)
                if entry and entry["speedup"] is not None:
                    entries.append(entry)
                else:
                    missing.append(f"{s.name}: {why_no_speedup(s, frame, block, group, entry)}")
            yield {"frame": frame, "block": block, "error": error, "method": group, **mean(entries, scenes, missing)}


def preset_part(scene, run, frame, block):
    """(why a scene is not in the means of a preset, error, ms, comparison)."""
    why = why_unknown(run, frame, block) if run else "not measured"
    if why:
        return why, None, None, None
    error = next(e for e in run["errors"] if e["block"] == block)
    entry = scene.own[frame, block].get(run["key"])
    if entry is None:
        why = "no baseline was measured"
    elif entry["speedup"] is None:
        why = "the error is below twice the noise of its reference" if error["error"] < 2 * (error["n"] or 0) else "no baseline is known to get there"
    return why, error["error"], run["frame_ms"][frame], entry


def preset_means(scenes):
    presets = dict.fromkeys((r["method"], r["preset"]) for s in scenes for r in s.runs if r["preset"])
    for method, preset in presets:
        for frame in FRAMES:
            for block in dict.fromkeys(b for s in scenes for b in s.blocks):
                parts, missing = [], []
                for s in scenes:
                    run = next((r for r in s.runs if (r["method"], r["preset"]) == (method, preset)), None)
                    why, *part = preset_part(s, run, frame, block)
                    if why:
                        missing.append(f"{s.name}: {why}")
                    else:
                        parts.append(part)
                yield {"frame": frame, "block": block, "method": method, "preset": preset, "error": geometric_mean([p[0] for p in parts]),
                       "ms": geometric_mean([p[1] for p in parts]), **mean([p[2] for p in parts], scenes, missing)}


def check(report, must_be_stored=False):
    scenes = [Scene(s) for s in report["scenes"]]
    for scene in scenes:
        check_errors(scene)
        check_reference(scene, report["suite"]["name"], must_be_stored)
        check_peers(scene)
        check_runs(scene)
        for frame in FRAMES:
            check_frame(scene, frame)
    compare_lists("headline", report.get("headline"), list(headlines(scenes)), ["frame", "block", "error", "method"])
    compare_lists("presets", report.get("presets"), list(preset_means(scenes)), ["frame", "block", "method", "preset"])


def main():
    stored = sys.argv[1] == "--stored"
    for path in sys.argv[1 + stored:]:
        with open(path, encoding="utf-8") as file:
            check(json.load(file), stored)
    print("\n".join(failures))
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
