#!/bin/sh
# interrupted.sh -- Ctrl-C and SIGTERM end within seconds also where a frame takes longer, and leave nothing half done.
. "$(dirname "$0")/lib.sh"
needs_device

# Seconds of processors that ended children took, into $spent.
spend() {
    times >times
    spent=$(awk 'NR == 2 { gsub("s", ""); split($1, a, "m"); split($2, b, "m"); print 60 * (a[1] + b[1]) + a[2] + b[2] }' times)
}

# SIGNAL ARGUMENTS: the tool, sent the signal as soon as it computes. Ends within what all processors do in 4 s, however
# many others use them.
interrupt() {
    signal=$1
    shift
    "$tool" "$@" >out 2>err &
    child=$!
    sleep 4
    spend
    kill -"$signal" $child 2>/dev/null || fail "tyndall $*: had ended before the signal: $(cat err)"
    before=$(awk '{ print ($14 + $15) / 100 }' /proc/$child/stat)
    wait $child
    code=$?
    others=$spent
    spend
    [ "$code" = 130 ] || fail "tyndall $*: exit $code after SIG$signal: $(cat err)"
    awk "BEGIN { exit !($spent - $others - $before <= 4 * $(nproc)) }" ||
        fail "tyndall $*: took $(awk "BEGIN { print $spent - $others - $before }") s of processors after SIG$signal"
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
