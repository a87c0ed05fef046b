"""ages.py -- which kernels a stored table is of, and whether they have changed since.

A table depends on the passes of the frames that it measures. A pass is hashed by the text of its kernels and of all that they
include, without comments and spaces, so that a table grows old only with what is compiled. Files are found by name, wherever
they lie under passes/ and shaders/.
"""
import functools
import hashlib
import os
import re

PREAMBLE = "#version 460\n#extension GL_GOOGLE_include_directive : require\n" # of kernel.py, for shaders without a #version
SOURCES = ("passes", "shaders", "engine/include")
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+["<]([^">]+)[">]', re.M)
PASS = re.compile(r"\btyn_pass_desc tyn_pass_(\w+)")
EMBEDDED = re.compile(r'#include "(\w+)\.(comp|vert|frag)\.h"')
TABLES = re.compile(r'#include "passes/\w+_tables\.h"') # of all kernels in the folder, which the build makes
BUILDS = re.compile(r"'[\w/]*?(\w+\.comp)': *((?:modes|\{[^}]*\}| *\+ *)+)") # x.comp as x_<build>.comp, in meson.build
MODES = ("density", "coefficients")


class Kernels:
    """The kernels of a source tree, by the passes that embed them."""

    def __init__(self, root):
        self.root, self.texts, self.by_name, self.embedded, self.builds = root, {}, {}, {}, {}
        for top in SOURCES:
            for folder, _, names in os.walk(os.path.join(root, top)):
                for name in names:
                    self._find(os.path.relpath(os.path.join(folder, name), root))

    def _find(self, path):
        name, ending = os.path.splitext(os.path.basename(path))
        if ending in (".comp", ".vert", ".frag"):
            self.by_name[name + ending] = path
        elif ending == ".c":
            text = self._read(path)
            for name in PASS.findall(text):
                kernels = self.embedded.setdefault(name, set())
                kernels.update(name + "." + kind for name, kind in EMBEDDED.findall(text))
                kernels.update(self._in_folder(os.path.dirname(path)) if TABLES.search(text) else ())
        elif name == "meson":
            for kernel, builds in BUILDS.findall(self._read(path)):
                names = re.findall(r"'(\w+)': *\[", builds) + list(MODES if "modes" in builds else ())
                self.builds[kernel] = [kernel.replace(".", f"_{build}.") for build in names]

    def _in_folder(self, folder):
        """Kernels of a folder; their builds are filled in by hash_of."""
        return {name for name in os.listdir(os.path.join(self.root, folder)) if name.endswith(".comp")}

    def _read(self, path):
        with open(os.path.join(self.root, path), encoding="utf-8") as file:
            return file.read()

    def _text(self, path):
        """(what is compiled, what it includes)"""
        if path not in self.texts:
            text = COMMENT.sub(" ", self._read(path))
            if path.endswith((".comp", ".vert", ".frag")) and "#version" not in text:
                text = PREAMBLE + text
            lines = (" ".join(line.split()) for line in text.split("\n"))
            self.texts[path] = "\n".join(line for line in lines if line), INCLUDE.findall(text)
        return self.texts[path]

    def _closure(self, path, seen):
        if path in seen:
            return
        seen.add(path)
        for name in self._text(path)[1]:
            for folder in (os.path.dirname(path), "", "engine/include"):
                found = os.path.normpath(os.path.join(folder, name))
                if os.path.isfile(os.path.join(self.root, found)):
                    self._closure(found, seen)
                    break

    def _source(self, embedded):
        """The file of an embedded kernel: x_<build>.comp.h is a build of x.comp."""
        stem, ending = os.path.splitext(embedded)
        while stem:
            if stem + ending in self.by_name:
                return self.by_name[stem + ending]
            stem = stem.rpartition("_")[0]
        return None

    @functools.cache
    def hash_of(self, name):
        """Of a pass; None if there is no such pass."""
        if name not in self.embedded:
            return None
        sum_ = hashlib.sha256()
        kernels = [built for kernel in self.embedded[name] for built in self.builds.get(kernel, [kernel])]
        for kernel in sorted(kernels):
            source, seen = self._source(kernel), set()
            if source:
                self._closure(source, seen)
            parts = sorted((os.path.basename(path), self._text(path)[0]) for path in seen)
            sum_.update(repr((kernel, parts)).encode())
        return sum_.hexdigest()[:8]

    def hashes_of(self, names):
        return {name: self.hash_of(name) for name in sorted(names)}

    def changed(self, hashes):
        """The passes among `hashes` whose kernels are other ones now."""
        return [name for name, kept in hashes.items() if self.hash_of(name) != kept]
