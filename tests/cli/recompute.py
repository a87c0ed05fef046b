#!/usr/bin/env python3
"""recompute.py -- what a report says of its runs, computed again from their errors and times alone.

usage: recompute.py REPORT.json...

Shares no code with the bench: fronts, floors, times at equal error against the fastest baseline, and the means over
scenes (docs/report-schema.md). Exit 1 and a line for each figure that differs.
"""
import json
import math
import sys

FRAMES = ["first_picture", "animated_medium", "animated_light", "camera_moved"]
ASKED = {False: [0.10, 0.05, 0.03], True: [0.05, 0.02, 0.01]}  # by whether it is FLIP
failures = []


def differ(where, said, computed):
    failures.append(f"{where}: the report has {said}, its runs give {computed}")


def same(a, b, tolerance=2e-5):
    if isinstance(a, float) and isinstance(b, float) and not math.isfinite(a) and not math.isfinite(b):
        return True
    if a is None or b is None or isinstance(a, (str, bool)) or isinstance(b, (str, bool)):
        return a == b
    return abs(a - b) <= tolerance * max(abs(a), abs(b), 1e-30)


class Point:
    """A run in the plane of error and time; what the noise of the reference hides stands at it."""

    def __init__(self, run, error, ms):
        noise = error.get("n") or 0
        self.run, self.ms = run, ms
        self.bound, self.vague = error["error"] < noise, max(error["error"], noise) < 2 * noise
        self.error = max(error["error"], noise)


def points_of(runs, measure, frame):
    points = []
    for run in runs:
        if run["failed"]:
            continue
        error, ms = run["errors"][measure], run["frame_ms"].get(frame)
        if error["error"] is not None and not error.get("nan") and ms is not None and ms > 0:
            points.append(Point(run, error, ms))
    return points


def envelope(points):
    kept = []
    for p in sorted(points, key=lambda p: (p.ms, p.error)):
        if not kept or p.error < kept[-1].error:
            kept.append(p)
    return kept


def time_by_samples(curve, error):
    """(ms, measured): noise falls as 1 / sqrt(time) beyond the points, log-log between them."""
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


def best_baseline(points, error):
    """(ms, measured, group) of the fastest; what was measured is not beaten by what is extrapolated."""
    best = (None, False, None)
    for group in dict.fromkeys(p.run["group"] for p in points if p.run["baseline"]):
        ms, measured = time_by_samples(envelope([p for p in points if p.run["group"] == group]), error)
        if ms is not None and (best[0] is None or (ms < best[0] if measured == best[1] else measured)):
            best = (ms, measured, group)
    return best


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


def best_error(points, ms):
    best = (None, False)
    for group in dict.fromkeys(p.run["group"] for p in points if p.run["baseline"]):
        error, measured = error_by_samples(envelope([p for p in points if p.run["group"] == group]), ms)
        if error is not None and (best[0] is None or (error < best[0] if measured == best[1] else measured)):
            best = (error, measured)
    return best


def own_time(points, group, error):
    there = [p.ms for p in points if p.run["group"] == group and p.error <= error]
    return min(there) if there else None


def equal_errors(runs, measure, block, noise, frame):
    """{(block, error, method): figures}."""
    points, found = points_of(runs, measure, frame), {}
    if not any(r["baseline"] for r in runs):
        return found
    for error in ASKED[block == 0]:
        for group in dict.fromkeys(r["group"] for r in runs if not r["sampling"]):
            vague = error < 2 * noise
            ms = None if vague else own_time(points, group, error)
            base, measured, name = (None, False, None) if vague else best_baseline(points, error)
            speedup = base / ms if base is not None and ms is not None else None
            found[block, error, group] = {"ms": ms, "baseline_ms": base, "baseline": name, "measured": measured, "speedup": speedup}
    return found


def own_equal_errors(runs, measure, block, frame):
    """{(key of the run, block): figures} at the run's own error."""
    points, found = points_of(runs, measure, frame), {}
    for p in points:
        if p.run["sampling"] or p.run.get("equal_error", []) is None or not (frame == "animated_light" or p.run["preset"]) or not any(r["baseline"] for r in runs):
            continue
        base, measured, name = (None, False, None) if p.vague else best_baseline(points, p.error)
        found[p.run["key"], block] = {"baseline_ms": base, "baseline": name, "measured": measured,
                                      "speedup": None if base is None else base / p.ms}
        error, measured = best_error(points, p.ms)
        found[p.run["key"], block].update({"baseline_error": error, "error_measured": measured})
    return found


def geometric_mean(values):
    values = [v for v in values if v is not None and v > 0]
    return math.exp(sum(map(math.log, values)) / len(values)) if values else None


def compare(where, said, computed):
    for name, value in computed.items():
        if not same(said.get(name), value):
            differ(f"{where}, {name}", said.get(name), value)


def measures_of(scene):
    run = next(r for r in scene["runs"] if not r["failed"])
    return [(i, e["block"]) for i, e in enumerate(run["errors"])]


