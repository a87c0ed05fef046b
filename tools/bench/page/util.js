// util.js -- elements, numbers, words.

// make("p", {class: "note"}, "text", child...): text is always text, never markup.
function make(tag, attributes = {}, ...children) {
    return fill(document.createElement(tag), attributes, children);
}

function draw(tag, attributes = {}, ...children) {
    return fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

function fill(element, attributes, children) {
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith("on")) {
            element.addEventListener(name.slice(2), value);
        } else if (value !== null && value !== undefined && value !== false) {
            element.setAttribute(name, value === true ? "" : value);
        }
    }
    element.append(...children.flat(9).filter((c) => c !== null && c !== undefined && c !== false));
    return element;
}

const isNumber = (x) => typeof x === "number" && Number.isFinite(x);
const list = (x) => (Array.isArray(x) ? x : []);
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const NARROW = "\u202f"; // a narrow space that does not break, before units
const MINUS = "\u2212", TIMES = "\u00d7", NONE = "\u2013";

// So many significant digits, without exponent where people would not write one.
function digits(x, count = 2) {
    if (!isNumber(x)) {
        return NONE;
    }
    const size = Math.abs(x);
    let text;
    if (size >= 1e7 || (size > 0 && size < 1e-4)) {
        text = x.toExponential(count - 1).replace("e+", "e");
    } else {
        const decimals = size > 0 ? clamp(count - 1 - Math.floor(Math.log10(size) + 1e-9), 0, 8) : 0;
        text = x.toFixed(decimals);
    }
    return text.replace("-", MINUS);
}

const percent = (x, count = 2) => (isNumber(x) ? digits(100 * x, count) + NARROW + "%" : NONE);
const level = (x) => Number((100 * x).toPrecision(2)) + NARROW + "%"; // "5 %", "0.3 %", "100 %"
const signedPercent = (x) => (isNumber(x) && x > 0 ? "+" : "") + percent(x);
const times = (x) => (isNumber(x) ? digits(x, x < 100 ? 2 : 3) + TIMES : NONE);
const mebibytes = (x) => (isNumber(x) ? digits(x / 1048576, 3) : NONE);

function duration(ms) {
    return !isNumber(ms) ? NONE : ms >= 6e4 ? digits(ms / 6e4, 2) + NARROW + "min"
         : ms >= 1e3 ? digits(ms / 1e3, 3) + NARROW + "s"
         : ms < 1 ? digits(1e3 * ms, 2) + NARROW + "\u00b5s" : digits(ms, 3) + NARROW + "ms";
}

// A value on an axis, exactly: 10\u207b\u2076, 0.9999, 3e7.
function axisValue(x) {
    const exact = Number(x.toPrecision(4)), size = Math.abs(exact);
    if (size === 0 || (size >= 1e-2 && size < 1e4)) {
        return String(exact).replace("-", MINUS);
    }
    const [mantissa, exponent] = exact.toExponential().split("e");
    const raised = [...exponent.replace("+", "")].map((c) => "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[c] ?? "\u207b").join("");
    return (mantissa === "1" ? "" : mantissa === "-1" ? MINUS : mantissa.replace("-", MINUS) + TIMES) + "10" + raised;
}

// What an error is of: blocks of so many pixels, single ones, or 0: FLIP.
const blockName = (b) => (b > 1 ? `${b}${TIMES}${b} pixels` : b === 1 ? "single pixels" : "FLIP");
const errorOver = (b) => (b > 0 ? `error over ${blockName(b)}` : "FLIP");
const errorLevel = (x, b) => (b > 0 ? level(x) : axisValue(x));

// {"lattice.cells": 32} -> "lattice.cells 32"
function settingsText(settings) {
    return Object.entries(settings || {})
        .map(([name, value]) => `${name} ${typeof value === "object" ? JSON.stringify(value) : value}`)
        .join(", ");
}

const errorsOf = (run, block) => list(run.errors).find((e) => e.block === block) || {};
// An error below the noise of the reference is known to be that noise or less; below twice the noise it is vague.
const isHidden = (e) => isNumber(e.error) && isNumber(e.n) && e.error < e.n;
const errorValue = (e) => (isHidden(e) ? e.n : e.error);
const amount = (x, b, count = 2) => (b > 0 ? percent(x, count) : isNumber(x) ? x.toFixed(4) : NONE);
const errorText = (e, count = 2) => (isHidden(e) ? `\u2264${NARROW}` : isNumber(e.error) && e.error < 2 * e.n ? "~" : "") + amount(errorValue(e), e.block, count);
// Whose times the page compares. A method that samples begins anew whatever changes.
const FRAMES = {
    first_picture: "a first picture", animated_medium: "a frame after the medium has changed",
    animated_light: "a frame after the light has changed", camera_moved: "a frame after the camera has moved",
};
const FRAME_NAMES = {first_picture: "first picture", animated_medium: "animated medium", animated_light: "animated light", camera_moved: "camera moved"};
let frameShown = "animated_light";
let onScreen = new AbortController(); // aborted when another choice takes the place of what is shown
const lightOf = (run) => (run.frame_ms || {}).animated_light;
const timeOf = (run) => (run.frame_ms || {})[frameShown];
const frontOf = (scene, block) => new Set(list((list(scene.fronts).find((f) => f.block === block) || {}).runs));

// A choice of one among few, as buttons: options are [value, label].
function segmented(label, options, value, change) {
    const buttons = options.map(([v, text]) => make("button", {
        type: "button", "aria-pressed": String(v === value),
        onclick() {
            buttons.forEach((b, i) => b.setAttribute("aria-pressed", String(options[i][0] === v)));
            change(v);
        },
    }, text));
    return make("div", {class: "segmented", role: "group", "aria-label": label}, buttons);
}

// Copies text; where the browser forbids it, it selects the text for the user to copy.
async function copyText(text, element, button) {
    let word = "copied";
    try {
        await navigator.clipboard.writeText(text);
    } catch {
        getSelection().selectAllChildren(element);
        word = "selected: press Ctrl+C";
    }
    const before = button.textContent;
    button.textContent = word;
    setTimeout(() => { button.textContent = before; }, 1500);
}

// Calls back with an element's width, now and whenever it changes.
function onWidth(element, callback) {
    let width = 0;
    new ResizeObserver(([entry]) => {
        const now = Math.round(entry.contentRect.width);
        if (now > 0 && now !== width) {
            width = now;
            callback(width);
        }
    }).observe(element);
}
