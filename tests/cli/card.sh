#!/bin/sh
# card.sh -- tools/card_pack packs one scene, tools/card is interrupted and goes on, tools/docs/card makes tables. About 40 s of processors.
. "$(dirname "$0")/lib.sh"
needs_device
build=$(dirname "$(dirname "$tool")")
card=$work/tyndall-card/tools/card
export HOME="$work"

# wrong WORDS PROGRAM ARGUMENTS: exit code 2, and one line with these words.
wrong() {
    words=$1
    shift
    "$@" >out 2>err
    code=$?
    [ "$code" = 2 ] || fail "$*: exit $code, expected 2: $(cat out err)"
    [ "$(cat out err | wc -l)" = 1 ] || fail "$*: not one line: $(cat out err)"
    grep -qF -- "$words" err || fail "$*: no '$words' in: $(cat err)"
}

# holds PYTHON: of the figures c, in card/card.json.
holds() {
    python3 -c "import json; c = json.load(open('card/card.json')); assert $1" || fail "not so: $1: $(head -c 3000 card/card.json)"
}

pack=$source/tools/card_pack
wrong "no built tree" "$pack" nowhere out.tar
wrong "a .tar.xz or .tar" "$pack" "$build" out.zip
wrong "no such scene" "$pack" --scenes nothing "$build" out.tar
wrong "no such test" "$pack" --tests nothing "$build" out.tar
wrong "no Vulkan driver" env VK_DRIVER_FILES=/nowhere "$pack" --scenes cube --tests hg "$build" out.tar
[ -z "$(ls -d out.tar card-* 2>/dev/null)" ] || fail "card_pack leaves something behind: $(ls)"
wrong "no bundle.json" "$source/tools/card"
wrong "from 20 to 36000" "$source/tools/card" --seconds 1

"$pack" --scenes cube --tests hg "$build" packed.tar >log 2>&1 || { fail "pack: $(cat log)"; finish; }
tar -xf packed.tar && rm packed.tar
wrong "no usable Vulkan device" env VK_DRIVER_FILES=/nowhere "$card"
# A stored picture of another scene: the difference must show.
cp tyndall-card/pictures/cube.exr tyndall-card/pictures/cube-dense.exr

# run_until SECONDS WORDS: a run, interrupted as soon as these words are in its figures.
run_until() {
    "$card" --seconds "$1" >log 2>&1 &
    child=$!
    tries=0
    while ! grep -qF "$2" card/card.json 2>/dev/null && [ $tries -lt 1800 ]; do
        tries=$((tries + 1))
        sleep 0.1
    done
    wrong "another run writes there" "$card"
    kill -INT $child
    wait $child
    code=$?
    [ $code = 130 ] || fail "card --seconds $1: exit $code after SIGINT: $(cat log)"
}

run_until 600 '"cube": {'
holds "c['schema'] == 'tyndall-card' and c['version'] == 1 and 'references: cube' in c['left_out'] and 'tests' not in c"

# What is done is not done again: a figure that no run gives stays.
python3 - <<'PY'
import json
card = json.load(open("card/card.json"))
card["pictures"]["cube"]["rel_l1"] = 0.12345
json.dump(card, open("card/card.json", "w"))
PY
run_until 80 '"hg": {'
"$card" --seconds 20 >log 2>&1 || fail "card --seconds 20: exit $?: $(cat log)"
holds "c['pictures']['cube']['rel_l1'] == 0.12345"
holds "len(c['pictures']) == 3 and c['pictures']['cube dense']['rel_l1'] > .01"
holds "c['pictures']['cube g .9']['rel_l1'] < 1e-3"
holds "c['frames']['cube 512x512 cold']['ms'] > 0 and len(c['frames']['cube 512x512 cold']['nodes']) > 5"
holds "c['path']['cube 512x512']['million_samples_a_second'] > 0 and c['tests']['hg']['result'] == 'passed'"
holds "len(c['runs']) == 3 and c['runs'][2]['seconds'] <= 20"
holds "not {f'{p}: {k}' for p in ('pictures', 'frames', 'path', 'tests') for k in c.get(p, {})} & set(c['left_out'])"

printf 'before\n<!-- card -->\nold\n<!-- end of card -->\nafter\n' >page.md
"$source/tools/docs/card" card/card.json page.md || fail "page: exit $?"
for line in before after 'Version' '12 % in the median' '| pixels | `cube` |' '1 passed'; do
    grep -qF -- "$line" page.md || fail "page: no '$line' in: $(cat page.md)"
done
grep -q '^old$' page.md && fail "page: old lines are still there"
cp page.md again.md
"$source/tools/docs/card" card/card.json again.md
cmp -s page.md again.md || fail "page: another one the second time"
wrong "has no lines" "$source/tools/docs/card" card/card.json log
wrong "No such file" "$source/tools/docs/card" nothing.json
sed 's/"runs"/"others"/' card/card.json >lacks.json
wrong "lacks figures" "$source/tools/docs/card" lacks.json
sed 's/"commit": "/"commit": "other/' card/card.json >other.json && mv other.json card/card.json
wrong "give another --out" "$card"
echo '{"schema": "tyndall-card", "version": 1, "runs": 3}' >card/card.json
wrong "in the place of figures" "$card"
echo '{' >card/card.json
wrong "cannot be read as JSON" "$card"
wrong "cannot be read as JSON" "$source/tools/docs/card" card/card.json
finish
