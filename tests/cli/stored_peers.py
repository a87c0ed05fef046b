#!/usr/bin/env python3
"""stored_peers.py -- whether what renderers of others were measured against is what a suite has now.

usage: stored_peers.py SUITE.json

Every scene of the suite's peers must be a scene of the suite, and the hash of its reference that of the stored one:
else a report leaves it out (docs/bench.md, "Peers"). Exit 1 and a line for each that is not.
"""
import json
import os
import re
import sys


def fnv1a(data):
    value = 0xCBF29CE484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return f"{value:016x}"


def faults(suite_path):
    with open(suite_path, encoding="utf-8") as file:
        suite = json.load(file)
    folder = os.path.dirname(suite_path)
    sizes = {s["name"]: s.get("size", suite.get("size")) for s in suite["scenes"]}
    for name in suite["peers"]:
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            peer = json.load(file)
        if not peer["scenes"]:
            yield f"{name}: no scene"
        for scene in peer["scenes"]:
            said, where = scene["reference"]["hash"], f"{name}: {scene['name']}"
            if scene["name"] not in sizes:
                yield f"{where}: the suite has no such scene"
                continue
            slug, size = re.sub("[^a-z0-9.]+", "-", scene["name"].lower()), sizes[scene["name"]]
            path = os.path.join(folder, suite["references"], f"{slug}-{size[0]}x{size[1]}.exr")
            if not os.path.exists(path):
                yield f"{where}: {path} is not there"
                continue
            with open(path, "rb") as file:
                found = fnv1a(file.read())
            if found != said:
                yield f"{where}: measured against {said}, {path} is {found}"


found = list(faults(sys.argv[1]))
print("\n".join(found))
sys.exit(bool(found))
