// head.js -- what was measured, and what came out: speed-up at equal error, verdicts.

function facts(pairs) {
    return make("dl", {class: "facts"}, pairs.filter(([, value]) => value !== null && value !== undefined && value !== "")
        .map(([name, value]) => make("div", {}, make("dt", {}, name), make("dd", {}, value))));
}

function ceilingFacts(ceilings) {
    const c = ceilings || {};
    const entry = (name, value, unit) => [name, isNumber(value) ? digits(value, 3) + NARROW + unit : "not measured"];
    return facts([
        entry("multiply-add", c.fma_gflops, "GFLOP/s"), entry("copy", c.copy_gb_s, "GB/s"),
        entry("trilinear fetch", c.trilinear_gsamples_s, "G/s"), entry("exp", c.exp_gops_s, "G/s"),
        entry("dispatch and barrier", c.dispatch_us, "\u00b5s"),
    ]);
}

function pageHead(report) {
    const suite = report.suite || {}, device = report.device || {}, seconds = report.seconds || {};
    const scenes = list(report.scenes);
    const runs = scenes.reduce((n, s) => n + list(s.runs).length, 0);
    document.title = `Tyndall: error against time, suite ${suite.name ?? ""}`;
    return make("header", {class: "head"},
        make("p", {class: "eyebrow"}, `Tyndall ${report.tyndall ?? ""}, bench report`),
        make("h1", {}, "Error against time"),
        suite.about && make("p", {class: "lead"}, suite.about),
        facts([
            ["suite", suite.name], ["device", device.name], ["driver", device.driver], ["kind", device.type],
            ["date", String(report.date ?? "").replace("T", " ").replace("Z", " UTC")],
            ["scenes, runs", `${scenes.length}, ${runs}`],
            ["time measuring", isNumber(seconds.measuring) ? duration(1e3 * seconds.measuring) : null],
            ["time for references", !isNumber(seconds.references) ? null : seconds.references > 0 ? duration(1e3 * seconds.references) : "none, all were there"],
            ["suite hash", suite.hash && make("code", {}, suite.hash)],
        ]),
        make("h2", {class: "minor"}, "What the device can do at most, measured in the same run"),
        ceilingFacts(report.ceilings));
}

function bandsAlert(bands) {
    const outside = list((bands || {}).outside);
    if (!bands) {
        return null;
    }
    if (outside.length === 0) {
        return make("p", {class: "good"}, `Every figure is inside the bands of ${bands.file}.`);
    }
    return make("section", {class: "alert", role: "alert"},
        make("h2", {}, `${outside.length} figure${outside.length > 1 ? "s" : ""} outside the recorded bands`),
        make("ul", {}, outside.map((o) => make("li", {}, make("strong", {}, `${o.scene}, ${o.run}: ${o.figure} `),
            `${digits(o.value, 3)}, band ${digits(o.low, 3)} to ${digits(o.high, 3)}${o.reason ? ` (${o.reason})` : ""}`))));
}

// ---- speed-up at equal error ------------------------------------------------------------------

const SPEED_MARKS = [SHAPES[0], SHAPES[3], SHAPES[1], SHAPES[2]]; // by error level: filled, then hollow

// The methods that sample, at each error the fastest of them: "path".
function baselineName(report) {
    const names = new Set(list(report.scenes).flatMap((s) => list(s.runs)).filter((r) => r.baseline).map((r) => r.method));
    return [...names].join(" or ") || "path";
}

function speedRows(report, method, block) {
    return list(report.scenes).map((scene) => ({
        scene: String(scene.name ?? ""),
        entries: list(scene.equal_error)
            .filter((e) => e.method === method && e.block === block)
            .map((e) => ({...e, floor: list(scene.floors).some((f) => f.method === method && f.block === block)}))
            .sort((a, b) => b.error - a.error),
    })).filter((row) => row.entries.length > 0);
}

function speedReason(entry, method, baseline) {
    return entry.why ? entry.why : !isNumber(entry.ms) ? (entry.floor ? `${method} does not reach it` : "not measured")
         : !isNumber(entry.baseline_ms) ? `${baseline} does not reach it` : "";
}

