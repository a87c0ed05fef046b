# lib.sh -- sourced by the tests of the tool. They are called as
#   NAME.sh TYNDALL HELPERS SCENES SOURCE
# the program, the folder of exr_make and json_get, the folder of the sample scenes, the source tree.

tool=$1 helpers=$2 scenes=$3 source=$4
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export MESA_SHADER_CACHE_DIR="${MESA_SHADER_CACHE_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/tyndall-tests}" # of all tests (tests/meson.build)
export XDG_CACHE_HOME="$work/cache"
failures=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# run ARGUMENTS: the tool; leaves out, err and code.
run() {
    "$tool" "$@" >out 2>err
    code=$?
}

# refuses CODE WORDS ARGUMENTS: that exit code, nothing on stdout, and one line on stderr with WORDS in it.
refuses() {
    expected=$1 words=$2
    shift 2
    run "$@"
    [ "$code" = "$expected" ] || fail "tyndall $*: exit $code, expected $expected: $(cat err)"
    [ -s out ] && fail "tyndall $*: printed on stdout: $(head -1 out)"
    [ "$(wc -l <err)" = 1 ] || fail "tyndall $*: not one line on stderr: $(cat err)"
    grep -qF -- "$words" err || fail "tyndall $*: no '$words' in: $(cat err)"
}

# works ARGUMENTS: exit 0 and nothing on stderr.
works() {
    run "$@"
    [ "$code" = 0 ] || fail "tyndall $*: exit $code: $(cat err)"
}

# get FILE NAME: a member of a JSON file
get() {
    "$helpers/json_get" "$1" "$2" || fail "$1 has no $2"
}

# needs_device: skips the test where there is none
needs_device() {
    run info --devices
    if [ "$code" != 0 ] || ! grep -q "usable" out; then
        echo "skipped: all cases (no Vulkan device)"
        exit 77
    fi
}

# near VALUE EXPECTED TOLERANCE WHAT; what is no number (nan, null) is near nothing, though awk takes it for 0
near() {
    awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { d = a - b; exit !(a ~ /^-?[0-9.]/ && d <= t && -d <= t) }' ||
        fail "$4: $1, expected $2 +- $3"
}

# value NAME: of "name value" lines in out
value() {
    awk -v n="$1" '$1 == n { print $2 }' out
}

finish() {
    if [ "$failures" = 0 ]; then
        echo "all right"
        exit 0
    fi
    exit 1
}
