// runs.js -- the runs of a scene: the table, and all about one of them.

const worst = (values) => (list(values).some(isNumber)
    ? list(values).filter(isNumber).reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a)) : null);
const memoryOf = (run) => (run.memory ? (run.memory.persistent || 0) + (run.memory.transient || 0) : null);
const spoiled = (run) => (run.non_finite || 0) + (run.negative || 0);

// Columns: [heading, what it is, value to sort by, text]. Blocks: those of the scene's errors.
function runColumns(blocks) {
    const error = (block) => [blockName(block).replace(" pixels", " px").replace("single px", "1 px"), errorOver(block),
        (run) => errorValue(errorsOf(run, block)), (run) => errorText(errorsOf(run, block))];
    return [
        ...blocks.map(error),
        ["bias", "mean of the picture over that of the reference, less 1", (run) => errorsOf(run, blocks[0]).bias,
            (run) => signedPercent(errorsOf(run, blocks[0]).bias)],
        ...[["first", "a first picture: the driver is warm, everything else is made from nothing", "first_picture"],
            ["medium", "a frame after the medium has changed", "animated_medium"], ["light", "a frame after the light has changed", "animated_light"],
            ["camera", "a frame after the camera has moved", "camera_moved"], ["same", "a frame in which nothing has changed", "unchanged"]]
            .map(([heading, about, key]) => [heading, about, (run) => (run.frame_ms || {})[key], (run) => duration((run.frame_ms || {})[key])]),
        ["set-up", "pipelines, uploads, what depends on the media alone", (run) => run.setup_ms, (run) => duration(run.setup_ms)],
        ["MiB", "all images and buffers", memoryOf, (run) => mebibytes(memoryOf(run))],
        ["flicker", "what of the picture changes from frame to frame as the camera moves and should not", (run) => run.flicker, (run) => percent(run.flicker)],
        ["balance", "imbalance of energy, the worst channel", (run) => { const w = worst(run.imbalance); return w === null ? null : Math.abs(w); },
            (run) => signedPercent(worst(run.imbalance))],
        ["warnings", "warnings of the run; values that are not finite or negative", (run) => list(run.warnings).length + 1e3 * spoiled(run),
            (run) => (spoiled(run) > 0 ? `${spoiled(run)} bad values` : list(run.warnings).length || "")],
    ];
}

// Returns {element, mark(index)}.
function runTable(scene, styles, select) {
    const blocks = blocksOf(scene), columns = runColumns(blocks), fronts = blocks.map((b) => frontOf(scene, b));
    const rows = list(scene.runs).map((run, index) => {
        const style = styles.get(String(run.group ?? run.method));
        const on = blocks.filter((b, k) => fronts[k].has(run.key));
        const button = make("button", {type: "button", class: "run", onclick() { select(index); }}, marker(style), run.name);
        const element = make("tr", {"data-run": index, onclick() { select(index); }},
            make("th", {scope: "row"}, button, on.length > 0 && make("span", {class: "star", title: `on the front over ${on.map(blockName).join(" and ")}`}, "\u2605")),
            run.failed ? make("td", {colspan: columns.length, class: "failed"}, run.failed)
                : columns.map(([, , , text], k) => make("td", {class: `number${k === columns.length - 1 && spoiled(run) ? " bad" : ""}`}, text(run))));
        return {run, index, element, group: style.index};
    });
    const body = make("tbody"), heads = [];
    const fill = (compare) => { body.replaceChildren(...rows.sort(compare).map((r) => r.element)); };
    const sortable = ([heading, about, value], numeric) => {
        const head = make("th", {scope: "col", class: numeric ? "number" : null, "aria-sort": "none"}, make("button", {
            type: "button", title: about,
            onclick() {
                const up = head.getAttribute("aria-sort") !== "ascending", sign = up ? 1 : -1;
                heads.forEach((h) => h.setAttribute("aria-sort", "none"));
                head.setAttribute("aria-sort", up ? "ascending" : "descending");
                fill((a, b) => { // what has no value comes last either way
                    const x = value(a.run), y = value(b.run);
                    return numeric ? isNumber(y) - isNumber(x) || (isNumber(x) ? sign * (x - y) : 0) || a.index - b.index
                                   : sign * (String(x).localeCompare(String(y), "en", {numeric: true}));
                });
            },
        }, heading));
        heads.push(head);
        return head;
    };
    const head = make("thead", {}, make("tr", {},
        sortable(["run", "name of the run", (run) => run.name], false), columns.map((c) => sortable(c, true))));
    fill((a, b) => a.index - b.index);
    const element = make("div", {class: "scroll tall", tabindex: 0, role: "region", "aria-label": `runs on ${scene.name}`},
        make("table", {class: "runs"}, head, body));
    return {
        element,
        mark(index) { rows.forEach((r) => r.element.classList.toggle("current", r.index === index)); },
    };
}

// ---- one run ----------------------------------------------------------------------------------

const CEILINGS = {fma: "multiply-add", copy: "copy", trilinear: "trilinear fetch", exp: "exp", dispatch: "dispatch"};