// Rows of marks on a common log axis of ratios; 1 is where both take the same time.
function speedChart(width, rows, errors, means, method, baseline, block) {
    const narrow = width < 620;
    const label = narrow ? 0 : Math.min(190, width * 0.24), right = 14;
    const rowHeight = narrow ? 42 : 30, top = 26;
    const values = rows.flatMap((r) => r.entries.map((e) => e.speedup)).concat(means).filter((v) => isNumber(v) && v > 0);
    if (values.length === 0) {
        return make("p", {class: "note"}, "Nothing to compare: no scene reaches these errors with both.");
    }
    const low = Math.log10(Math.min(0.7, ...values)) - 0.08, high = Math.log10(Math.max(2, ...values)) + 0.08;
    const x = (v) => label + 10 + (width - label - right - 20) * (Math.log10(v) - low) / (high - low);
    const withMean = means.some(isNumber);
    const height = top + rowHeight * (rows.length + (withMean ? 1 : 0)) + 8;
    const svg = draw("svg", {class: "speed", width, height, viewBox: `0 0 ${width} ${height}`, role: "img",
        "aria-label": `how many times as long ${baseline} takes as ${method} at equal error, by scene; the table below holds the figures`});
    const wide = high - low > 2.2;
    for (let decade = Math.floor(low); decade <= Math.ceil(high); decade++) {
        for (const step of wide ? [1] : [1, 2, 5]) {
            const v = step * 10 ** decade;
            if (Math.log10(v) >= low && Math.log10(v) <= high) {
                svg.append(draw("line", {class: v === 1 ? "one" : "grid", x1: x(v), x2: x(v), y1: top - 6, y2: height}),
                    draw("text", {class: "tick", x: x(v), y: 12, "text-anchor": "middle"}, axisValue(v) + TIMES));
            }
        }
    }
    const drawRow = (name, list, y, mean) => {
        svg.append(draw("text", {class: mean ? "row mean" : "row", x: narrow ? 2 : label, y: narrow ? y - 11 : y + 4,
            "text-anchor": narrow ? "start" : "end"}, name.length > 26 ? name.slice(0, 25) + "\u2026" : name));
        const there = list.filter((e) => isNumber(e.speedup) && e.speedup > 0);
        if (there.length === 0) {
            // Right of 1 where it fits, else to the end of the row.
            const reason = list.map((e) => speedReason(e, method, baseline))[0] || "", fits = x(1) + 8 + 6 * reason.length < width;
            svg.append(draw("text", {class: "tick", x: fits ? x(1) + 8 : width - 4, y: y + 4, "text-anchor": fits ? "start" : "end"}, reason));
        } else {
            const xs = [x(1), ...there.map((e) => x(e.speedup))];
            svg.append(draw("line", {class: "span", x1: Math.min(...xs), x2: Math.max(...xs), y1: y, y2: y}));
            for (const e of there) {
                const k = errors.indexOf(e.error);
                svg.append(draw("path", {class: (k === 0 ? "mark" : "mark hollow") + (e.speedup < 1 ? " slower" : "") + (e.measured === false ? " guessed" : ""), d: SPEED_MARKS[k % 4],
                    transform: `translate(${x(e.speedup)} ${y}) scale(1.15)`},
                    draw("title", {}, `${name}, ${errorLevel(e.error, block)}: ${times(e.speedup)}${e.measured === false ? " (extrapolated)" : ""}`)));
            }
        }
    };
    rows.forEach((row, i) => drawRow(row.scene, row.entries, top + rowHeight * (i + 0.5) + (narrow ? 8 : 0)));
    if (withMean) {
        const y = top + rowHeight * (rows.length + 0.5) + (narrow ? 8 : 0);
        svg.append(draw("line", {class: "rule", x1: 0, x2: width, y1: top + rowHeight * rows.length, y2: top + rowHeight * rows.length}));
        drawRow("geometric mean", errors.map((error, k) => ({error, speedup: means[k]})), y, true);
    }
    return svg;
}

function speedTable(rows, errors, method, baseline, block) {
    const head = errors.flatMap((e) => [`${errorLevel(e, block)}: ${method}`, baseline, TIMES]);
    return make("div", {class: "scroll", tabindex: 0, role: "region", "aria-label": "times at equal error"}, make("table", {},
        make("thead", {}, make("tr", {}, make("th", {scope: "col"}, "scene"), head.map((h) => make("th", {scope: "col", class: "number"}, h)))),
        make("tbody", {}, rows.map((row) => make("tr", {}, make("th", {scope: "row"}, row.scene), errors.map((error) => {
            const e = row.entries.find((entry) => entry.error === error);
            if (!e) {
                return [make("td"), make("td"), make("td")];
            }
            return [make("td", {class: "number"}, duration(e.ms)),
                make("td", {class: "number", title: e.baseline}, e.measured === false && isNumber(e.baseline_ms) ? "about " : "", duration(e.baseline_ms)),
                make("td", {class: "number"}, isNumber(e.speedup) ? (e.measured === false ? "about " : "") + times(e.speedup) : speedReason(e, method, baseline))];
        }))))));
}

