// plot.js -- error against time, log-log: a line per group, the front, the noise of the reference.

const plotTicks = (low, high, room) => { // exponents, pixels of a decade -> [value, labelled]
    const ticks = [], few = room > 110;
    for (let decade = Math.floor(low); decade <= Math.ceil(high); decade++) {
        for (let step = 1; step < 10; step++) {
            const value = step * 10 ** decade, log = Math.log10(value);
            if (log >= low - 1e-9 && log <= high + 1e-9 && (room > 60 || step === 1)) {
                ticks.push([value, step === 1 || (few && (step === 2 || step === 5))]);
            }
        }
    }
    return ticks;
};

// The points of a group that no other of it beats in both error and time.
function ownFront(points) {
    let best = Infinity;
    return [...points].sort((a, b) => a.ms - b.ms || a.error - b.error).filter((p) => {
        const better = p.error < best;
        best = better ? p.error : best;
        return better;
    });
}

// `select` is called with the index of a run. Returns {element, show(block), mark(index)}.
function errorPlot(scene, styles, select) {
    const element = make("figure", {class: "plot"}), hidden = new Set();
    const tip = make("div", {class: "tip", role: "tooltip", hidden: true});
    const holder = make("div", {class: "holder"});
    const legend = make("div", {class: "legend", role: "group", "aria-label": "lines of the plot"});
    let block = 8, width = 640, current = -1, points = [];

    const runsOf = () => list(scene.runs).map((run, index) => ({
        run, index, style: styles.get(String(run.group ?? run.method)),
        ms: timeOf(run), error: errorValue(errorsOf(run, block)), hidden: isHidden(errorsOf(run, block)),
    })).filter((p) => !p.run.failed && isNumber(p.ms) && p.ms > 0 && isNumber(p.error));

    function describe(p) {
        return `${p.run.name}: ${block > 0 ? "error" : "FLIP"} ${errorText(errorsOf(p.run, block))}, ${duration(p.ms)}`;
    }

    function showTip(p, target) {
        const box = target.getBoundingClientRect(), frame = holder.getBoundingClientRect();
        const noise = errorsOf(p.run, block).n;
        tip.replaceChildren(make("strong", {}, marker(p.style), p.run.name),
            make("span", {}, `${block > 0 ? "error" : "FLIP"} ${errorText(errorsOf(p.run, block))}, noise of the reference ${amount(noise, block)}, ${duration(p.ms)}`),
            make("span", {}, settingsText(p.run.settings)),
            ...list(p.run.warnings).slice(0, 2).map((w) => make("span", {class: "warning"}, w)));
        tip.hidden = false;
        const x = box.x + box.width / 2 - frame.x, y = box.y - frame.y;
        const left = clamp(x - tip.offsetWidth / 2, 0, Math.max(0, frame.width - tip.offsetWidth));
        const above = y - tip.offsetHeight - 8;
        tip.style.left = `${left}px`;
        tip.style.top = `${above > -30 ? above : y + box.height + 8}px`;
    }

    function step(from, by) {
        const order = [...points].sort((a, b) => a.ms - b.ms || a.error - b.error).filter((p) => !hidden.has(p.style.name));
        const next = order[clamp(order.findIndex((p) => p.index === from) + by, 0, order.length - 1)];
        const target = next && holder.querySelector(`[data-run="${next.index}"]`);
        if (target) {
            holder.querySelectorAll(".point").forEach((g) => g.setAttribute("tabindex", g === target ? 0 : -1));
            target.focus();
        }
    }

    function keys(event, p) {
        const by = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, Home: -1e6, End: 1e6}[event.key];
        if (by) {
            event.preventDefault();
            step(p.index, by);
        } else if (event.key === "Enter" || event.key === " ") {
            event.preventDefault();
            select(p.index);
        } else if (event.key === "Escape") {
            tip.hidden = true;
        }
    }

    function render() {
        points = runsOf();
        const noise = (list((scene.reference || {}).noise).find((n) => n.block === block) || {}).n;
        const shown = points.filter((p) => !hidden.has(p.style.name));
        if (points.length === 0) {
            holder.replaceChildren(make("p", {class: "note"}, "No run has an error and a time here."));
            return;
        }
        const height = Math.round(clamp(width * 0.8, 300, 520));
        const left = 48, right = 12, top = 24, bottom = 42;
        const logs = (f) => points.map(f).filter((v) => v > 0).map(Math.log10);
        const ys = logs((p) => p.error).concat(noise > 0 ? [Math.log10(noise)] : []);
        const span = (values, pad) => {
            const low = Math.min(...values), high = Math.max(...values), extra = Math.max(pad, 0.04 * (high - low));
            return [low - extra, high + extra];
        };
        const [x0, x1] = span(logs((p) => p.ms), 0.12), [y0, y1] = span(ys.length ? ys : [-2, 0], points.some((p) => p.hidden) ? 0.22 : 0.14);
        const X = (ms) => left + (width - left - right) * (Math.log10(ms) - x0) / (x1 - x0);
        const base = height - bottom; // what is below the noise stands at it, with an arrow
        const Y = (error) => (error > 0 ? top + (base - top) * (y1 - Math.log10(error)) / (y1 - y0) : base - 12);
        const hatch = `hatch-${scene.name}`.replace(/[^\w-]/g, "_");
        const svg = draw("svg", {class: "error-plot", width, height, viewBox: `0 0 ${width} ${height}`, role: "group",
            "aria-label": `${scene.name}: ${errorOver(block)} against time, ${points.length} runs; arrow keys go from point to point`},
            draw("defs", {}, draw("pattern", {id: hatch, width: 6, height: 6, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)"},
                draw("line", {class: "hatch", x1: 0, x2: 0, y1: 0, y2: 6}))));

        for (const [value, labelled] of plotTicks(x0, x1, (width - left - right) / (x1 - x0) * 0.8)) {
            svg.append(draw("line", {class: labelled ? "grid" : "grid faint", x1: X(value), x2: X(value), y1: top, y2: base}));
            if (labelled) {
                svg.append(draw("text", {class: "tick", x: X(value), y: base + 16, "text-anchor": "middle"}, duration(value).replace(/\.0+(?=\D)|(?<=\.\d*[1-9])0+(?=\D)/, "")));
            }
        }
        for (const [value, labelled] of plotTicks(y0, y1, (base - top) / (y1 - y0) * 1.4)) {
            svg.append(draw("line", {class: labelled ? "grid" : "grid faint", x1: left, x2: width - right, y1: Y(value), y2: Y(value)}));
            if (labelled) {
                svg.append(draw("text", {class: "tick", x: left - 6, y: Y(value) + 4, "text-anchor": "end"}, errorLevel(value, block)));
            }
        }
        if (noise > 0) {
            const y = Y(noise), above = base - y < 16;
            svg.append(draw("rect", {x: left, y, width: width - left - right, height: Math.max(0, base - y), fill: `url(#${hatch})`}),
                draw("line", {class: "noise", x1: left, x2: width - right, y1: y, y2: y}),
                draw("text", {class: "noise-word", x: left + 5, y: above ? y - 5 : y + 14},
                    `noise of the reference, ${amount(noise, block)}`));
        }
        svg.append(draw("text", {class: "axis", x: (left + width - right) / 2, y: height - 6, "text-anchor": "middle"}, `time of ${FRAMES[frameShown]}`),
            draw("text", {class: "axis", x: 0, y: 12}, errorOver(block)));

        const keysOnFront = frontOf(scene, block);
        const front = points.filter((p) => keysOnFront.has(p.run.key)).sort((a, b) => a.ms - b.ms);
        if (front.length > 0) {
            const path = front.map((p, i) => (i === 0 ? `M${X(p.ms)},${Y(p.error)}` : `H${X(p.ms)}V${Y(p.error)}`)).join("");
            svg.append(draw("path", {class: "front", d: `${path}H${width - right}`}));
        }
        for (const style of styles.values()) {
            const own = ownFront(shown.filter((p) => p.style === style));
            if (own.length > 1) {
                svg.append(draw("path", {class: "line", d: "M" + own.map((p) => `${X(p.ms)},${Y(p.error)}`).join("L"),
                    stroke: style.color, "stroke-dasharray": style.dash}));
            }
        }
        const size = width < 420 || points.length > 36 ? 0.78 : 1;
        const focusable = shown.some((p) => p.index === current) ? current : (shown[0] || {}).index;
        const best = new Set([...styles.values()].flatMap((s) => ownFront(shown.filter((p) => p.style === s)).map((p) => p.index)));
        for (const p of [...shown].sort((a, b) => best.has(a.index) - best.has(b.index))) {
            const onFront = keysOnFront.has(p.run.key);
            const group = draw("g", {
                class: `point${best.has(p.index) ? "" : " beaten"}${onFront ? " on-front" : ""}${p.index === current ? " current" : ""}`,
                transform: `translate(${X(p.ms)} ${Y(p.error)})`, tabindex: p.index === focusable ? 0 : -1, role: "button",
                "data-run": p.index, "aria-label": describe(p) + (onFront ? ", on the front" : ""),
                onfocus(event) { showTip(p, event.currentTarget); }, onblur() { tip.hidden = true; },
                onpointerenter(event) { showTip(p, event.currentTarget); },
                onpointerleave(event) { tip.hidden = document.activeElement !== event.currentTarget; },
                onclick() { select(p.index); }, onkeydown(event) { keys(event, p); },
            },
            draw("circle", {class: "reach", r: 11 * size}), onFront && draw("circle", {class: "ring", r: 8.5 * size}),
            draw("path", {class: "shape", d: p.style.shape, transform: size === 1 ? null : `scale(${size})`, fill: p.style.color, stroke: p.style.color}),
            p.hidden && draw("path", {class: "below", d: "M0,6V12M-3.5,8.5L0,12L3.5,8.5", stroke: p.style.color}));
            svg.append(group);
        }
        holder.replaceChildren(svg, tip);
        tip.hidden = true;
    }

    for (const style of styles.values()) {
        if (list(scene.runs).some((run) => String(run.group ?? run.method) === style.name)) {
            const button = make("button", {type: "button", class: "key", "aria-pressed": "true", title: "shows or hides this line",
                onclick() {
                    const hide = !hidden.has(style.name);
                    hide ? hidden.add(style.name) : hidden.delete(style.name);
                    button.setAttribute("aria-pressed", String(!hide));
                    render();
                }},
                draw("svg", {class: "marker", width: 30, height: 13, viewBox: "-15 -6.5 30 13", "aria-hidden": "true"},
                    draw("path", {class: "line", d: "M-15,0H15", stroke: style.color, "stroke-dasharray": style.dash}),
                    draw("path", {d: style.shape, fill: style.color})), style.name);
            legend.append(button);
        }
    }
    legend.append(make("span", {class: "key"}, draw("svg", {class: "marker", width: 22, height: 18, viewBox: "-11 -9 22 18", "aria-hidden": "true"},
        draw("path", {class: "front", d: "M-11,0H11"}), draw("circle", {class: "ring", r: 7})), "the front: nothing is faster and better"));
    element.append(legend, holder);
    onWidth(holder, (now) => { width = now; render(); });
    return {
        element,
        show(b) { block = b; render(); },
        mark(index) {
            current = index;
            holder.querySelectorAll(".point").forEach((g) => g.classList.toggle("current", Number(g.dataset.run) === index));
        },
    };
}
