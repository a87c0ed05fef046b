// pictures.js -- pictures of a scene: a split between two of them, and their signed difference.

// ---- linear half floats, as html_picture.h packs them -----------------------------------------

const HALVES = (() => { // value of every half
    const values = new Float32Array(65536);
    for (let h = 0; h < 65536; h++) {
        const e = h >> 10 & 31, m = h & 1023;
        const size = e === 31 ? (m ? NaN : Infinity) : e ? (1024 + m) * 2 ** (e - 25) : m * 2 ** -24;
        values[h] = h & 0x8000 ? -size : size;
    }
    return values;
})();

async function unpackPicture(element) {
    const width = Number(element.dataset.width), height = Number(element.dataset.height), count = width * height;
    const packed = Uint8Array.from(atob(element.textContent), (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
    const scale = 2 ** -Number(element.dataset.exponent), planes = [];
    for (let c = 0; c < 3; c++) {
        const data = new Float32Array(count), at = 2 * count * c;
        let left = 0, above = 0;
        for (let i = 0; i < count; i++) {
            const first = i % width === 0;
            left = (bytes[at + i] << 8 | bytes[at + count + i]) + (first ? above : left) & 0xffff;
            above = first ? left : above;
            data[i] = scale * HALVES[left];
        }
        planes.push(data);
    }
    return {width, height, planes};
}

// Means over blocks of n x n pixels, in every pixel of them.
function blockMeans(picture, n) {
    const {width, height} = picture;
    const planes = picture.planes.map((data) => {
        const means = new Float32Array(data.length);
        for (let y = 0; y < height; y += n) {
            for (let x = 0; x < width; x += n) {
                const h = Math.min(n, height - y), w = Math.min(n, width - x);
                let sum = 0;
                for (let j = 0; j < h; j++) {
                    for (let i = 0; i < w; i++) {
                        sum += data[(y + j) * width + x + i];
                    }
                }
                for (let j = 0; j < h; j++) {
                    means.fill(sum / (w * h), (y + j) * width + x, (y + j) * width + x + w);
                }
            }
        }
        return means;
    });
    return {width, height, planes};
}

const finite = (picture, i) => Number.isFinite(picture.planes[0][i] + picture.planes[1][i] + picture.planes[2][i]);

function meanOf(picture) {
    let sum = 0, count = 0;
    for (let i = 0; i < picture.planes[0].length; i++) {
        if (finite(picture, i)) {
            sum += picture.planes[0][i] + picture.planes[1][i] + picture.planes[2][i];
            count += 3;
        }
    }
    return count && sum > 0 ? sum / count : 1;
}

// Exposure in EV, in half stops, that brings the brightest twentieth near white.
function exposureOf(picture) {
    const lit = [];
    for (let i = 0; i < picture.planes[0].length; i++) {
        const v = Math.max(picture.planes[0][i], picture.planes[1][i], picture.planes[2][i]);
        if (v > 0 && Number.isFinite(v)) {
            lit.push(v);
        }
    }
    lit.sort((a, b) => a - b);
    return lit.length ? clamp(Math.round(-2 * Math.log2(lit[Math.floor(0.95 * lit.length)])) / 2, -24, 24) : 0;
}

// Narkowicz's fit to the ACES transforms and the sRGB curve: what `tyndall render` does for a PNG.
const DISPLAY = (() => {
    const steps = 4096, table = new Uint8ClampedArray(steps + 1);
    for (let i = 0; i <= steps; i++) {
        const v = 0.6 * (8 * (i / steps) ** 2);
        const c = clamp((v * (2.51 * v + 0.03)) / (v * (2.43 * v + 0.59) + 0.14), 0, 1);
        table[i] = Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
    }
    return (x) => table[x > 0 ? Math.round(steps * Math.min(1, Math.sqrt(x / 8))) : 0];
})();

const NOT_FINITE = [255, 0, 220];

function paint(canvas, picture, color) {
    if (canvas.width !== picture.width || canvas.height !== picture.height) {
        canvas.width = picture.width;
        canvas.height = picture.height;
    }
    const context = canvas.getContext("2d"), image = context.createImageData(picture.width, picture.height);
    for (let i = 0; i < picture.width * picture.height; i++) {
        const [r, g, b] = color(i);
        image.data.set([r, g, b, 255], 4 * i);
    }
    context.putImageData(image, 0, 0);
}

// Signed differences: blue below 0, red above, through white (on dark pages: through black), lightness one-way
// on each side.
const FALSE_COLORS = {
    light: [[5, 48, 97], [67, 147, 195], [250, 250, 249], [214, 96, 77], [103, 0, 31]],
    dark: [[190, 228, 255], [58, 130, 200], [17, 18, 21], [205, 80, 50], [255, 214, 170]],
};
function falseColor(value, colors) { // value in [-1, 1]
    const at = (clamp(value, -1, 1) + 1) * 2, k = Math.min(3, Math.floor(at)), t = at - k;
    return colors[k].map((c, i) => c + t * (colors[k + 1][i] - c));
}

// ---- the viewer -------------------------------------------------------------------------------

// Returns {element, choose(index)}: `index` of the run to show on the left.
function pictureViewer(scene, sceneIndex, first) {
    const sources = [];
    const add = (id, name) => {
        const source = document.getElementById(`picture-${sceneIndex}-${id}`);
        source && sources.push({id, name, source, picture: null});
    };
    add("reference", "reference");
    const largest = blocksOf(scene)[0];
    list(scene.runs).forEach((run, i) => add(i, `${run.name}: ${errorText(errorsOf(run, largest))}, ${duration(timeOf(run))}`));
    const nothing = {element: null, choose() {}};
    if (sources.length === 0) {
        return nothing;
    }
    const has = (id) => sources.findIndex((s) => s.id === id);
    const state = {left: Math.max(0, has(first)), right: Math.max(0, has("reference")), split: 50, difference: false,
        gain: 3, exposure: null, blocks: false, busy: 0};
    if (state.left === state.right && sources.length > 1) {
        state.left = (state.right + 1) % sources.length;
    }

    const stage = make("div", {class: "stage", style: `aspect-ratio:${list(scene.size).join("/")}`});
    const canvases = ["left", "right", "difference"].map((name) => make("canvas", {class: name, role: "img", width: 1, height: 1}));
    const handle = make("div", {class: "handle", role: "slider", tabindex: 0, "aria-valuemin": 0, "aria-valuemax": 100,
        "aria-orientation": "horizontal"});
    const words = canvases.map((c, i) => make("span", {class: `word ${["left", "right", "difference"][i]}`}));
    stage.append(...canvases.flatMap((c, i) => make("div", {class: `layer ${["left", "right", "difference"][i]}`}, c, words[i])), handle);
    const readout = make("output", {class: "readout", "aria-live": "off"});
    const selects = ["left", "right"].map((side) => make("select", {"aria-label": `picture on the ${side}`, onchange(event) {
        state[side] = Number(event.target.value);
        update();
    }}, sources.map((s, i) => make("option", {value: i}, s.name))));
    const range = (name, min, max, step, text) => {
        const input = make("input", {type: "range", min, max, step, "aria-label": name, oninput() {
            state[name] = Number(input.value);
            update();
        }});
        const shown = make("output", {});
        return {element: make("label", {class: "range"}, make("span", {}, name), input, shown),
            set(value) { input.value = value; shown.textContent = text(value); input.setAttribute("aria-valuetext", text(value)); }};
    };
    const exposure = range("exposure", -24, 24, 0.5, (v) => `${v > 0 ? "+" : ""}${String(v).replace("-", MINUS)} EV`);
    const gain = range("gain", 0, 10, 1, (v) => 2 ** v + TIMES);
    const toggle = (label, key, name) => make("button", {type: "button", "aria-pressed": "false", "aria-keyshortcuts": key,
        onclick() { state[name] = !state[name]; update(); }}, label);
    const differenceButton = toggle("difference", "d", "difference"), blockButton = toggle(`${largest}\u00d7${largest} means`, "m", "blocks");
    const swapButton = make("button", {type: "button", "aria-keyshortcuts": "s", onclick() { swap(); }}, "swap");
    // On the right the picture of a baseline that took about as long as the one on the left.
    function equalTime() {
        const of = (s) => (typeof s.id === "number" ? scene.runs[s.id] : {}), ms = timeOf(of(sources[state.left]));
        const near = sources.map((s, i) => [i, of(s)]).filter(([, run]) => run.baseline && timeOf(run) > 0)
            .sort((a, b) => Math.abs(Math.log(timeOf(a[1]) / ms)) - Math.abs(Math.log(timeOf(b[1]) / ms)))[0];
        if (near && ms > 0) {
            state.right = near[0];
            update();
        }
    }
    const timeButton = make("button", {type: "button", "aria-keyshortcuts": "t", onclick: equalTime, title: "on the right what a baseline shows after about this time"}, "equal time");
    const scale = make("div", {class: "scale"}, make("span"), make("canvas", {width: 128, height: 1, "aria-hidden": "true"}), make("span"));
    const dark = matchMedia("(prefers-color-scheme: dark)");
    let shown = null, printing = false;

    async function load(entry) {
        entry.picture = entry.picture || await unpackPicture(entry.source);
        entry.means = entry.means || blockMeans(entry.picture, largest);
        return state.blocks ? entry.means : entry.picture;
    }

    function swap() {
        [state.left, state.right] = [state.right, state.left];
        update();
    }

    function placeSplit() {
        stage.style.setProperty("--split", `${state.split}%`);
        handle.setAttribute("aria-valuenow", Math.round(state.split));
        handle.setAttribute("aria-valuetext", `${Math.round(state.split)} percent ${sources[state.left].name}, the rest ${sources[state.right].name}`);
    }

    async function update() {
        const turn = ++state.busy;
        element.dataset.turn = turn; // drawn once "ready" is the same
        const [left, right] = await Promise.all([load(sources[state.left]), load(sources[state.right])]);
        const reference = has("reference") >= 0 ? await load(sources[has("reference")]) : right;
        if (turn !== state.busy) {
            return; // another update came meanwhile
        }
        state.exposure ??= exposureOf(reference);
        const scaleBy = 2 ** state.exposure, mean = meanOf(reference);
        const colors = dark.matches && !printing ? FALSE_COLORS.dark : FALSE_COLORS.light;
        const tone = (p) => (i) => (finite(p, i) ? p.planes.map((plane) => DISPLAY(scaleBy * plane[i])) : NOT_FINITE);
        const difference = (i) => (left.planes[0][i] + left.planes[1][i] + left.planes[2][i]
            - right.planes[0][i] - right.planes[1][i] - right.planes[2][i]) / (3 * mean);
        paint(canvases[0], left, tone(left));
        paint(canvases[1], right, tone(right));
        if (left.width === right.width && left.height === right.height) {
            const strength = 2 ** state.gain;
            paint(canvases[2], left, (i) => (Number.isFinite(difference(i)) ? falseColor(strength * difference(i), colors) : NOT_FINITE));
        }
        paint(scale.children[1], {width: 128, height: 1}, (i) => falseColor((i - 63.5) / 63.5, colors));
        scale.children[0].textContent = MINUS + percent(2 ** -state.gain);
        scale.children[2].textContent = "+" + percent(2 ** -state.gain) + " of the reference's mean";
        shown = {left, right, difference};
        const names = [sources[state.left].name, sources[state.right].name];
        words[0].textContent = names[0];
        words[1].textContent = names[1];
        words[2].textContent = `${names[0].split(": ")[0]} ${MINUS} ${names[1].split(": ")[0]}`;
        canvases.forEach((c, i) => c.setAttribute("aria-label", `${scene.name}, ${words[i].textContent}`));
        handle.setAttribute("aria-label", `split between ${names[0]} and ${names[1]}`);
        stage.classList.toggle("signed", state.difference);
        element.classList.toggle("signed", state.difference);
        differenceButton.setAttribute("aria-pressed", String(state.difference));
        blockButton.setAttribute("aria-pressed", String(state.blocks));
        selects[0].value = state.left;
        selects[1].value = state.right;
        exposure.set(state.exposure);
        gain.set(state.gain);
        placeSplit();
        element.dataset.ready = turn;
    }

    function read(event) {
        const box = stage.getBoundingClientRect();
        if (!shown || box.width === 0) {
            return;
        }
        const {left, right, difference} = shown;
        const x = clamp(Math.floor(left.width * (event.clientX - box.x) / box.width), 0, left.width - 1);
        const y = clamp(Math.floor(left.height * (event.clientY - box.y) / box.height), 0, left.height - 1);
        const i = y * left.width + x, rgb = (p) => p.planes.map((plane) => digits(plane[i], 3)).join(" ");
        readout.textContent = `pixel ${x}, ${y}: left ${rgb(left)}, right ${rgb(right)}, difference ${signedPercent(difference(i))}`;
    }

    function moveSplit(value) {
        state.split = clamp(value, 0, 100);
        placeSplit();
    }

    const drag = (event) => {
        const box = stage.getBoundingClientRect();
        moveSplit(100 * (event.clientX - box.x) / box.width);
    };
    stage.addEventListener("pointerdown", (event) => {
        if (event.button === 0) {
            stage.setPointerCapture(event.pointerId);
            handle.focus({preventScroll: true});
            event.preventDefault();
            event.pointerType !== "touch" && !state.difference && drag(event); // a finger may be about to scroll
        }
    });
    stage.addEventListener("pointerup", (event) => {
        read(event);
        event.pointerType === "touch" && !state.difference && drag(event);
    });
    stage.addEventListener("pointermove", (event) => {
        read(event);
        stage.hasPointerCapture(event.pointerId) && !state.difference && drag(event);
    });
    const turn = (side, by) => () => {
        state[side] = (state[side] + by + sources.length) % sources.length;
        update();
    };
    const change = (name, by, low, high) => () => {
        state[name] = clamp((state[name] ?? 0) + by, low, high);
        update();
    };
    const KEYS = {
        ArrowLeft: () => moveSplit(state.split - 1), ArrowDown: () => moveSplit(state.split - 1),
        ArrowRight: () => moveSplit(state.split + 1), ArrowUp: () => moveSplit(state.split + 1),
        PageDown: () => moveSplit(state.split - 10), PageUp: () => moveSplit(state.split + 10),
        Home: () => moveSplit(0), End: () => moveSplit(100),
        a: turn("left", 1), A: turn("left", -1), b: turn("right", 1), B: turn("right", -1),
        s: swap, t: equalTime, d: () => differenceButton.click(), m: () => blockButton.click(),
        "+": change("gain", 1, 0, 10), "=": change("gain", 1, 0, 10), "-": change("gain", -1, 0, 10),
        e: change("exposure", 0.5, -24, 24), E: change("exposure", -0.5, -24, 24),
    };
    const key = (k) => make("kbd", {}, k);
    const hint = make("p", {class: "note keys"}, key("\u2190"), key("\u2192"), " split  ", key("a"), key("b"), " next left, right  ", key("s"), " swap  ", key("t"), " equal time  ",
        key("d"), " difference  ", key("+"), key("-"), " gain  ", key("e"), key("E"), " exposure  ", key("m"), " means");
    const element = make("figure", {class: "viewer", onkeydown(event) {
        const typing = event.target.matches("select, input");
        if (KEYS[event.key] && !typing && !event.ctrlKey && !event.metaKey && !event.altKey) {
            event.preventDefault();
            KEYS[event.key]();
        }
    }},
        make("div", {class: "sides"}, make("label", {}, make("span", {}, "left"), selects[0]), swapButton, make("label", {}, make("span", {}, "right"), selects[1]), timeButton),
        stage, scale,
        make("div", {class: "controls"}, differenceButton, blockButton, exposure.element, gain.element),
        hint, readout);
    const {signal} = onScreen;
    addEventListener("beforeprint", () => { printing = true; update(); }, {signal});
    addEventListener("afterprint", () => { printing = false; update(); }, {signal});
    dark.addEventListener("change", update, {signal});
    update();
    return {
        element,
        choose(index) {
            if (has(index) >= 0) {
                state.left = has(index);
                update();
            }
        },
    };
}
