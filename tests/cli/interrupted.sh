#!/bin/sh
# interrupted.sh -- Ctrl-C and SIGTERM end within seconds also where a frame takes longer, and leave nothing half done.
. "$(dirname "$0")/lib.sh"
needs_device

# SIGNAL ARGUMENTS: the tool, sent the signal as soon as it computes
interrupt() {
    signal=$1
    shift
    "$tool" "$@" >out 2>err &
    child=$!
    sleep 4
    kill -"$signal" $child 2>/dev/null || fail "tyndall $*: had ended before the signal: $(cat err)"
    before=$(date +%s)
    wait $child
    code=$?
    after=$(date +%s)
    [ "$code" = 130 ] || fail "tyndall $*: exit $code after SIG$signal: $(cat err)"
    [ $((after - before)) -le 4 ] || fail "tyndall $*: took $((after - before)) s after SIG$signal"
}

mkdir there
printf old >there/old.png
for signal in INT TERM; do
    interrupt $signal render "$scenes/cloud.gltf" --method path --spp 64 --size 3000x3000 -o there/old.png
done
interrupt TERM render "$scenes/smoke.gltf" --quality high -D raymarch.step=0.05 --size 4000x4000 -o there/old.png
[ "$(cat there/old.png)" = old ] || fail "a file was lost by a signal"
[ "$(ls -A there)" = old.png ] || fail "left by a signal: $(ls -A there)"
finish
