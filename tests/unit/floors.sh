#!/bin/sh
# floors.sh SOURCE_ROOT -- checks the layering of the tree from its #include lines, and that passes have tests.
#
# A module is a folder passes/MODULE with a module.c. It sees public headers, shaders/ and itself; of itself its passes see their
# own folders and common/; nobody sees modules. One without a method.c is shared: modules see its headers, their passes its common/.
#
# Floors, bottom to top: base < gpu, scene < io < graph < registry < frame < passes < methods/job < methods/light
# < methods/solve < methods/view < methods < tools, samples, tests. A file includes its own folder and lower floors only;
# passes do not include each other; what they share is in shaders/, which sees engine/scene, <tyndall/pass.h> and what else is
# plain data at most; tools and samples see nothing but <tyndall/...>, a plugin and their shaders what is in shaders/ as well;
# public headers include lower tiers only, those of <tyndall/extend/...> also what C and shaders share.
set -eu

# check ROOT: prints one line a fault; status 1 if there is any.
check()
(
    cd "$1"
    find engine passes shaders tools samples -type f \
        ! -path 'passes/*/tests/*' \( -name '*.[ch]' -o -name '*.cpp' -o -name '*.hpp' -o -name '*.comp' -o -name '*.vert' -o -name '*.frag' -o -name '*.glsl' \) \
        2>/dev/null | sort | xargs awk '
    function exists(path,   line, r) {
        if (!(path in seen)) {
            r = (getline line < path)
            close(path)
            seen[path] = r >= 0
        }
        return seen[path]
    }
    function plain(path) { # without "x/../"
        while (sub(/[^\/.]+\/\.\.\//, "", path)) { }
        return path
    }
    # Where the compiler would find it; "" = not ours (system, third party).
    function resolve(file, name, quoted,   dir, n, i, roots, base) {
        dir = file
        sub(/[^\/]*$/, "", dir)
        if (quoted && exists(dir name)) { return plain(dir name) }
        n = split("engine/include/ engine/ ./" (file ~ /^tools\// ? " tools/" : ""), roots, " ")
        for (i = 1; i <= n; i++) {
            if (exists(roots[i] name)) {
                sub(/^\.\//, "", roots[i])
                return roots[i] name
            }
        }
        if (name ~ /^passes\/[a-z_]+_tables\.h$/) { return dir name } # made by the build, as the next
        if (name == "tyndall/extend/calls.h") { return "engine/include/" name }
        if (name ~ /\.(comp|vert|frag)\.h$/ && exists(dir substr(name, 1, length(name) - 2))) {
            return dir name # made from the shader beside it
        }
        if (name ~ /\.comp\.h$/) { # or from one that is built more than once: x_build.comp.h from x.comp
            base = substr(name, 1, length(name) - 7)
            while (match(base, /_[a-z0-9]+$/)) {
                base = substr(base, 1, RSTART - 1)
                if (exists(dir base ".comp")) { return dir name }
            }
        }
        if (quoted && exists(dir name ".in")) { return dir name }
        for (i = 1; i <= n; i++) {
            if (quoted && exists(roots[i] name ".in")) { # made from it when the build is set up
                sub(/^\.\//, "", roots[i])
                return roots[i] name
            }
        }
        if (quoted && file ~ /^tools\// && exists("tools/" name ".in")) { return "tools/" name }
        return ""
    }
    # The folder that is one unit of the layering.
    function unit(path,   p, n) {
        n = split(path, p, "/")
        if (p[1] == "engine" && p[2] == "include") { return "public/" (p[4] == "extend" ? "extend/" : "") p[n] }
        if (p[1] == "passes" && exists("passes/" p[2] "/module.c")) {
            return "module/" p[2] (n > 3 ? "/" p[3] : "")
        }
        if (path ~ /^passes\/methods\/[a-z]+\//) { return "passes/methods/" p[3] }
        if (p[1] == "engine" || p[1] == "passes" || p[1] == "samples") { return p[1] "/" p[2] }
        return p[1]
    }
    function floor_of(u) {
        if (u in level) { return level[u] }
        if (u ~ /^passes\//) { return 3 }
        return u ~ /^samples\// ? 11 : -1
    }
    # A pass is a table for the graph: it sees no more than that does.
    function reach(u) { return floor_of(u) == 3 ? 2.1 : floor_of(u) }
    function shared(name) { return !exists("passes/" name "/method.c") }
    # Of a module and its parts "module/NAME", "module/NAME/PASS".
    function check_module(from, to, name,   f, t, part) {
        split(from, f, "/")
        split(to, t, "/")
        part = f[3] != ""
        if (to == "shaders") { return }
        if (to ~ /^public\//) {
            if (part && lowest[substr(to, 8)] > 2.1) { fault(from " is below <" name ">") }
        } else if (t[1] == "module" && t[2] != f[2] && shared(t[2]) && !shared(f[2])) {
            if (t[3] == "" ? part : t[3] != "common") { fault(from " does not see " name " of " to) }
        } else if (t[1] != "module" || t[2] != f[2]) {
            fault("a module sees public headers, shaders and itself, not " name)
        } else if (part && (f[3] == "common" || t[3] != "common")) {
            fault(from " does not see " name " of " to)
        }
    }
    function fault(text) {
        print FILENAME ":" FNR ": " text
        faults++
    }
    BEGIN {
        level["engine/base"] = 0
        level["engine/gpu"] = level["engine/scene"] = 1
        level["engine/io"] = 1.5
        level["engine/graph"] = 2
        level["engine/registry"] = 2.3
        level["engine/frame"] = 2.6
        level["passes/methods/job"] = 4
        level["passes/methods/light"] = 5
        level["passes/methods/solve"] = 6
        level["passes/methods/view"] = 7
        level["passes/methods"] = 8
        level["tools"] = 11
        # Lowest floor that may see a public header, and the tier of the header itself.
        lowest["base.h"] = 0
        lowest["device.h"] = lowest["scene.h"] = lowest["io.h"] = 1
        lowest["pass.h"] = 1 # pipelines are made from its tables
        lowest["registry.h"] = 2.3
        lowest["outputs.h"] = lowest["context.h"] = lowest["offline.h"] = lowest["light.glsl"] = 2.6
        lowest["extend/hash.h"] = 0
        lowest["extend/lattice_shape.h"] = lowest["extend/map_light.h"] = 1
        lowest["extend/graph.h"] = 2
        lowest["extend/method.h"] = lowest["extend/calls.h"] = lowest["extend/plugin.h"] = 2.3
        lowest["extend/refs.h"] = lowest["extend/frame_scene.h"] = lowest["extend/job.h"] = 2.6
        lowest["extend/path_scene.h"] = lowest["extend/dispatch_sizes.h"] = 4
        lowest["extend/sources.h"] = lowest["extend/limits.h"] = 5
        lowest["extend/field.h"] = 6
        lowest["extend/view.h"] = 7
        tier["base.h"] = 0
        tier["device.h"] = tier["scene.h"] = 1
        tier["io.h"] = tier["pass.h"] = tier["outputs.h"] = 2
        tier["context.h"] = 3
        tier["registry.h"] = 4
        tier["offline.h"] = 5
        tier["extend/hash.h"] = 0
        tier["extend/map_light.h"] = tier["extend/dispatch_sizes.h"] = 2
        tier["extend/lattice_shape.h"] = 3
        tier["extend/graph.h"] = 4
        tier["extend/refs.h"] = tier["extend/frame_scene.h"] = 5
        tier["extend/job.h"] = 6
        tier["extend/path_scene.h"] = 7
        tier["extend/sources.h"] = tier["extend/limits.h"] = 7
        tier["extend/field.h"] = 8
        tier["extend/view.h"] = 9
        tier["extend/method.h"] = 10
        tier["extend/calls.h"] = 11
        tier["extend/plugin.h"] = 12
    }
    /^[ \t]*#[ \t]*include[ \t]*["<]/ {
        quoted = /include[ \t]*"/
        name = $0
        sub(/^[^"<]*["<]/, "", name)
        sub(/[">].*$/, "", name)
        target = resolve(FILENAME, name, quoted)
        from = unit(FILENAME)
        if (target == "") {
            if (name ~ /^tyndall\// || (quoted && from != "engine/io")) { fault("no such header: " name) }
            next
        }
        to = unit(target)
        if (to ~ /^public\// && !(substr(to, 8) in lowest)) { fault("no floor is known for <" name ">") }
        if (from == to) { next }
        if (from ~ /^module\//) {
            check_module(from, to, name)
        } else if (to ~ /^module\//) {
            fault(name " belongs to a module, which nobody else sees")
        } else if (from ~ /^public\//) {
            a = tier[substr(from, 8)]
            b = to ~ /^public\// ? tier[substr(to, 8)] : from ~ /^public\/extend/ && to == "shaders" ? 0 : 99
            if (b >= a) { fault("a public header includes " name ", which is not of a lower tier") }
        } else if (from == "tools" || from ~ /^samples\//) {
            if (to == "shaders" && FILENAME ~ /\.(comp|vert|frag)$/) { next }
            if (to !~ /^public\// && !(from == "samples/plugin" && to == "shaders")) { fault(from " sees public headers only, not " name) }
        } else if (from == "shaders") {
            if (to != "engine/scene" && to !~ /^public\/(pass|scene|extend\/lattice_shape)\.h$/) { fault("shaders do not see " name) }
        } else if (floor_of(from) < 0) {
            fault("no floor is known for " from)
        } else if (to ~ /^public\//) {
            if (lowest[substr(to, 8)] > reach(from)) { fault(from " is below <" name ">") }
        } else if (to == "shaders") {
            if (floor_of(from) < 2 || from == "engine/registry") { fault(from " is below the shaders") }
        } else if (floor_of(from) == 3 && floor_of(to) == 3) {
            fault("passes do not include each other: " name)
        } else if (floor_of(to) < 0) {
            fault("no floor is known for " to)
        } else if (floor_of(to) >= reach(from)) {
            fault(from " includes " name " of " to ", which is not below it")
        }
    }
    END { exit faults > 0 }'
)

# passes_of ROOT: lines PASS FOLDER-OF-ITS-TEST MESON-FILE.
passes_of()
(
    cd "$1"
    for folder in passes/*/; do
        [ "$folder" != passes/methods/ ] || continue
        if [ -f "${folder}module.c" ]; then
            for part in "$folder"*/; do
                case $(basename "$part") in common | tests | '*') continue ;; esac
                echo "$(basename "$part") ${folder}tests/gpu ${folder}meson.build"
            done
        else
            echo "$(basename "$folder") tests/gpu tests/gpu/meson.build"
        fi
    done
)

# untested ROOT: prints a line for each pass that has no test of its own, PASS.c, or one that is not built; status 1 if there is
# any, or no pass at all.
untested()
(
    cd "$1"
    passes_of . | {
        passes=0
        faults=0
        while read -r pass folder build; do
            passes=$((passes + 1))
            if [ ! -f "$folder/$pass.c" ]; then
                echo "pass $pass has no test of its own, $folder/$pass.c"
                faults=$((faults + 1))
            elif ! grep -q "'$pass'" "$build"; then
                echo "$build does not build $pass.c"
                faults=$((faults + 1))
            fi
        done
        [ "$passes" -gt 0 ] && [ "$faults" = 0 ]
    }
)

# The checks must find what they are for: every line below is a fault, and nothing else is.
self=$(mktemp -d)
trap 'rm -rf "$self"' EXIT
mkdir -p "$self/engine/include/tyndall" "$self/engine/base" "$self/engine/gpu" "$self/engine/scene" \
    "$self/engine/graph" "$self/passes/a" "$self/passes/b" "$self/shaders/x" "$self/tools"
cd "$self"
for f in base device scene pass context; do : > engine/include/tyndall/$f.h; done
: > engine/base/half.h; : > engine/gpu/gpu.h; : > engine/scene/s.h; : > engine/graph/graph.h
: > passes/a/a.h; : > passes/b/b.h; : > shaders/x/args.h; : > passes/a/a_go.comp
printf '%s\n' '#include "gpu/gpu.h"' '#include <tyndall/device.h>' > engine/base/bad.c
printf '%s\n' '#include "scene/s.h"' '#include "graph/graph.h"' '#include "shaders/x/args.h"' > engine/gpu/bad.c
printf '%s\n' '#include "passes/b/b.h"' '#include "../b/b.h"' '#include <tyndall/context.h>' \
    '#include "none.h"' '#include "b_go.comp.h"' > passes/a/bad.c
printf '%s\n' '#include "context.h"' > engine/include/tyndall/scene.h
mkdir -p engine/include/tyndall/extend samples/plugin samples/embed
: > engine/include/tyndall/extend/job.h
printf '%s\n' '#include "job.h"' > engine/include/tyndall/extend/graph.h
printf '%s\n' '#include "../pass.h"' '#include "shaders/x/args.h"' > engine/include/tyndall/extend/refs.h
printf '%s\n' '#include "shaders/x/args.h"' '#include <tyndall/extend/job.h>' > samples/plugin/good.c
printf '%s\n' '#include "shaders/x/args.h"' > samples/embed/bad.c
printf '%s\n' '#include "base/half.h"' '#include <passes/a/a.h>' > tools/bad.c
printf '%s\n' '#include "passes/a/a.h"' > shaders/x/bad.glsl
printf '%s\n' '#include "scene/s.h"' '#include <tyndall/pass.h>' '#include "shaders/x/args.h"' > shaders/x/good.h
printf '%s\n' '#include "a.h"' '#include "a_go.comp.h"' '#include "shaders/x/args.h"' '#include <tyndall/pass.h>' \
    '#include "base/half.h"' '#include <math.h>' > passes/a/good.c
mkdir -p engine/frame engine/registry passes/methods/light passes/methods/view
: > engine/frame/f.h; : > passes/methods/light/l.h; : > passes/methods/view/v.h
printf '%s\n' '#include "passes/a/a.h"' '#include "passes/methods/light/l.h"' '#include "shaders/x/args.h"' > engine/frame/bad.c
printf '%s\n' '#include "frame/f.h"' > engine/registry/bad.c
printf '%s\n' '#include "frame/f.h"' > passes/b/bad.c
printf '%s\n' '#include "passes/methods/view/v.h"' > passes/methods/light/bad.c
printf '%s\n' '#include "passes/methods/light/l.h"' '#include "passes/a/a.h"' '#include "frame/f.h"' \
    '#include <tyndall/context.h>' > passes/methods/view/good.c
mkdir -p passes/m/one passes/m/two passes/m/common passes/m/tests/gpu passes/n
: > passes/m/module.c; : > passes/m/method.c; : > passes/n/module.c; : > passes/n/method.c; : > passes/n/n.h; : > passes/m/one/one.h; : > passes/m/common/args.h
: > engine/include/tyndall/extend/method.h
mkdir -p passes/s/common passes/s/three passes/s/tests/gpu
: > passes/s/module.c; : > passes/s/s.h; : > passes/s/common/args.h; : > passes/s/three/three.h; : > passes/s/tests/gpu/three.c
echo "['gpu', 'three', files('tests/gpu/three.c')]" > passes/s/meson.build
printf '%s\n' '#include "passes/n/n.h"' > passes/s/bad.c
printf '%s\n' '#include "one/one.h"' '#include "common/args.h"' '#include <tyndall/extend/method.h>' '#include "shaders/x/args.h"' \
    '#include "passes/s/s.h"' > passes/m/good.c
printf '%s\n' '#include "passes/a/a.h"' '#include "base/half.h"' '#include "passes/n/n.h"' '#include "passes/s/three/three.h"' > passes/m/bad.c
printf '%s\n' '#include "one.h"' '#include "../common/args.h"' '#include <tyndall/pass.h>' '#include "passes/s/common/args.h"' > passes/m/one/good.c
printf '%s\n' '#include "../one/one.h"' '#include <tyndall/extend/method.h>' '#include "passes/s/s.h"' > passes/m/two/bad.c
printf '%s\n' '#include "../one/one.h"' > passes/m/common/bad.glsl
printf '%s\n' '#include "passes/m/one/one.h"' > passes/methods/bad.c
printf '%s\n' '#include "engine/base/half.h"' > passes/m/tests/gpu/one.c
echo "['gpu', 'one', files('tests/gpu/one.c')]" > passes/m/meson.build
mkdir -p "$self/tests/gpu" "$self/passes/tested" "$self/passes/unbuilt"
: > tests/gpu/tested.c; : > tests/gpu/unbuilt.c; echo "'tested': [], 'barely': []" > tests/gpu/meson.build
cd - > /dev/null
status=0
found=$(check "$self") || status=$?
lines=$(printf '%s\n' "$found" | wc -l)
if [ "$status" = 0 ] || [ "$lines" != 31 ] || printf '%s\n' "$found" | grep -q 'good\.\|refs\.h'; then
    printf 'the check itself is broken: 31 faults expected, found %s:\n%s\n' "$lines" "$found"
    exit 1
fi
status=0
found=$(untested "$self") || status=$?
if [ "$status" = 0 ] || [ "$found" != "pass a has no test of its own, tests/gpu/a.c
pass b has no test of its own, tests/gpu/b.c
pass two has no test of its own, passes/m/tests/gpu/two.c
tests/gpu/meson.build does not build unbuilt.c" ]; then
    printf 'the check of tests itself is broken: it found\n%s\n' "$found"
    exit 1
fi

check "$1"
untested "$1"

# Every public header is compiled alone by the test beside this one.
for header in "$1"/engine/include/tyndall/*.h "$1"/engine/include/tyndall/extend/*.h; do
    name=${header#"$1"/engine/include/tyndall/}
    grep -q "'${name%.h}'" "$1/tests/unit/meson.build" || {
        echo "tests/unit/meson.build: $name is missing from public_headers"
        exit 1
    }
done
