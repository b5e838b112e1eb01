// Colours that people with any kind of colour vision tell apart, in lightness, too.
const classColours = {
    occupied: [0.835, 0.369, 0.0],
    free: [0.55, 0.80, 0.96],
    unknown: [0.42, 0.42, 0.45],
};
const pickedColour = [1.0, 0.1, 0.6];
const pathColour = [0.86, 0.25, 0.60];

// From dark violet to yellow by rising lightness; red, green, blue in tenths of the scale.
const ramp = [
    [0.267, 0.005, 0.329], [0.283, 0.141, 0.458], [0.254, 0.265, 0.530], [0.207, 0.372, 0.553],
    [0.164, 0.471, 0.558], [0.128, 0.567, 0.551], [0.135, 0.659, 0.518], [0.267, 0.749, 0.441],
    [0.478, 0.821, 0.318], [0.741, 0.873, 0.150], [0.993, 0.906, 0.144],
];

function rampColour(share) {
    const at = 10 * Math.min(1, Math.max(0, share));
    const i = Math.min(9, Math.floor(at));
    return ramp[i].map((low, k) => low + (at - i) * (ramp[i + 1][k] - low));
}

const cssColour = (rgb) => `rgb(${rgb.map((v) => Math.round(255 * v)).join(',')})`;

// The values between which all lie but a hundredth at either end.
function usualRange(values) {
    const sorted = Float64Array.from(values.filter(Number.isFinite)).sort();
    if (sorted.length === 0) return [0, 1];
    const stray = Math.floor(sorted.length / 100);
    const low = sorted[stray], high = sorted[sorted.length - 1 - stray];
    return high > low ? [low, high] : [low, low + 1e-6];
}

function heightColouring(arrays, axis, sign) {
    const mean = arrays['surfaces.mean'];
    const values = Float32Array.from({length: mean.length / 3},
                                     (_, i) => sign * (mean[3 * i + axis] + facts.centre[axis]));
    const middle = sign * facts.centre[axis], half = facts.half[axis];
    return {name: 'height', title: 'Height', unit: 'm', values,
            range: [middle - half, middle + half]};
}

// What surfaces can show by colour: a value for each component, or red, green and blue.
function colourings(arrays) {
    const n = arrays.occupied.length;
    const column = (array, stride, k) => Float32Array.from({length: n}, (_, i) => array[stride * i + k]);
    const list = [
        heightColouring(arrays, 2, 1),
        {name: 'occupancy', title: 'P(occupied) at the mean', unit: '', values: arrays.occupied,
         range: [0, 1]},
        {name: 'variance', title: 'Standard deviation of the distance', unit: 'm',
         values: arrays.deviation, range: usualRange(arrays.deviation)},
    ];
    const names = facts.modalities;
    if (['r', 'g', 'b'].every((c) => names.includes(c)))
        list.push({name: 'rgb', title: 'Colour as measured', unit: '',
                   rgb: ['r', 'g', 'b'].map((c) => column(arrays[`modality.${c}`], 2, 0))});
    for (const name of names.filter((c) => !['r', 'g', 'b'].includes(c))) {
        const values = column(arrays[`modality.${name}`], 2, 0);
        list.push({name: `modality.${name}`, title: name, unit: '', values,
                   range: usualRange(values)});
    }
    return list;
}

// Bytes red, green, blue, 255 for each component; grey where a value is not known.
function coloursOf(colouring, count) {
    const bytes = new Uint8Array(4 * count).fill(255);
    const grey = [0.5, 0.5, 0.5];
    for (let i = 0; i < count; ++i) {
        let rgb;
        if (colouring.rgb) {
            rgb = colouring.rgb.map((channel) => Math.min(1, Math.max(0, channel[i])));
        } else {
            const [low, high] = colouring.range;
            rgb = rampColour((colouring.values[i] - low) / (high - low));
        }
        if (!rgb.every(Number.isFinite)) rgb = grey;
        for (let k = 0; k < 3; ++k) bytes[4 * i + k] = 255 * rgb[k];
    }
    return bytes;
}
