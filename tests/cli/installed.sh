#!/bin/sh
# installed.sh -- what `meson install` leaves works in a folder that the linker does not know: the tool finds its libraries,
# scenes and suites, a host in C builds by pkg-config and one in C++ by CMake, a kernel by the installed GLSL, manual pages and
# completions are well-formed.
#
# usage: installed.sh SOURCE BUILD
set -eu
source=$1
build=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() {
    echo "installed: $1" >&2
    exit 1
}
DESTDIR=$folder meson install -C "$build" --no-rebuild >"$folder/log" 2>&1 || {
    cat "$folder/log"
    fail "meson install failed"
}
prefix=$folder$(meson introspect "$build" --buildoptions |
    python3 -c 'import json, sys; print(next(o["value"] for o in json.load(sys.stdin) if o["name"] == "prefix"))')
pc=$(dirname "$(find "$folder" -name tyndall.pc)")
lib=$(dirname "$pc")
unset LD_LIBRARY_PATH
export PKG_CONFIG_PATH="$pc" PKG_CONFIG_SYSROOT_DIR="$folder"
tool=$prefix/bin/tyndall

# The tool, from another folder, without the build tree.
cd "$folder"
"$tool" --version || fail "the tool does not start"
for name in libtyndall libtyndall-io; do
    ldd "$tool" | grep -q "^[[:space:]]*$name\.so[.0-9]* => $folder/" || fail "the tool takes another $name: $(ldd "$tool")"
done
cat >suite.json <<'S'
{ "name": "installed", "size": [16, 16], "reference_spp": 16, "block": 8, "frames": 3, "max_seconds": 5,
  "scenes": [{ "name": "cube", "scene": "cube.gltf" }], "runs": [{ "name": "single", "method": "single" }],
  "baselines": [{ "name": "path" }] }
S
XDG_CACHE_HOME=$folder/cache "$tool" bench --suite suite.json >bench.txt || fail "tyndall bench exits $?"
grep -q single bench.txt || fail "tyndall bench did not measure"
[ -s "$prefix/share/tyndall/suites/full.json" ] || fail "no suites"
[ -s "$prefix/share/tyndall/references/cube-128x128.exr" ] || fail "no references"
[ -s "$prefix/share/doc/tyndall/LICENSE" ] || fail "no licence"

# Hosts.
cc -std=c11 -Wall -Werror -o host "$source/samples/embed/main.c" "$source/samples/embed/host.c" -D_GNU_SOURCE \
    $(pkg-config --cflags --libs tyndall-io) -lm -ldl || fail "samples/embed does not build by pkg-config"
LD_LIBRARY_PATH=$lib ./host "$prefix/share/tyndall/scenes/smoke.gltf" host.png >/dev/null || [ $? = 77 ] || fail "the host fails"
if command -v cmake >/dev/null; then
    mkdir cpp
    cat >cpp/CMakeLists.txt <<C
cmake_minimum_required(VERSION 3.16)
project(host C CXX)
set(CMAKE_CXX_STANDARD 17)
find_package(Tyndall 0.1 REQUIRED)
add_executable(host $source/samples/embed/main.cpp $source/samples/embed/host.c)
target_compile_definitions(host PRIVATE _GNU_SOURCE)
target_link_libraries(host PRIVATE Tyndall::io dl m)
C
    cmake -S cpp -B cpp/build -DCMAKE_PREFIX_PATH="$prefix" >cmake.log 2>&1 && cmake --build cpp/build >>cmake.log 2>&1 || {
        cat cmake.log
        fail "samples/embed does not build by CMake"
    }
    cpp/build/host cpp.png >/dev/null || [ $? = 77 ] || fail "the host in C++ fails"
fi

# A kernel of somebody else's.
cat >kernel.comp <<'G'
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/phase/hg.glsl"
layout(local_size_x = 1) in;
layout(binding = 0) buffer values { float value; };
void main() { value = hg(0.5, value); }
G
glslang=$(command -v glslang || command -v glslangValidator)
"$glslang" --quiet --target-env vulkan1.3 -V -I"$prefix/share/tyndall/glsl" kernel.comp -o kernel.spv ||
    fail "the installed GLSL does not compile"

# Pages and completions.
for page in tyndall tyndall-render tyndall-bench; do
    [ -s "$prefix/share/man/man1/$page.1" ] || fail "no manual page $page"
    if command -v groff >/dev/null; then
        groff -man -Tutf8 -ww "$prefix/share/man/man1/$page.1" 2>&1 >/dev/null | grep . && fail "$page.1 is not well-formed"
    fi
done
bash=$prefix/share/bash-completion/completions/tyndall
said=$(bash --norc -euc ". '$bash'" 2>&1) && [ -z "$said" ] || fail "bash does not take its completion: $said"
words=$(bash -c ". '$bash'; COMP_WORDS=(tyndall render --qual); COMP_CWORD=2; _tyndall; echo \"\${COMPREPLY[@]}\"")
[ "$words" = --quality ] || fail "bash completes --qual to '$words'"
words=$(bash -c ". '$bash'; COMP_WORDS=(tyndall render --quality d); COMP_CWORD=3; _tyndall; echo \"\${COMPREPLY[@]}\"")
[ "$words" = draft ] || fail "bash completes --quality d to '$words'"
words=$(bash -c ". '$bash'; COMP_WORDS=(tyndall be); COMP_CWORD=1; _tyndall; echo \"\${COMPREPLY[@]}\"")
[ "$words" = bench ] || fail "bash completes be to '$words'"
[ -s "$prefix/share/zsh/site-functions/_tyndall" ] && [ -s "$prefix/share/fish/vendor_completions.d/tyndall.fish" ] ||
    fail "no completions of zsh and fish"
echo "installed: all is there"