// A mean in large figures; bold where at least two thirds of the scenes have it.
function meanFigure(m, words) {
    const text = (m.extrapolated > 0 ? "about " : "") + times(m.geometric_mean);
    const scenes = `geometric mean of ${m.scenes}${isNumber(m.of) ? ` of ${m.of}` : ""} scene${m.scenes === 1 && !(m.of > 1) ? "" : "s"}${m.extrapolated > 0 ? `, ${m.extrapolated} of ${m.scenes} extrapolated` : ""}`;
    return make("p", {class: "figure"}, 3 * m.scenes >= 2 * (m.of ?? m.scenes) ? make("strong", {}, text) : make("span", {class: "few"}, text),
        make("span", {}, `${words}, ${scenes}`));
}

// A row for each preset: its error and time, and what a baseline takes to that error, by each of the measures.
function presets(report) {
    const all = list(report.presets), baseline = baselineName(report);
    const names = [...new Set(all.map((p) => `${p.method}, ${p.preset}`))], blocks = [...new Set(all.map((p) => p.block))].sort((a, b) => b - a);
    if (all.length === 0) {
        return null;
    }
    const found = (name, block) => all.find((p) => `${p.method}, ${p.preset}` === name && p.block === block) || {};
    const mean = (p) => (isNumber(p.geometric_mean) ? [(p.extrapolated > 0 ? "about " : "") + times(p.geometric_mean), make("small", {}, ` ${p.scenes} of ${p.of}`)] : NONE);
    const missing = all.filter((p) => list(p.missing).length > 0), usual = names.find((n) => n.endsWith("normal")) ?? names[0];
    return make("section", {id: "presets"}, make("h2", {}, "What a user gets who sets nothing but the quality"),
        make("p", {}, `Geometric means of error and time and, ${TIMES}, of how many times as long ${baseline} takes to the error that the preset has in a scene: all three over the same scenes, those in which all three are known.`),
        make("div", {class: "figures"}, blocks.map((b) => [found(usual, b), b]).filter(([p]) => isNumber(p.geometric_mean)).map(([p, b]) =>
            meanFigure(p, `the time of ${baseline} over that of ${usual}, at its ${b > 0 ? `${percent(p.error)} error over ${blockName(b)}` : `FLIP of ${amount(p.error, b)}`}`))),
        make("div", {class: "scroll", tabindex: 0, role: "region", "aria-label": "presets"}, make("table", {},
            make("thead", {}, make("tr", {}, make("th", {scope: "col"}, "preset"),
                blocks.flatMap((b) => [errorOver(b), "time", TIMES]).map((h) => make("th", {scope: "col", class: "number"}, h)))),
            make("tbody", {}, names.map((name) => make("tr", {}, make("th", {scope: "row"}, name),
                blocks.map((b) => [make("td", {class: "number"}, amount(found(name, b).error, b)), make("td", {class: "number"}, duration(found(name, b).ms)),
                    make("td", {class: "number"}, mean(found(name, b)))])))))),
        missing.length > 0 && make("details", {}, make("summary", {}, "Left out of the means"),
            make("ul", {}, missing.map((p) => make("li", {}, `${p.method}, ${p.preset}, ${errorOver(p.block)}: ${list(p.missing).join("; ")}`)))));
}

