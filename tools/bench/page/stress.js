// stress.js -- where methods lose accuracy when numbers get extreme: a cell per case, coloured by error.

const STRESS_STEPS = [0.003, 0.01, 0.03, 0.1, 0.3]; // upper bounds of the colours; the last is above

const stressStep = (error) => (isNumber(error) ? STRESS_STEPS.findIndex((s) => error <= s) >>> 0 : null);
const stressClass = (error) => (isNumber(error) ? `heat-${Math.min(stressStep(error), STRESS_STEPS.length)}` : "heat-none");

// "1e-06" -> 10\u207b\u2076; names that are more than their number stay.
function caseName(cell) {
    const name = String(cell.case ?? ""), value = isNumber(cell.x) ? axisValue(cell.x) : "";
    return value && (name === "" || Number(name) === cell.x) ? value : cell.ambiguous ? `${name} ${value}` : name;
}

// Names that occur twice on an axis need their value as well.
function markAmbiguous(cells) {
    const seen = new Map();
    for (const cell of cells) {
        const id = JSON.stringify([cell.method, cell.axis, cell.case]);
        seen.set(id, [...(seen.get(id) || []), cell]);
    }
    seen.forEach((same) => same.forEach((cell) => { cell.ambiguous = same.length > 1; }));
}

// Percent in three characters or so.
const stressFigure = (error) => (error === 0 ? "0" : error < 1e-3 ? "< 0.1" : error >= 10 ? "> 999" : digits(100 * error, error < 0.1 ? 1 : 2));

function stressWords(cell) {
    const bad = [cell.non_finite > 0 && `${cell.non_finite} values not finite`, cell.negative > 0 && `${cell.negative} negative values`].filter(Boolean);
    return {
        title: `${cell.method}, ${cell.axis}: ${caseName(cell)}`,
        figure: isNumber(cell.error)
            ? `error ${percent(cell.error)}${isNumber(cell.se) ? ` \u00b1${NARROW}${percent(cell.se)}` : ""} against ${cell.against ?? "an exact answer"}${isNumber(cell.ms) ? `, ${duration(cell.ms)}` : ""}${cell.hidden > 0 ? `, negative light hidden ${percent(cell.hidden)}` : ""}`
            : cell.failure ?? "no figure: see the reason, or the case is not this method's", bad, warnings: list(cell.warnings),
    };
}

function stressCell(cell, tip) {
    const words = stressWords(cell), bad = words.bad.length > 0;
    const label = cell.non_finite > 0 ? "NaN" : cell.negative > 0 ? "< 0" : isNumber(cell.error) ? stressFigure(cell.error) : NONE;
    const show = (event) => tip.show(event.currentTarget, words);
    return make("button", {type: "button", tabindex: -1, class: `cell ${stressClass(cell.error)}${bad ? " spoiled" : ""}${words.warnings.length ? " warned" : ""}`,
        "aria-label": [words.title, words.figure, ...words.bad, ...words.warnings].join(". "),
        onfocus: show, onpointerenter: show, onblur: tip.hide, onpointerleave: tip.hide},
        make("span", {class: "value"}, label), make("span", {class: "case"}, caseName(cell)));
}

// One stop for the tab key, arrows within: by cell, and by row at the same place.
function stressKeys(frame) {
    frame.addEventListener("keydown", (event) => {
        const rows = [...frame.querySelectorAll(".cells")].map((r) => [...r.children]);
        const row = rows.findIndex((r) => r.includes(event.target)), at = row < 0 ? -1 : rows[row].indexOf(event.target);
        const [down, right] = {ArrowDown: [1, 0], ArrowUp: [-1, 0], ArrowRight: [0, 1], ArrowLeft: [0, -1]}[event.key] ?? [];
        const next = at < 0 || right === undefined ? null : right ? rows[row][at + right]
                   : rows[row + down] && rows[row + down][Math.min(at, rows[row + down].length - 1)];
        if (next) {
            event.preventDefault();
            event.target.tabIndex = -1;
            next.tabIndex = 0;
            next.focus();
        }
    });
}

