#!/usr/bin/env python3
"""judges.py SOURCE_ROOT -- what a test must not do, or it passes where it ought not to.

* skip() of cmocka: nothing would tell why, and a test of skipped cases alone would pass. skip.h says how.
* fmax, fmin or a comparison to find the largest value or error: they drop NaN. numbers.h has maximum and minimum.
* if (x > 0) { ... x <= bound ... }: what is NaN or not there is not judged at all.
* assert_float_equal of cmocka: NaN equals every number for it. numbers.h has assert_near.
* assert_false(a > b), assert_true(!(a > b)): true for NaN.
* tyn_offline_frame(...) == TYN_OK: values that are not finite go unseen. offline_frame.h has offline_frame.
"""
import os
import re
import sys

NAMES = r"(?:worst|wrong|largest|least|most|greatest|brightest|differ\w*|error|off|off_by)\w*"
RULES = (
    (r"(?<!_)\bskip\(\)", "skip() does not say why: skip_case, skip_without (skip.h)"),
    (r"\breturn 77\b|\bexit\(77\)", "exits with 77 without a reason: skip_all (skip.h)"),
    (rf"\b({NAMES}(?:\[\w+\])*) = fm(?:ax|in)f?\(\1,", "fmax and fmin drop NaN: maximum, minimum (numbers.h)"),
    (r"\b(?:assert_)?within\(fm(?:ax|in)f?\(", "fmax and fmin drop NaN: maximum, minimum (numbers.h)"),
    (r"\bif \(([\w.\[\]>-]+) > 0\) \{(?:[^{}]|\{[^{}]*\})*?(?<!\w)\1 [<>]=? ", "NaN and what is not there are not judged"),
    (rf"\b(\w+) <=? ({NAMES}) \? \2 : \1\b", "drops a NaN that came before: maximum (numbers.h)"),
    (r"\bassert_float_equal\(", "NaN passes: assert_near (numbers.h)"),
    (r"\bassert_false\([^;&|]* [<>]=? ", "true for NaN: assert what holds"),
    (r"\bassert_true\(!\([^;&|]* [<>]=? ", "true for NaN: assert what holds"),
    (r"\btyn_offline_frame\([^;]*\), TYN_OK\)", "values that are not finite go unseen: offline_frame"),
)
SUPPORT = {"tests/support/skip.c", "tests/support/numbers.h", "tests/support/offline_frame.c"}


def faults(path, text):
    text = re.sub(r"//[^\n]*|/\*.*?\*/", lambda c: "\n" * c.group().count("\n"), text, flags=re.S)
    for pattern, why in RULES:
        for found in re.finditer(pattern, text):
            yield f"{path}:{text.count(chr(10), 0, found.start()) + 1}: {found.group().split(chr(10))[0]}: {why}"


def check_rules():
    """Every rule finds what it is for."""
    bad = ("skip();", "return 77;", "most = fmax(most, d[i]);", "within(fmax(1 - least, most - 1), 0.1);",
           "if (f[k][1] > 0) {\n    if (a) {\n        b();\n    }\n    good = f[k][1] <= 2 && good;\n}", "most = d <= most ? most : d;",
           "assert_float_equal(a, b, 1e-3);", "assert_false(error > 0.1);", "assert_true(!(error > 0.1));",
           "assert_int_equal(tyn_offline_frame(off, scene, &view, false), TYN_OK);")
    good = ("skip_case(\"no device\");", "worst = maximum(worst, fabs(d));", "if (n > 0) { sum += d / n; }", "assert_true(error <= 0.1);", "far = fmax(far, t);",
            "assert_false(isnan(x));", "assert_int_equal(tyn_offline_frame(off, scene, &view, false), TYN_ERR_PARAMS);")
    wrong = [f"not found: {line}" for line, (pattern, _) in zip(bad, RULES) if not re.search(pattern, line)]
    return wrong + [f"found: {fault}" for line in good for fault in faults(line, line)]


def main():
    root = sys.argv[1]
    wrong = check_rules()
    judged = [os.path.join(root, *place) for place in (("tests",), ("engine", "frame"))]
    judged += [os.path.join(root, "passes", module, "tests") for module in sorted(os.listdir(os.path.join(root, "passes")))]
    for folder, _, names in (found for place in judged for found in os.walk(place)):
        for name in names:
            path = os.path.relpath(os.path.join(folder, name), root)
            if name.endswith((".c", ".h")) and path not in SUPPORT:
                with open(os.path.join(root, path), encoding="utf-8") as file:
                    wrong += faults(path, file.read())
    print("\n".join(wrong) or "all right")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