function headline(report) {
    const all = list(report.headline), methods = [...new Set(all.map((h) => h.method))];
    const baseline = baselineName(report), blocks = [...new Set(all.map((h) => h.block))].sort((a, b) => b - a);
    if (all.length === 0) {
        return null;
    }
    const choice = {
        method: methods.includes("pop") ? "pop" : methods[0],
        block: blocks[0],
    };
    const body = make("div");
    const show = () => {
        const {method, block} = choice;
        const entries = all.filter((h) => h.method === method && h.block === block)
            .sort((a, b) => b.error - a.error);
        const rows = speedRows(report, method, block);
        const errors = [...new Set([...entries, ...rows.flatMap((r) => r.entries)].map((e) => e.error))].sort((a, b) => b - a).slice(0, 4);
        const means = errors.map((error) => (entries.find((e) => e.error === error) || {}).geometric_mean);
        const chart = make("figure", {class: "chart"});
        onWidth(chart, (width) => {
            chart.replaceChildren(speedChart(width, rows, errors, means, method, baseline, block),
                make("figcaption", {}, errors.map((e, k) => make("span", {class: "key"},
                    draw("svg", {class: "marker", width: 13, height: 13, viewBox: "-6.5 -6.5 13 13", "aria-hidden": "true"},
                        draw("path", {class: k === 0 ? "mark" : "mark hollow", d: SPEED_MARKS[k % 4]})), block > 0 ? `at ${level(e)} error` : `at FLIP ${axisValue(e)}`)),
                    rows.some((r) => r.entries.some((e) => e.measured === false && isNumber(e.speedup))) && make("span", {}, "pale: extrapolated"),
                    make("span", {}, `right of 1${TIMES}: ${method} is faster; left: ${baseline} is`)));
        });
        const missing = entries.flatMap((e) => list(e.missing).map((m) => `${errorLevel(e.error, block)}: ${m}`));
        body.replaceChildren(
            make("div", {class: "figures"}, entries.map((e) => meanFigure(e,
                `the time of ${baseline} over that of ${method} at ${block > 0 ? `${level(e.error)} error` : `FLIP ${axisValue(e.error)}`}`))),
            chart,
            make("details", {}, make("summary", {}, "The times behind it"), speedTable(rows, errors, method, baseline, block)),
            missing.length > 0 ? make("details", {}, make("summary", {}, `Left out of the means: ${missing.length}`),
                make("ul", {}, missing.map((m) => make("li", {}, m)))) : "");
    };
    const control = (label, values, key, text) => values.length > 1 &&
        segmented(label, values.map((v) => [v, text(v)]), choice[key], (v) => { choice[key] = v; show(); });
    show();
    return make("section", {id: "equal-error"},
        make("h2", {}, "At equal error, by the best of all settings"),
        make("div", {class: "controls"},
            control("method", methods, "method", (v) => v),
            control("error over", blocks, "block", blockName)),
        body);
}

// Scenes of renderers of others that are in no figure of the report.
function peersLeftOut(report) {
    const absent = list(report.peers_left_out);
    return absent.length > 0 && make("section", {id: "peers-left-out"}, make("h2", {}, "Renderers of others: left out"),
        make("ul", {}, absent.map((p) => make("li", {}, `${p.name}, ${p.scene}: ${p.why}`))));
}

function verdictList(styles, verdicts) {
    return make("ul", {class: "verdicts"}, verdicts.map((v) => {
        const style = groupOfSentence(styles, v);
        return make("li", {}, style ? marker(style) : "", make("span", {}, unbroken(v)));
    }));
}

// A number stays with its per cent sign.
function unbroken(text) {
    return String(text).replace(/ %/g, `${NARROW}%`);
}

// Yes or no, and where not: a line of its own for each scene.
function promiseLine(promise) {
    return promise && make("p", {class: promise.holds ? "promise kept" : "promise"},
        make("strong", {}, promise.holds ? "yes " : "no "), make("span", {}, unbroken(promise.text)));
}

function promiseSummary(scenes) {
    const said = scenes.map(([scene]) => scene.promise).filter(Boolean), kept = said.filter((p) => p.holds).length;
    return said.length > 0 && make("p", {}, `${said[0].method} should be on the front at all errors above 3${NARROW}% and above 1.2 times the least that it reaches in a scene. `,
        make("strong", {}, `So it is in ${kept} of ${said.length} scene${said.length === 1 ? "" : "s"}.`));
}

function verdicts(report, styles) {
    const scenes = list(report.scenes).map((scene, i) => [scene, i]).filter(([s]) => list(s.verdicts).length > 0);
    return scenes.length > 0 && make("section", {id: "verdicts"},
        make("h2", {}, "Who wins where"),
        promiseSummary(scenes),
        make("div", {class: "verdict-grid"}, scenes.map(([scene, i]) => make("div", {},
            make("h3", {}, make("a", {href: `#scene-${i}`}, scene.name)), promiseLine(scene.promise), verdictList(styles, list(scene.verdicts))))));
}
