#!/usr/bin/env python3
"""window.py EMBED-WINDOW SCENES -- samples/embed/window under Xvfb and the validation layers: what it shows is what its own image
holds; dragging, the wheel, another size and Escape. Exit 77: skipped, as something is missing.
"""
import os
import shutil
import subprocess
import sys
import tempfile
import time

from screen import Screen, difference, read_png

PROGRAM, SCENES = map(os.path.abspath, sys.argv[1:3])
WIDTH, HEIGHT = 640, 480
failures = []


def check(good, what):
    if not good:
        print("FAILED:", what, flush=True)
        failures.append(what)


class Window:
    def __init__(self, screen, *arguments):
        self.screen = screen
        self.log = open(os.path.join(screen.folder, "log"), "w+b")
        self.process = subprocess.Popen([PROGRAM, os.path.join(SCENES, "cube.gltf"), *arguments], stdout=self.log,
                                        stderr=subprocess.STDOUT, env=dict(screen.environment, HOST_VALIDATION="1"))

    def shown(self, other_than=None, seconds=60):
        """The screen when it shows something that does not change."""
        end, last = time.time() + seconds, None
        while time.time() < end and self.process.poll() is None:
            now = self.screen.shot(WIDTH, HEIGHT)
            if now == last and sum(now) > len(now) and (other_than is None or difference(now, other_than) > 1):
                return now
            last = now
            time.sleep(0.7)
        return last

    def ends(self, what):
        try:
            self.process.wait(60)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.log.seek(0)
        check(self.process.returncode == 0, f"{what}: exit {self.process.returncode}: {self.log.read().decode()[-800:]}")


def test_picture(screen):
    """The window's last image is what Tyndall left in the host's, to a step of 8 bits."""
    picture = os.path.join(screen.folder, "last.png")
    window = Window(screen, "100000", picture) # so many frames never come
    shown = window.shown()
    screen.do("key", "Escape")
    window.ends("picture")
    width, height, saved = read_png(picture)
    check((width, height) == (WIDTH, HEIGHT), f"the picture has {width}x{height}")
    most = max(abs(a - b) for a, b in zip(saved, shown))
    check(most <= 1, f"the window is {most} of 255 off the host's image")
    check(len(set(saved)) > 50, f"the picture has {len(set(saved))} values: it is flat")


def test_moves(screen):
    window = Window(screen)
    first = window.shown()
    screen.do("mousemove", 300, 200, "mousedown", 1, "mousemove", 400, 240, "mouseup", 1)
    turned = window.shown(other_than=first)
    check(difference(turned, first) > 1, "dragging does not turn the camera")
    screen.do("click", 4, "click", 4)
    near = window.shown(other_than=turned)
    check(difference(near, turned) > 1, "the wheel does not come nearer")
    found = subprocess.run(["xdotool", "search", "--name", "embed-window"], env=screen.environment, capture_output=True,
                           text=True, check=True).stdout.split()
    for size in [(200, 150), (333, 77), (WIDTH, HEIGHT)]:
        screen.do("windowsize", found[-1], *size)
        time.sleep(0.5)
    again = window.shown()
    check(difference(again, near) < 1, f"after other sizes the picture is {difference(again, near):.2f} off")
    screen.do("key", "Escape")
    window.ends("moves")


def main():
    if not shutil.which("Xvfb") or not shutil.which("xdotool"):
        print("skipped: all cases (Xvfb or xdotool is missing)")
        return 77
    for test in [test_picture, test_moves]:
        with tempfile.TemporaryDirectory() as work:
            screen = Screen(work)
            try:
                test(screen)
            finally:
                screen.close()
            print(f"{test.__name__} done", flush=True)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
