// main.js -- the page, from the report it holds.

const blocksOf = (scene) => {
    const blocks = new Set(list(scene.runs).flatMap((run) => list(run.errors).map((e) => e.block)).filter(isNumber));
    return [...(blocks.size ? blocks : [8])].sort((a, b) => b - a);
};

function regimeWords(regime) {
    const r = regime || {};
    const number = (name, value) => (isNumber(value) ? `${name} ${digits(value, 2)}`
        : list(value).some(isNumber) ? `${name} ${list(value).map((v) => digits(v, 2)).join(" / ")}` : null);
    return [number("optical depth", r.optical_depth), number("albedo", r.albedo), number("g", r.g),
        list(r.lights).length > 0 ? `light: ${list(r.lights).join(", ")}` : null].filter(Boolean).join("; ");
}

function referenceWords(scene) {
    const r = scene.reference || {};
    const noise = list(r.noise).map((n) => (n.block > 0 ? `${percent(n.n)} over ${blockName(n.block)}` : `${digits(n.n)} by FLIP`)).join(", ");
    return [r.method === "file" ? "from a file" : `${r.method ?? "path"}${isNumber(r.spp) ? `, ${r.spp} samples a pixel` : ""}`,
        noise && `noise ${noise}`, isNumber(r.seconds) && r.seconds > 0 ? `made in ${duration(1e3 * r.seconds)}` : null,
        r.stored ? "stored with the suite" : r.cached ? "from the cache" : null].filter(Boolean).join("; ");
}

// The run that is shown first: the best of the promised method on the front, else the best of any method.
function firstRun(scene, block) {
    const runs = list(scene.runs), front = frontOf(scene, block);
    const good = runs.map((run, i) => [run, i]).filter(([run]) => !run.failed && isNumber(errorsOf(run, block).error));
    const best = (entries) => entries.sort((a, b) => errorValue(errorsOf(a[0], block)) - errorValue(errorsOf(b[0], block)))[0];
    const promised = good.filter(([r]) => r.method === scene.promise?.method);
    const found = best(promised.filter(([r]) => front.has(r.key))) || best(promised) || best(good);
    return found ? found[1] : runs.length > 0 ? 0 : -1;
}

function sceneSection(report, styles, scene, index) {
    const blocks = blocksOf(scene), first = firstRun(scene, blocks[0]);
    const details = make("div", {class: "inspector", "aria-live": "polite"});
    const viewer = pictureViewer(scene, index, first);
    const select = (run) => {
        plot.mark(run);
        table.mark(run);
        viewer.choose(run);
        details.replaceChildren(runDetails(report, scene, styles, run));
    };
    const plot = errorPlot(scene, styles, select), table = runTable(scene, styles, select);
    plot.show(blocks[0]);
    plot.mark(first);
    table.mark(first);
    details.append(runDetails(report, scene, styles, first));
    const failed = list(scene.runs).filter((run) => run.failed).length;
    return make("section", {id: `scene-${index}`, class: "scene"},
        make("h2", {}, scene.name),
        make("p", {class: "regime"}, [`${list(scene.size).join(TIMES)} pixels`, isNumber(scene.fill) ? `${percent(scene.fill)} of them see the medium` : null,
            regimeWords(scene.regime)].filter(Boolean).join("; "), make("br"), make("span", {}, `Reference: ${referenceWords(scene)}.`)),
        list(scene.verdicts).length > 0 && verdictList(styles, list(scene.verdicts)),
        make("div", {class: "columns"},
            make("div", {class: "column"},
                make("div", {class: "controls"}, blocks.length > 1 && segmented("error over", blocks.map((b) => [b, blockName(b)]), blocks[0], plot.show)),
                plot.element),
            viewer.element && make("div", {class: "column"}, viewer.element)),
        make("h3", {}, "Runs", make("small", {}, ` ${list(scene.runs).length}${failed ? `, ${failed} of which could not be done` : ""}; \u2605 on a front`)),
        table.element,
        list(scene.left_out).length > 0 && make("details", {}, make("summary", {}, `Not run: ${list(scene.left_out).length}`),
            make("ul", {}, list(scene.left_out).map((r) => make("li", {}, `${r.run}: ${r.why}`)))),
        details);
}

function ratioList(ratios) {
    return list(ratios).length > 0 && make("section", {id: "ratios"}, make("h2", {}, "Ratios of frames after the light has changed"),
        make("ul", {}, list(ratios).map((r) => make("li", {}, `${r.name}${r.run ? `, ${r.run}` : ""}: ${times(r.times)}`))));
}

