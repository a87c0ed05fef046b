#!/bin/sh
# paper.sh -- prints the tables that compare `pop-paper`, the published scheme, with `path` and with `pop`.
#
# usage: docs/figures/paper.sh [methods|ordinates|prefilter|milk ...]      after tools/setup; default: all of them.
# About ten minutes. Pictures of 160x120 pixels, errors on blocks of 8x8 without the background; the
# references are `path` with SPP samples a pixel (default 128), kept in out/paper. Times are those of a
# cold frame on the machine as it is: it should do nothing else.
set -eu
cd "$(dirname "$0")/../.."
work=out/paper
scenes=build/samples/scenes
mkdir -p $work

# picture NAME OPTIONS...: $work/NAME.exr and .json
picture() {
    name=$1
    shift
    build/tools/tyndall render "$@" --size 160x120 --no-background --quiet -o "$work/$name.exr" \
        --stats "$work/$name.json"
}

# reference NAME OPTIONS...: the same picture by path, unless it is there
reference() {
    [ -f "$work/$1.exr" ] || picture "$@" --method path --spp "${SPP:-128}"
}

# measure NAME REFERENCE: "rel_l1 bias"
measure() {
    build/tools/tyndall compare "$work/$1.exr" "$work/$2.exr" --block 8 |
        awk '$1 == "rel_l1" { e = $2 } $1 == "bias" { b = $2 } END { printf "%.1f %% (%+.1f)", 100 * e, 100 * b }'
}

# time_of NAME [NODE]: ms of the frame, or of one node
time_of() {
    python3 - "$work/$1.json" "${2:-}" <<'PY'
import json, sys
stats = json.load(open(sys.argv[1]))
nodes = {n["name"]: n["gpu_ms"] for n in stats["nodes"] if n["state"] == "ran"}
print("%.0f" % (nodes.get(sys.argv[2], 0) if sys.argv[2] else sum(nodes.values())))
PY
}

paper="--method pop-paper -D propagate_rect.cells=20 -D ordinates.importance=off"

table_methods() {
    echo "| scene | \`pop-paper\`, 10 iterations | ms | 20 iterations | ms | + residuum | ms | \`pop\` | ms |"
    echo "|---|---|---|---|---|---|---|---|---|"
    for scene in smoke-sky cloud-sunset plume-contrast; do
        file=$scenes/$scene.gltf
        reference $scene-path $file
        picture $scene-10 $file $paper -D propagate_rect.iterations=10
        picture $scene-20 $file $paper
        picture $scene-residuum $file $paper -D residuum.on=1
        picture $scene-pop $file --method pop
        printf '| `%s` ' $scene
        for way in 10 20 residuum pop; do
            printf '| %s | %s ' "$(measure $scene-$way $scene-path)" "$(time_of $scene-$way)"
        done
        echo '|'
    done
}

# Fig 14: ordinates, without and with importance, for a strongly forward scattering smoke.
table_ordinates() {
    options="$scenes/smoke.gltf --env $scenes/courtyard.exr --g 0.9,0.9,0.9"
    reference fig14-path $options
    echo "| ordinates | without importance | with importance | propagation, ms |"
    echo "|---|---|---|---|"
    for n in 8 27 64 125; do
        for importance in off on; do
            picture fig14-$n-$importance $options $paper -D ordinates.count=$n -D ordinates.importance=$importance
        done
        echo "| $n | $(measure fig14-$n-off fig14-path) | $(measure fig14-$n-on fig14-path) |" \
            "$(time_of fig14-$n-off propagate_rect) |"
    done
}

# Fig 6: light of the regions as beams, or spread as far as the regions are wide, in a thin medium.
table_prefilter() {
    options="$scenes/smoke.gltf --env $scenes/courtyard.exr --density-scale 0.25"
    echo "| g | ordinates | off | heuristic, beta = 1 | exact |"
    echo "|---|---|---|---|---|"
    for g in 0.6 0.95; do
        reference fig6-$g-path $options --g $g,$g,$g
        for n in 8 27 64; do
            printf '| %s | %s ' $g $n
            for filter in off heuristic exact; do
                picture fig6-$g-$n-$filter $options --g $g,$g,$g $paper -D ordinates.count=$n \
                    -D propagate_rect.prefilter=$filter
                printf '| %s ' "$(measure fig6-$g-$n-$filter fig6-$g-path)"
            done
            echo '|'
        done
    done
}

# Fig 8: milk by full propagation, and by the isotropic residuum after some iterations.
table_milk() {
    options="$scenes/milk.gltf --method pop-paper -D propagate_rect.cells=16 -D ordinates.importance=off"
    picture fig8-full $options -D propagate_rect.iterations=100
    echo "| iterations in 64 grids of 16^3 | in one of 32^3 | difference to the first row | propagation, ms |"
    echo "|---|---|---|---|"
    echo "| 100 | 0 | | $(time_of fig8-full propagate_rect) |"
    for way in "20 0" "20 20" "20 80" "40 0" "40 80"; do
        set -- $way
        residuum="-D propagate_rect.iterations=$1"
        [ "$2" = 0 ] || residuum="-D residuum.on=1 -D residuum.after=$1 -D residuum.iterations=$2"
        picture "fig8-$1-$2" $options $residuum
        grids=$(time_of "fig8-$1-$2" propagate_rect) rest=$(time_of "fig8-$1-$2" residuum)
        echo "| $1 | $2 | $(measure "fig8-$1-$2" fig8-full) | $((grids + rest)) |"
    done
}

[ $# -gt 0 ] || set -- methods ordinates prefilter milk
for table; do
    "table_$table"
    echo
done
