// The facts of the scene and its arrays, as page.py put them into the page.
const facts = JSON.parse(document.getElementById('facts').textContent);

// Of answers in steps of 1/50, as slices.py makes them: whether unknown is the likeliest.
const isUnknown = (occupied, free) => 50 - occupied - free > Math.max(occupied, free);

const arrayKinds = {
    float32: Float32Array, float64: Float64Array, int16: Int16Array, uint8: Uint8Array,
};

async function unpackArrays() {
    const packed = Uint8Array.from(atob(document.getElementById('arrays').textContent.trim()),
                                   (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
    const bytes = await new Response(stream).arrayBuffer();
    const arrays = {};
    for (const [name, entry] of Object.entries(facts.arrays)) {
        // Copies, as doubles need not lie where typed arrays want them.
        const kind = arrayKinds[entry.type];
        arrays[name] = new kind(
            bytes.slice(entry.at, entry.at + entry.count * kind.BYTES_PER_ELEMENT));
    }
    return arrays;
}
