#!/bin/sh
# plugin.sh -- samples/plugin, built in a clean folder by its own meson.build against an installed copy: its method and its
# pass are in info, graph, bench and pictures, with errors as measured; plugins that do not fit are refused with one line.
. "$(dirname "$0")/lib.sh"
build=$helpers/../..
scenes=$(cd "$scenes" && pwd)

DESTDIR=$work/installed meson install -C "$build" --no-rebuild >log 2>&1 || {
    cat log
    fail "meson install failed"
    finish
}
pc=$(dirname "$(find installed -name tyndall-plugin.pc)")
pc=$work/$pc
prefix=$work/installed$(sed -n 's/^prefix=//p' "$pc/tyndall-plugin.pc")
sed -i "s|^prefix=.*|prefix=$prefix|" "$pc"/*.pc
LD_LIBRARY_PATH=$(dirname "$pc")
export LD_LIBRARY_PATH PKG_CONFIG_PATH="$pc"
tool=$prefix/bin/tyndall
unset CC CXX

# ---- builds ----
cp -r "$prefix/share/tyndall/samples/plugin" sample
meson setup plugin sample --werror >log 2>&1 && ninja -C plugin >>log 2>&1 || {
    cat log
    fail "samples/plugin does not build"
    finish
}
mv plugin/diffusion.so .
exports=$(nm -D --defined-only diffusion.so | awk '{ print $3 }')
[ "$exports" = tyn_plugin_entry ] || fail "the plugin exports $exports"
nm -D --undefined-only diffusion.so | grep -q tyn_ && fail "the plugin needs symbols of the library"

# The plugin of the page, from its words alone: blocks of code whose first line names a file.
mkdir -p page/clear
awk '/^```/ { file = "" } file { print > file }
     last ~ /^```(c|glsl|meson)$/ && $2 ~ /^[a-z_\/]+\.[a-z]+$/ && $3 == "--" { file = "page/" $2; print > file }
     { last = $0 }' "$source/docs/writing-a-plugin.md"
meson setup page/build page >log 2>&1 && ninja -C page/build >>log 2>&1 || {
    cat log
    fail "the plugin of docs/writing-a-plugin.md does not build"
}

# ---- refused ----
flags="-std=c11 -Wall -Wextra -Wpedantic -Wno-missing-field-initializers -Werror -shared -fPIC $(pkg-config --cflags tyndall-plugin)"
cat >empty.c <<'C'
#include <tyndall/extend/plugin.h>
TYN_PLUGIN("empty", "nothing", NULL, NULL, NULL)
C
cp -r "$prefix/include" other
sed -i 's/^#define TYN_EXTEND_ABI .*/#define TYN_EXTEND_ABI 4000u/' other/tyndall/extend/plugin.h
cp -r "$prefix/include" longer
sed -i 's/^typedef struct tyn_field {/& int more;/' longer/tyndall/extend/field.h
# shellcheck disable=SC2086
{
    cc -Iother $flags empty.c -o abi.so || fail "abi.so"
    cc -Ilonger $flags empty.c -o layout.so || fail "layout.so"
    echo 'int nothing;' | cc -shared -fPIC -x c - -o symbol.so
    echo 'void nowhere(void); void f(void); void f(void) { nowhere(); }' | cc -shared -fPIC -x c - -o undefined.so
    cat >clash.c <<'C'
#include <tyndall/extend/plugin.h>
static const char *const passes[] = {"lattice", NULL};
static tyn_result declare(tyn_graph *g, const tyn_job *job)
{
    (void)job;
    return tyn_graph_status(g);
}
static const tyn_method pop = {
    .info = {.name = "pop", .summary = "another", .outputs = TYN_OUTPUT_RADIANCE}, .passes = passes, .declare = declare};
static const tyn_method *const methods[] = {&pop, NULL};
TYN_PLUGIN("clash", "a second pop", NULL, methods, NULL)
C
    cc $flags clash.c -o clash.so || fail "clash.so"
    # In C++ as well.
    cp empty.c empty.cpp
    c++ -std=c++17 ${flags#-std=c11} empty.cpp -o empty.so || fail "a plugin in C++17"
}
if command -v cmake >/dev/null; then
    mkdir cmake
    cat >cmake/CMakeLists.txt <<C
cmake_minimum_required(VERSION 3.16)
project(empty C)
find_package(Tyndall 0.1 REQUIRED)
add_library(empty MODULE $work/empty.c)
target_link_libraries(empty PRIVATE Tyndall::plugin)
C
    cmake -S cmake -B cmake/build -DCMAKE_PREFIX_PATH="$prefix" >log 2>&1 && cmake --build cmake/build >>log 2>&1 || {
        cat log
        fail "a plugin does not build by CMake"
    }
    works info --methods --plugin cmake/build/libempty.so
fi
cp diffusion.so copy.so
echo text >text.so
refuses 2 "with structs of other sizes than here" info --methods --plugin layout.so
refuses 2 "is built for ABI 4000 (Tyndall 0.1.0); this is ABI" info --methods --plugin abi.so
refuses 2 "has no symbol 'tyn_plugin_entry'" info --methods --plugin symbol.so
refuses 2 "undefined symbol: nowhere" info --methods --plugin undefined.so
refuses 2 "plugin 'clash.so': there is a method 'pop' already" info --methods --plugin clash.so
refuses 2 "plugin 'copy.so': there is a pass 'diffusion' already" info --methods --plugin diffusion.so --plugin copy.so
refuses 2 "plugin 'text.so' cannot be loaded" render "$scenes/cube.gltf" -o x.png --plugin text.so
refuses 2 "plugin 'nothere.so' cannot be loaded" render "$scenes/cube.gltf" -o x.png --plugin nothere.so
refuses 2 "there is no method 'diffusion'" graph "$scenes/cube.gltf" -m diffusion
refuses 2 "diffusion.sweeps' is '0'; it must be a whole number from 1 to 4096" \
    render "$scenes/cube.gltf" --plugin diffusion.so -m diffusion -D diffusion.sweeps=0 -o x.png
works info --methods --plugin empty.so --plugin ./empty.so

# ---- listed ----
works info --methods --plugin diffusion.so
grep -q "^diffusion .*(plugin diffusion)" out || fail "info --methods: $(cat out)"
grep -q "thick cells" out || fail "info --methods does not know its limits"
works info --passes --plugin=diffusion.so
grep -q -- "-D diffusion.sweeps=  1 to 4096, default 96" out && grep -q "^false_colour" out || fail "info --passes"
works info "$scenes/cube.gltf" --plugin diffusion.so
grep -q "^  diffusion " out || fail "info does not judge its method"
needs_device
works graph "$scenes/cube.gltf" --plugin diffusion.so -m diffusion -D false_colour.show=1
awk '/raymarch/ && !r { r = NR } /false_colour/ && !f { f = NR } END { exit !(r && f && r < f) }' out ||
    fail "graph: false_colour is not behind raymarch"
grep -q diffusion out || fail "graph without diffusion"
cat >suite.json <<'S'
{ "name": "plugin", "size": [16, 16], "reference_spp": 16, "block": 8, "frames": 3, "max_seconds": 5,
  "scenes": [{ "name": "cube", "scene": "cube.gltf" }],
  "runs": [{ "name": "mine", "method": "diffusion", "settings": { "diffusion.cells": 16 } }], "baselines": [{ "name": "path" }] }
S
run bench --suite suite.json --scenes "$scenes" --plugin diffusion.so
[ "$code" = 0 ] && grep -q "mine" out || fail "bench: exit $code: $(cat err)"

# ---- right ----
view="--size 64x64 -q"
# shellcheck disable=SC2086
{
    works render "$scenes/cube.gltf" $view -m path --spp 256 -o path.exr
    works render "$scenes/cube.gltf" $view --plugin diffusion.so -m diffusion -o cube.exr
    works render "$scenes/cube.gltf" $view -m single -o single.exr
    # Looked at through its whole depth, 4: the last of the colours from 0 to 4.
    works render "$scenes/cube.gltf" $view --camera side --plugin diffusion.so -m pop -D false_colour.show=1 -o false.exr
}
works compare cube.exr path.exr --block 8
near "$(value rel_l1)" 0.056 0.02 "diffusion against path, depth 4"
works compare single.exr path.exr --block 8
near "$(value rel_l1)" 0.56 0.2 "single against path, depth 4"
# The page's: e^-4, twice as bright.
works render "$scenes/cube.gltf" --size 64x64 -q --camera side --plugin page/build/clear.so -D clear.show=1 -D clear.strength=2 -o clear.exr
"$helpers/exr_make" grey.exr 64 64 R=0.036631 G=0.036631 B=0.036631 || fail exr_make
works compare clear.exr grey.exr --block 8
near "$(value rel_l1)" 0 0.001 "the page's plugin"
"$helpers/exr_make" last.exr 64 64 R=0.983 G=0.799 B=0.018 || fail exr_make
works compare false.exr last.exr --block 8
near "$(value rel_l1)" 0 0.01 "colours of an optical depth of 4 of 4"

# ---- on the screen ----
if "$tool" view --help >/dev/null 2>&1; then
    VIEW_PLUGIN=$work/diffusion.so VIEW_TESTS=test_plugin "$source/tests/view/view.py" "$tool" "$scenes" "$helpers" >view.log 2>&1
    code=$?
    [ "$code" = 77 ] && grep skipped view.log
    [ "$code" = 0 ] || [ "$code" = 77 ] || fail "the viewer with a plugin: $(cat view.log)"
fi

# ---- a host with the library inside it ----
cc -std=c11 -Wall -Werror -o host "$source/tests/cli/plugin_host.c" -I"$prefix/include" "$build/libtyndall-core.a" -lm -ldl -lpthread ||
    fail "a static host does not build"
LD_LIBRARY_PATH='' ./host "$work/diffusion.so" >out 2>err
code=$?
cat out
[ "$code" = 3 ] && echo "skipped: static host (no device that validates)"
[ "$code" = 0 ] || [ "$code" = 3 ] || fail "the static host: exit $code: $(cat err)"
finish
