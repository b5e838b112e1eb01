// Layers of points: those that the map was given, and cells that are unknown.
function pointLayer(scene, places, cut, colour, size, opacity) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
    const material = new THREE.ShaderMaterial({
        vertexShader: pointVertex,
        fragmentShader: pointFragment,
        transparent: opacity < 1,
        depthWrite: opacity === 1,
        uniforms: {
            cut,
            size: {value: size * window.devicePixelRatio},
            colour: {value: new THREE.Vector3(...colour)},
            opacity: {value: opacity},
        },
    });
    const points = new THREE.Points(geometry, material);
    points.frustumCulled = false;
    points.visible = false;
    scene.add(points);
    return points;
}

// Centres of unknown cells, at most so many, evenly spread.
function unknownPlaces(answers, most) {
    const {counts, low, cell} = facts.lattice;
    const unknown = [];
    for (let i = 0; i < answers.length / 2; ++i)
        if (isUnknown(answers[2 * i], answers[2 * i + 1])) unknown.push(i);
    // An odd step meets all columns of the lattice.
    const step = Math.max(1, Math.ceil(unknown.length / most)) | 1;
    const places = [];
    for (let n = 0; n < unknown.length; n += step) {
        const x = unknown[n] % counts[0];
        const y = Math.floor(unknown[n] / counts[0]) % counts[1];
        const z = Math.floor(unknown[n] / (counts[0] * counts[1]));
        [x, y, z].forEach((index, k) => places.push(low[k] + (index + 0.5) * cell[k]));
    }
    return new Float32Array(places);
}
