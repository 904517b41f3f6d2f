// What a page says beside the picture: controls that nothing moves here, and where this browser may differ.

const FINE_PARTS = 8; // bits of a pixel's parts at which devices usually place corners of triangles

// A row for each control that keeps its value, where a visitor looks for it, with the reason.
function addHeldControls(list, held) {
    for (const {name, label, doc, remark} of held) {
        const row = document.createElement("div"), title = document.createElement("span");
        const reason = document.createElement("small");
        row.className = "control held"; row.id = `held-${name}`; row.title = doc;
        title.textContent = label;
        reason.textContent = `${remark[0].toUpperCase()}${remark.slice(1)}.`;
        row.append(title, reason);
        list.append(row);
    }
}

// Sentences of the export that no row of a control says already, and those on this device.
function listNotes({notes, document: {held, plans}}, reader) {
    const said = new Set(held.map(({name, remark}) => `control '${name}' ${remark}`)), gl = reader.gl;
    const bits = gl.getParameter(gl.SUBPIXEL_BITS);
    const hasMeshes = plans.some(variants => variants.some(plan => plan.passes.some(pass => pass.mesh)));
    const coarse = hasMeshes && bits < FINE_PARTS
        ? [`this device places corners of triangles to a ${2 ** bits}th of a pixel: edges may look rougher`] : [];
    return [...notes.filter(note => !said.has(note)), ...reader.notes, ...coarse];
}
