#!/bin/sh
# bench_ci.sh -- the small suite within its recorded bands; and out of them with a bug planted in method "pop".
. "$(dirname "$0")/lib.sh"

run info --devices
if [ "$code" != 0 ] || ! grep -q "usable" out; then
    echo "skipped: no Vulkan device"
    exit 77
fi

suite="$source/tools/bench/suites/ci.json" bands="$source/tools/bench/bands/ci.json"
export XDG_CACHE_HOME="$helpers/bench-cache" # references are made once a build
run bench --suite "$suite" --bands "$bands" --scenes "$scenes" --report honest --quiet
cat out
[ "$code" = 0 ] || fail "the suite: exit $code: $(cat err)"

# What is planted is in "pop" alone, and records do not know of it: those of the others are taken over.
for plant in output albedo; do
    cp -r honest $plant
    for record in $plant/records/*.json; do
        [ "$("$helpers/json_get" "$record" run.method)" = pop ] && rm "$record"
    done
    TYN_PLANT=$plant "$helpers/tyndall_planted" bench --suite "$suite" --bands "$bands" --scenes "$scenes" \
        --report $plant --quiet >out 2>err
    code=$?
    [ "$code" = 1 ] || fail "3 % of $plant: exit $code, expected 1: $(cat err)"
    grep -q "cube: pop: errors.0.bias is .*, outside of" err || fail "3 % of $plant went unseen: $(cat err)"
    echo "planted: 3 % of $plant: $(wc -l <err) figures leave their bands"
done
finish