function stressTip(frame) {
    const box = make("div", {class: "tip", role: "tooltip", hidden: true});
    onWidth(frame, () => { box.hidden = true; });
    return {
        box,
        show(target, words) {
            box.replaceChildren(make("strong", {}, words.title), make("span", {}, words.figure),
                ...words.bad.map((b) => make("span", {class: "bad"}, b)), ...words.warnings.map((w) => make("span", {class: "warning"}, w)));
            box.hidden = false;
            const at = target.getBoundingClientRect(), outer = frame.getBoundingClientRect();
            box.style.left = `${clamp(at.x + at.width / 2 - outer.x - box.offsetWidth / 2, 0, Math.max(0, outer.width - box.offsetWidth))}px`;
            box.style.top = `${at.y + at.height - outer.y + 6}px`;
        },
        hide() { box.hidden = true; },
    };
}

function stressSection(stress, styles) {
    const cells = list((stress || {}).cells);
    if (cells.length === 0) {
        return null;
    }
    markAmbiguous(cells);
    const unique = (values) => [...new Set(values)];
    const methods = unique([...list(stress.methods).map((m) => (typeof m === "string" ? m : m.name)), ...cells.map((c) => c.method)]).filter(Boolean);
    const axes = unique(cells.map((c) => c.axis));
    const spoiledCells = cells.filter((c) => c.non_finite > 0 || c.negative > 0);
    const lossy = cells.filter((c) => isNumber(c.error) && c.error > 0.1);
    const missing = isNumber(stress.expected) ? stress.expected - cells.length : 0;
    const section = make("section", {id: "stress", class: "stress"},
        make("h2", {}, "Under stress"),
        missing > 0 && make("p", {class: "note part"}, `${missing} of the ${stress.expected} cells of the ${stress.quick ? "quick" : "whole"} suite were not run.`),
        make("p", {}, `${cells.length} cases in which numbers get extreme, each against an exact answer or path${stress.quick ? " (the quick suite)" : ""}. A cell shows the error in percent and, below it, the value on its axis; point at it for the reason.`),
        spoiledCells.length > 0
            ? make("p", {class: "alert", role: "alert"}, `${spoiledCells.length} cell${spoiledCells.length > 1 ? "s hold" : " holds"} values that are not finite or negative: `, spoiledCells.map((c) => stressWords(c).title).join("; "))
            : make("p", {class: "good"}, "No value of any cell is infinite, not a number or negative."),
        make("p", {class: "legend heat"}, [...STRESS_STEPS, null].map((s, i) => make("span", {class: "key"}, make("span", {class: `swatch heat-${i}`}), s === null ? "more" : `to ${level(s)}`)),
            make("span", {class: "key"}, make("span", {class: "swatch heat-none"}), "no figure"), make("span", {class: "key"}, make("span", {class: "swatch warned"}), "has a warning")));
    const frame = make("div", {class: "holder stress-grid"}), tip = stressTip(frame);
    const name = (word) => [styles.get(word) && marker(styles.get(word), 13), word];
    const show = (outer, inner, outerKey, innerKey) => {
        frame.replaceChildren(tip.box, ...outer.map((o) => group(o, inner, outerKey, innerKey)));
        frame.querySelector(".cell").tabIndex = 0;
    };
    const group = (o, inner, outerKey, innerKey) => {
        const own = cells.filter((c) => c[outerKey] === o);
        return make("div", {class: "stress-group"}, make("h3", {}, name(o)),
            inner.filter((i) => own.some((c) => c[innerKey] === i)).map((i) => make("div", {class: "axis-row"},
                make("div", {class: "axis-name"}, name(i)),
                make("div", {class: "cells", role: "group", "aria-label": `${o}, ${i}`}, own.filter((c) => c[innerKey] === i).map((c) => stressCell(c, tip))))));
    };
    stressKeys(frame);
    show(methods, axes, "method", "axis");
    section.append(make("div", {class: "controls"}, segmented("order of the cells", [["method", "by method"], ["axis", "by axis"]], "method",
        (by) => (by === "method" ? show(methods, axes, "method", "axis") : show(axes, methods, "axis", "method")))), frame);
    if (lossy.length > 0) {
        section.append(make("details", {}, make("summary", {}, `Where the error is above ${level(0.1)}: ${lossy.length} cells`),
            make("div", {class: "scroll", tabindex: 0, role: "region", "aria-label": "cells with large errors"}, make("table", {},
                make("thead", {}, make("tr", {}, ["case", "error", "reason"].map((h) => make("th", {scope: "col"}, h)))),
                make("tbody", {}, lossy.map((c) => make("tr", {}, make("th", {scope: "row"}, stressWords(c).title),
                    make("td", {class: "number"}, percent(c.error)), make("td", {class: "reason"}, list(c.warnings).join("; ") || make("span", {class: "bad"}, "no warning")))))))));
    }
    return section;
}