function notes(report) {
    const entry = (name, text) => [make("dt", {}, name), make("dd", {}, text)];
    return make("section", {id: "notes", class: "notes"}, make("h2", {}, "How to read it"), make("dl", {},
        entry("error", "rel_l1, sum of |x - r| over sum of |r| of linear radiance, without what the noise of the reference explains: sqrt(rel_l1\u00b2 - n\u00b2). Over blocks, the pixels of a block are averaged first. \u201c\u2264\u201d: the noise hides it, and it is this or less; \u201c~\u201d: below twice the noise, where it comes out too small. A sampling method's own noise is an error of it."),
        entry("time", "Medians, wall clock from submission to the end; of path the whole rendering, which begins anew whatever changes. As chosen at the top: the first picture (the driver is warm, everything else is made from nothing); the medium has changed (grids are uploaded, every node runs); the light has changed (every node runs but those of the media); the camera has moved (what does not depend on it is as it was)."),
        report.scenes.some((scene) => list(scene.peers).length > 0) && entry("peers", `${[...new Set(report.scenes.flatMap((scene) => list(scene.peers).map((p) => p.name)))].join(", ")}: rendered by others than this library and measured apart, by the time of rendering alone. They are drawn, and listed among the runs; fronts, verdicts and means leave them out.`),
        entry("equal error", "The time of the cheapest run of a method that has this error, interpolated along its line in the plot; \u201cabout\u201d where it had to be extrapolated."),
        entry("ceilings", "What the device reached in kernels that do one thing only, in the same run; a node's share is the time that its work would take at that ceiling over the time it took."),
        entry("difference", "Left minus right, mean of the channels, as a share of the reference's mean radiance. Pictures are in the page as linear half floats (steps of 0.05\u00a0%), tone-mapped here. Magenta is not a number."),
        entry("citing", "Every run has a key: the hash of everything that went in. The record of that name is in the folder of the report.")));
}

function contents(report) {
    const link = (id, text) => make("a", {href: `#${id}`}, text);
    return make("nav", {class: "contents", "aria-label": "contents"}, list(report.presets).length > 0 && link("presets", "presets"), link("equal-error", "equal error"),
        list(report.scenes).some((scene) => list(scene.verdicts).length > 0) && link("verdicts", "who wins"),
        list(report.scenes).map((scene, i) => link(`scene-${i}`, scene.name)),
        list((report.stress || {}).cells).length > 0 && link("stress", "stress"), link("notes", "how to read it"));
}

// The report with what it says with one of the times in the place of what it says of frames after the light has changed.
function reportWith(report, frame) {
    return {...report, headline: list(report.headline).filter((h) => h.frame === frame), presets: list(report.presets).filter((p) => p.frame === frame),
        scenes: list(report.scenes).map((scene) => ({...scene, ...(scene.times || {})[frame]}))};
}

// All that compares times.
function comparisons(report, styles) {
    return [presets(report), headline(report), verdicts(report, styles),
        ...list(report.scenes).map((scene, i) => sceneSection(report, styles, scene, i))].filter(Boolean);
}

// The same with each of the times, as chosen.
function chosenComparisons(report, styles) {
    const holder = make("div", {class: "comparisons"});
    const show = (frame) => {
        frameShown = frame;
        onScreen.abort();
        onScreen = new AbortController();
        holder.replaceChildren(...comparisons(reportWith(report, frame), styles));
    };
    show("animated_light");
    const frames = Object.entries(FRAMES).filter(([frame]) => list(report.headline).some((h) => h.frame === frame));
    const choice = frames.length > 1
        && make("div", {id: "frame", class: "controls"}, make("span", {}, "Times of"), segmented("times of", frames, "animated_light", show));
    return [choice, holder];
}

function startPage() {
    const page = document.getElementById("page");
    const report = JSON.parse(document.getElementById("report").textContent);
    if (report.schema !== "tyndall-report" || report.version !== 2) {
        page.append(make("p", {class: "alert"}, `This page shows reports of schema tyndall-report, version 2, not ${report.schema} ${report.version}.`));
        return;
    }
    const styles = groupStyles(report);
    page.append(...[pageHead(report), contents(report), bandsAlert(report.bands),
        chosenComparisons(report, styles), peersLeftOut(report), ratioList(report.ratios), stressSection(report.stress, styles), notes(report),
        make("footer", {}, `Tyndall ${report.tyndall ?? ""}. Made by tyndall bench; the figures are those of report.json.`)]
        .flat().filter(Boolean));
    // On paper everything that can be opened is open.
    const opened = new Set();
    addEventListener("beforeprint", () => page.querySelectorAll("details:not([open])").forEach((d) => { opened.add(d); d.open = true; }));
    addEventListener("afterprint", () => { opened.forEach((d) => { d.open = false; }); opened.clear(); });
}

startPage();
