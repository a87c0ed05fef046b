// groups.js -- how a group of runs (a method, a baseline) looks: colour, marker and dash tell it apart
// each for itself, so that neither colour blindness nor a black printer hides it.

const SHAPES = [
    "M-4.6,0a4.6,4.6 0 1,0 9.2,0a4.6,4.6 0 1,0 -9.2,0Z",              // circle
    "M-4.2,-4.2H4.2V4.2H-4.2Z",                                        // square
    "M0,-5.4L5,3.8H-5Z",                                               // triangle
    "M0,-5.9L5.2,0L0,5.9L-5.2,0Z",                                     // diamond
    "M0,5.4L5,-3.8H-5Z",                                               // triangle downwards
    "M-1.7,-5.2H1.7V-1.7H5.2V1.7H1.7V5.2H-1.7V1.7H-5.2V-1.7H-1.7Z",    // plus
    "M0,-5.5L5.2,-1.7L3.2,4.5H-3.2L-5.2,-1.7Z",                        // pentagon
    "M-5,-4.6H5L0,0L5,4.6H-5L0,0Z",                                    // hourglass
];
const DASHES = ["", "8 3", "2 3", "10 3 2 3", "5 3", "1 4", "12 4", "6 2 2 2 2 2"];
const USUAL = ["pop", "path", "path, plain", "pop-paper", "lpv", "single", "cycles"];

// Every group of a report -> {name, index, shape, dash, color}; the usual ones look the same in every report.
function groupStyles(report) {
    const names = [];
    for (const scene of list(report.scenes)) {
        for (const run of list(scene.runs)) {
            const name = String(run.group ?? run.method);
            if (!names.includes(name)) {
                names.push(name);
            }
        }
    }
    const other = names.filter((n) => !USUAL.includes(n));
    const styles = new Map();
    for (const name of [...USUAL.filter((n) => names.includes(n)), ...other]) {
        const place = USUAL.includes(name) ? USUAL.indexOf(name) : USUAL.length + other.indexOf(name);
        const index = place % SHAPES.length;
        styles.set(name, {name, index, shape: SHAPES[index], dash: DASHES[index], color: `var(--group-${index})`});
    }
    return styles;
}

function marker(style, size = 12) {
    return draw("svg", {class: "marker", width: size, height: size, viewBox: "-6.5 -6.5 13 13", "aria-hidden": "true"},
        draw("path", {d: style.shape, fill: style.color}));
}

// The longest group name that a sentence starts with.
function groupOfSentence(styles, sentence) {
    let found = null;
    for (const style of styles.values()) {
        if (sentence.startsWith(style.name) && (!found || style.name.length > found.name.length)) {
            found = style;
        }
    }
    return found;
}
