// What readers of a package have in common: plans, numbers and frames, without a graphics library.

function interpolate(x, at, rows, snap) {
    if (snap || at.length < 2)
        return rows[at.reduce((best, place, k) => Math.abs(place - x) < Math.abs(at[best] - x) ? k : best, 0)];
    let k = 1;
    while (k < at.length - 1 && at[k] < x) ++k;
    const t = Math.min(Math.max((x - at[k - 1]) / (at[k] - at[k - 1]), 0), 1);
    return rows[k - 1].map((a, n) => a + t * (rows[k][n] - a));
}

// The numbers of a slot at values of knobs: its base, and the curve of each knob that changes it.
export function readSlot({base, curves = [], grids = [], mode, whole}, knobs) {
    let numbers = base.slice();
    for (const {knob, at, values, snap} of curves) {
        const row = interpolate(knobs[knob], at, values, snap);
        numbers = numbers.map((number, n) =>
            mode === "multiply" && base[n] !== 0 ? number * row[n] / base[n] : number + row[n] - base[n]);
    }
    for (const {knobs: [first, second], at, values} of grids) {
        const lines = values.map(line => interpolate(knobs[second], at[1], line));
        interpolate(knobs[first], at[0], lines).forEach((number, n) => { numbers[n] += number; });
    }
    return whole ? numbers.map(Math.round) : numbers;
}

// A package. A reader makes textures (`makeTexture`), remembers them (`remember`), and runs a pass (`draw`).
export class Package {
    constructor(document, loadBlob) {
        Object.assign(this, {document, loadBlob, history: {}});
        this.replaced = new Map(); // textures in the place of sources, by number
    }

    get remembers() { return Object.keys(this.document.plans[0][0].memories).length > 0; }

    numbers(slot, knobs) { return readSlot(this.document.slots[slot], knobs); }

    // Variants are in the order of the axes, the last one changes fastest.
    plan(knobs, isFirst) {
        const {axes, plans} = this.document;
        const index = axes.reduce((before, {knob, edges}) =>
            before * (edges.length + 1) + edges.filter(edge => knobs[knob] > edge).length, 0);
        return plans[isFirst ? 0 : plans.length - 1][index];
    }

    source(number) {
        const {size, format, blob} = this.document.sources[number];
        return this.replaced.get(number) || this.remember(`source ${number}`, () => {
            const bytes = this.loadBlob(blob);
            return this.makeTexture(size, format, new (format.endsWith("16f") ? Uint16Array : Float32Array)(bytes));
        });
    }

    // A table that a node made of its values: height, width, channels, and the numbers.
    numberTable(slot, format, knobs) {
        const numbers = this.numbers(slot, knobs), components = format.length - 3;
        const [height, width, channels] = numbers.slice(0, 3).map(Math.round);
        const pixels = new Float32Array(width * height * components);
        for (let at = 0; at < width * height * channels; ++at)
            pixels[Math.floor(at / channels) * components + at % channels] = numbers[3 + at];
        this.forget(`numbers ${slot}`);
        return this.remember(`numbers ${slot}`, () => this.makeTexture([width, height], format, pixels));
    }

    run(plan, knobs) {
        const surfaces = plan.surfaces.map(({source, numbers, history, slot, format, size}) =>
            source !== undefined ? this.source(source)
            : numbers !== undefined ? this.numberTable(numbers, format, knobs)
            : history !== undefined ? this.history[history]
            : this.remember(`slot ${slot} ${format} ${size}`, () => this.makeTexture(size, format)));
        this.prepare(plan.passes);
        for (const pass of plan.passes) {
            const uniforms = Object.entries(pass.uniforms).map(([name, slot]) => [name, this.numbers(slot, knobs)]);
            const weights = pass.weights === undefined ? null : this.numbers(pass.weights, knobs);
            const [reads, writes] = [pass.textures, pass.targets].map(list => list.map(number => surfaces[number]));
            this.draw(pass, reads, writes, uniforms, weights);
        }
        return surfaces;
    }

    // The texture of the picture at values of knobs. Of a graph that remembers, frames follow each other.
    render(knobs, frame, isFirst) {
        const at = {...knobs, frame}, plan = this.plan(at, isFirst), surfaces = this.run(plan, at);
        this.history = Object.fromEntries(Object.entries(plan.memories).map(([port, number]) =>
            [port, this.copy(surfaces[number], plan.surfaces[number].format, `history ${port} ${frame % 2}`)]));
        return surfaces[plan.output];
    }
}
