#!/bin/sh
# files.sh -- what is no regular file, as an input and as an output; outputs that are each other or an input. No GPU.
. "$(dirname "$0")/lib.sh"

tool_path=$tool
tool=limited_tool
limited_tool() { timeout 20 "$tool_path" "$@"; }

# ---- inputs: refused, not waited for ----
: >none.vdb
limited_tool info none.vdb 2>err
grep -q "this build cannot read" err && vdb="" || vdb=vdb
cp "$scenes/cube.gltf" .
for extension in gltf glb vdb nvdb hdr exr png csv json raw bin; do
    mkfifo "fifo.$extension" || fail "mkfifo"
    mkdir "folder.$extension"
    ln -s /dev/zero "device.$extension"
done
scene() { # NAME MEDIUM: a scene of a box
    echo "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": [\"TYN_participating_media\"], \"scene\": 0,
        \"scenes\": [{\"nodes\": [0]}], \"nodes\": [{\"extensions\": {\"TYN_participating_media\": {\"medium\": 0, \"shape\": \"box\"}}}],
        \"extensions\": {\"TYN_participating_media\": {\"media\": [{$2}]}}}" >"$1"
}
buffer() { # NAME URI: a scene with a buffer
    echo "{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{\"byteLength\": 36, \"uri\": \"$2\"}], \"scene\": 0, \"scenes\": [{\"nodes\": [0]}],
        \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"nodes\": [{\"mesh\": 0}], \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}],
        \"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\", \"min\": [0, 0, 0], \"max\": [0, 0, 0]}]}" >"$1"
}
for kind in fifo folder device; do
    case $kind in fifo) is="is a FIFO" ;; folder) is="is a folder" ;; *) is="is a device" ;; esac
    for extension in gltf glb $vdb nvdb; do
        refuses 2 "$kind.$extension: $is: must be a regular file" info "$kind.$extension"
    done
    for extension in hdr exr; do
        refuses 2 "$is" info cube.gltf "$kind.$extension"
    done
    for extension in exr png; do
        refuses 2 "$is" compare "$kind.$extension" "$kind.$extension"
    done
    refuses 2 "$is" probe cube.gltf --points $kind.csv
    refuses 2 "$is" bench --suite $kind.json
    for extension in nvdb $vdb; do
        scene medium.gltf "\"density\": {\"uri\": \"$kind.$extension\"}"
        refuses 2 "$is" info medium.gltf
    done
    scene medium.gltf "\"density\": {\"uri\": \"$kind.raw\", \"size\": [2, 2, 2], \"type\": \"u8\"}"
    refuses 2 "$is" info medium.gltf
    buffer buffer.gltf $kind.bin
    refuses 2 "$kind.bin" info buffer.gltf
done

# ---- outputs that are none of ours: written to, not replaced ----
exr() { "$helpers/exr_make" "$@" || fail "exr_make $*"; }
exr a.exr 2 1 R=1,2 G=0,0 B=3,1
exr b.exr 2 1 R=1,1 G=0,2 B=2,1
is_png() { [ "$(head -c 4 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e47 ] || fail "$1 is no PNG: $2"; }
ln -s /dev/null null.png
works compare a.exr b.exr --heat null.png
[ -c null.png ] && [ -c /dev/null ] || fail "a device was replaced"
mkdir far
: >far/old.png
chmod 640 far/old.png
ln -s far/old.png link.png
ln -s link.png twice.png
ln -s far/new.png dangling.png
works compare a.exr b.exr --heat twice.png --flip-map dangling.png
[ -L link.png ] && [ -L twice.png ] && [ -L dangling.png ] || fail "a link was replaced"
is_png far/old.png "behind two links"
is_png far/new.png "behind a link that led nowhere"
(cat fifo.png >piped.png) &
works compare a.exr b.exr --heat fifo.png
wait
is_png piped.png "through a FIFO"
[ -p fifo.png ] || fail "a FIFO was replaced"
ln -s loop.png loop.png
refuses 1 "loop.png: cannot be written: Too many" compare a.exr b.exr --heat loop.png

# ---- outputs that are each other, or an input ----
cp a.exr c.exr
ln -s c.exr c-link.exr
refuses 2 "--heat 'h.png' and --flip-map './h.png' are the same file" compare a.exr b.exr --heat h.png --flip-map ./h.png
refuses 2 "are the same file" compare a.exr b.exr --heat h.png --flip-map "$work/far/../h.png"
refuses 2 "are the same file: the second" compare a.exr b.exr --heat far/old.png --flip-map link.png
refuses 2 "-o 'a.png' and -o './a.png' are the same file" render cube.gltf -o a.png -o b.exr -o ./a.png
refuses 2 "ENVIRONMENT 'c.exr' and -o 'c-link.exr' are the same file: the input would be lost" render cube.gltf c.exr -o c-link.exr
refuses 2 "-o 'c.exr' and --env 'c.exr' are the same file" render cube.gltf --env c.exr -o c.exr
refuses 2 "-o 's.exr' and --stats 's.exr' are the same file" render cube.gltf -o s.exr --stats s.exr
cp "$scenes/cube.gltf" p.csv
refuses 2 "--points 'p.csv' and -o './p.csv' are the same file" probe cube.gltf --points p.csv -o ./p.csv
refuses 2 "SCENE 'cube.gltf' and --stats 'cube.gltf' are the same file" render cube.gltf -o a.png --stats cube.gltf
cmp -s cube.gltf "$scenes/cube.gltf" || fail "an input was lost"
works compare a.exr b.exr --heat null.png --flip-map null.png

# ---- long names ----
# a temporary file beside it must not be what is too long
long=$(printf '%0251d' 7)
works compare a.exr b.exr --heat "$long.png"
is_png "$long.png" "of 255 characters"
[ -z "$(find . -name '.tyndall*')" ] || fail "left: $(find . -name '.tyndall*')"

# ---- a file that may not get so large ----
printf old >kept.png
exr big.exr 256 256 R=1 G=0 B=3
exr bigger.exr 256 256 R=2 G=0 B=1
(
    ulimit -f 0
    "$tool_path" compare big.exr bigger.exr --heat kept.png 2>&1
    echo "exit $?"
) | cat >limited.txt
grep -q "kept.png: cannot be written: File too large" limited.txt && grep -q "exit 1" limited.txt ||
    fail "a file that may not get so large: $(cat limited.txt)"
[ "$(cat kept.png)" = old ] || fail "a file that could not be written was lost"
[ -z "$(find . -name '.tyndall*')" ] || fail "left by a limit: $(find . -name '.tyndall*')"
finish