function nodeBars(run) {
    const nodes = list(run.nodes).filter((n) => isNumber(n.gpu_ms) && n.gpu_ms > 0);
    const longest = Math.max(...nodes.map((n) => n.gpu_ms));
    if (nodes.length === 0) {
        return null;
    }
    return make("div", {class: "nodes"}, make("h4", {}, "Time by node"),
        make("table", {}, make("colgroup", {}, ["name", "time", "bar", "limit"].map((c) => make("col", {class: c}))), make("thead", {class: "unseen"}, make("tr", {}, ["node", "time", "bar", "of the ceiling"].map((h) => make("th", {scope: "col"}, h)))),
            make("tbody", {}, nodes.map((n) => {
                const share = 100 * n.gpu_ms / longest, fraction = isNumber(n.fraction) ? clamp(n.fraction, 0, 1) : 0;
                const limit = isNumber(n.fraction) && n.ceiling ? `${percent(n.fraction)} of ${CEILINGS[n.ceiling] ?? n.ceiling}` : "";
                return make("tr", {}, make("th", {scope: "row"}, make("code", {}, n.name), n.setup && make("small", {}, " at set-up")),
                    make("td", {class: "number"}, duration(n.gpu_ms)),
                    make("td", {class: "bar"}, draw("svg", {width: "100%", height: 10, "aria-hidden": "true"},
                        draw("rect", {class: n.setup ? "whole setup" : "whole", width: `${share}%`, height: 10}),
                        draw("rect", {class: "part", width: `${share * fraction}%`, height: 10}))),
                    make("td", {class: "limit"}, limit));
            }))),
        nodes.some((n) => isNumber(n.fraction)) &&
            make("p", {class: "note"}, "In full colour: the part of the time that the device's ceiling alone would need."));
}

function citation(report, scene, run) {
    const device = report.device || {}, reference = scene.reference || {};
    const errors = list(run.errors).map((e) =>
        `${errorText(e, 3)} ${e.block > 0 ? `over ${blockName(e.block)}` : "by FLIP"} (noise of the reference ${amount(e.n, e.block)})`).join("; ");
    const inputs = Object.entries(run.inputs || {}).map(([k, v]) => `${k} ${v}`).join(", ");
    return [
        `Tyndall ${report.tyndall}, suite ${(report.suite || {}).name} (${(report.suite || {}).hash})`,
        `scene ${scene.name}, ${list(scene.size).join(TIMES)} pixels (${scene.hash})`,
        `run ${run.name}: ${run.peer ? "" : `method ${run.method}; `}${settingsText(run.settings) || "default settings"}; seed ${run.seed ?? NONE}`,
        `error ${errors || NONE}`,
        `time ${duration(lightOf(run))}${run.peer ? " of rendering alone" : " after the light has changed"}${run.frames ? `, median of ${run.frames.animated_light}` : ""}`,
        `reference ${reference.method}${isNumber(reference.spp) ? `, ${reference.spp} samples a pixel, seed ${reference.seed}` : ""} (${reference.key})`,
        run.peer ? `device ${run.device ?? NONE}` : `device ${device.name}; driver ${device.driver}`,
        inputs && `inputs ${inputs}`,
        `date ${run.date ?? report.date}; ${run.peer ? "not of this library: from a file of the suite's peers" : `record ${run.key}`}`,
    ].filter(Boolean).join("\n").replaceAll(NARROW, " ");
}

function runDetails(report, scene, styles, index) {
    const run = list(scene.runs)[index];
    if (!run) {
        return make("div");
    }
    const style = styles.get(String(run.group ?? run.method));
    const text = citation(report, scene, run), record = make("pre", {tabindex: 0}, text);
    const copy = make("button", {type: "button", onclick() { copyText(text, record, copy); }}, "copy");
    const imbalance = list(run.imbalance).some(isNumber)
        ? list(run.imbalance).map((v, c) => signedPercent(v) + (list(run.imbalance_se)[c] > 0 ? ` \u00b1${NARROW}${percent(run.imbalance_se[c])}` : "")).join(" / ") : null;
    const errorLine = (e) => [errorOver(e.block), e.block > 0
        ? `${errorText(e)} (measured ${percent(e.rel_l1)}, noise ${percent(e.n)}); rms ${percent(e.rel_rmse)}, bias ${signedPercent(e.bias)}, 95th percentile ${percent(e.p95)}`
        : `${errorText(e)}, what noise of the reference gives alone: ${digits(e.n)}`];
    const frame = run.frame_ms || {};
    return make("div", {class: "details"},
        make("h3", {}, marker(style, 15), run.name),
        run.failed && make("p", {class: "bad"}, run.failed),
        spoiled(run) > 0 && make("p", {class: "bad"}, `${run.non_finite || 0} values not finite, ${run.negative || 0} negative`),
        facts([
            ["method", run.method], ["settings", settingsText(run.settings) || "defaults"],
            ...list(run.errors).map(errorLine),
            ["frame: first, medium, light, camera, unchanged", [...Object.keys(FRAMES), "unchanged"].map((k) => duration(frame[k])).join(", ")
                + (run.frames ? ` (medians of ${[...Object.keys(FRAMES), "unchanged"].map((k) => run.frames[k] ?? 0).join(", ")})` : "")],
            ["set-up", duration(run.setup_ms)],
            ["memory", run.memory ? `${mebibytes(run.memory.persistent)} MiB kept, ${mebibytes(run.memory.transient)} MiB a frame` : null],
            ["flicker", isNumber(run.flicker) ? percent(run.flicker) : null],
            ["imbalance of energy (R / G / B)", imbalance],
        ]),
        list(run.warnings).length > 0 && make("ul", {class: "warnings"}, list(run.warnings).map((w) => make("li", {}, w))),
        nodeBars(run),
        run.all_settings && make("details", {class: "everything"}, make("summary", {}, "All settings in effect"),
            make("p", {class: "note"}, settingsText(run.all_settings))),
        make("div", {class: "cite"}, make("h4", {}, "To cite it", copy), record));
}