def noise_of(scene, measure):
    return max((r["errors"][measure].get("n") or 0 for r in scene["runs"] if not r["failed"]), default=0)


def check_peers(scene):
    """Renderers of others: their times beside those of the baselines and of the runs."""
    for peer in scene.get("peers") or []:
        for e in peer["equal_error"]:
            measure = next(i for i, b in measures_of(scene) if b == e["block"])
            points, error = points_of(scene["runs"], measure, "animated_light"), e["error"]
            own = envelope([p for p in points if p.run["group"] == peer["peer"]])
            vague = error < 2 * noise_of(scene, measure)
            ms, measured = (None, False) if vague else time_by_samples(own, error)
            base, base_measured, name = (None, False, None) if vague else best_baseline(points, error)
            compare(f"{scene['name']}, {peer['peer']}, block {e['block']}, {error}", e,
                    {"ms": ms, "measured": measured, "baseline_ms": base, "baseline_measured": base_measured, "baseline": name,
                     "method_ms": None if vague else own_time(points, e["method"], error)})


def check_scene(scene):
    check_peers(scene)
    runs = [r for r in scene["runs"] if not r.get("peer")]
    for frame in FRAMES:
        said = scene if frame == "animated_light" else scene["times"][frame]
        where = f"{scene['name']}, {frame}"
        listed = {(e["block"], e["error"], e["method"]): e for e in said["equal_error"]}
        for measure, block in measures_of(scene):
            points = points_of(runs, measure, frame)
            front = next(f for f in said["fronts"] if f["block"] == block)["runs"]
            if front != [p.run["key"] for p in envelope(points)]:
                differ(f"{where}, front of block {block}", front, [p.run["key"] for p in envelope(points)])
            for key, figures in equal_errors(runs, measure, block, noise_of(scene, measure), frame).items():
                found = next((e for k, e in listed.items() if k[0] == key[0] and k[2] == key[2] and same(k[1], key[1])), None)
                if found is None:
                    differ(f"{where}, {key}", "nothing", figures)
                else:
                    compare(f"{where}, {key}", found, figures)
            own = {(r["key"], e["block"]): e for r in runs for e in r.get("equal_error") or [] if e["frame"] == frame}
            for key, figures in own_equal_errors(runs, measure, block, frame).items():
                compare(f"{where}, run {key}", own.get(key, {}), figures)
            if frame == "animated_light" and measure == 0:
                for floor in scene["floors"]:
                    least = min(p.error for p in points if p.run["group"] == floor["method"])
                    compare(f"{where}, floor of {floor['method']}", floor, {"error": least})


def check_means(report):
    scenes = report["scenes"]
    for h in report["headline"]:
        values, extrapolated = [], 0
        for scene in scenes:
            measure = next(i for i, b in measures_of(scene) if b == h["block"])
            found = equal_errors(scene["runs"], measure, h["block"], noise_of(scene, measure), h["frame"])
            figures = next((f for k, f in found.items() if k[2] == h["method"] and same(k[1], h["error"])), None)
            if figures and figures["speedup"] is not None:
                values.append(figures["speedup"])
                extrapolated += not figures["measured"]
        compare(f"headline {h['frame']} {h['block']} {h['error']} {h['method']}", h,
                {"geometric_mean": geometric_mean(values), "scenes": len(values), "of": len(scenes), "extrapolated": extrapolated})
        if len(values) + len(h["missing"]) != len(scenes) and len(h["missing"]) > len(scenes):
            differ(f"headline {h['method']}", h["missing"], "fewer")
    for p in report["presets"]:
        values, errors, times, extrapolated = [], [], [], 0
        for scene in scenes:
            measure = next(i for i, b in measures_of(scene) if b == p["block"])
            run = next((r for r in scene["runs"] if (r["method"], r["preset"]) == (p["method"], p["preset"])), None)
            if run is None or run["failed"]:
                continue
            error = run["errors"][measure]
            errors.append(None if error["error"] is None else max(error["error"], error.get("n") or 0))
            times.append(run["frame_ms"].get(p["frame"]))
            figures = own_equal_errors(scene["runs"], measure, p["block"], p["frame"]).get((run["key"], p["block"]))
            if figures and figures["speedup"] is not None:
                values.append(figures["speedup"])
                extrapolated += not figures["measured"]
        compare(f"preset {p['preset']} {p['frame']} {p['block']}", p,
                {"geometric_mean": geometric_mean(values), "scenes": len(values), "of": len(scenes), "extrapolated": extrapolated,
                 "error": geometric_mean(errors), "ms": geometric_mean(times)})
        if len(values) + len(p["missing"]) != len(scenes):
            differ(f"preset {p['preset']}, missing", len(p["missing"]), len(scenes) - len(values))


def main():
    for path in sys.argv[1:]:
        with open(path, encoding="utf-8") as file:
            report = json.load(file)
        for scene in report["scenes"]:
            check_scene(scene)
        check_means(report)
    print("\n".join(failures))
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
