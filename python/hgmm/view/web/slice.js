// A slice through the lattice of answers, square to one of the map's axes.
class Slice {
    constructor(scene, answers) {
        this.answers = answers;
        this.lattice = facts.lattice;
        this.texture = null;
        const colour = (name) => ({value: new THREE.Vector3(...classColours[name])});
        this.material = new THREE.ShaderMaterial({
            vertexShader: sliceVertex,
            fragmentShader: sliceFragment,
            side: THREE.DoubleSide,
            uniforms: {
                answers: {value: null},
                stripe: {value: 9 * window.devicePixelRatio},
                occupiedColour: colour('occupied'),
                freeColour: colour('free'),
                unknownColour: colour('unknown'),
            },
        });
        this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), this.material);
        this.mesh.frustumCulled = false;
        scene.add(this.mesh);
        this.put('z', Math.floor(this.lattice.counts[2] / 2));
    }

    // Axes of the slice: across its columns, its rows, and square to it.
    axes() {
        return {x: [1, 2, 0], y: [0, 2, 1], z: [0, 1, 2]}[this.axis];
    }

    // How many cells of each layer along an axis are not unknown.
    knownCells(axis) {
        const {counts} = this.lattice, known = new Array(counts[axis]).fill(0);
        const stride = [1, counts[0], counts[0] * counts[1]][axis];
        for (let i = 0; i < this.answers.length / 2; ++i)
            if (!isUnknown(this.answers[2 * i], this.answers[2 * i + 1]))
                ++known[Math.floor(i / stride) % counts[axis]];
        return known;
    }

    put(axis, layer) {
        this.axis = axis;
        const {counts, low, cell} = this.lattice;
        const [u, v, w] = this.axes();
        this.layer = Math.min(counts[w] - 1, Math.max(0, layer));
        const columns = counts[u], rows = counts[v];
        const texels = new Uint8Array(4 * columns * rows);
        const stride = [1, counts[0], counts[0] * counts[1]];
        for (let j = 0, t = 0; j < rows; ++j)
            for (let i = 0; i < columns; ++i, t += 4) {
                const at = 2 * (i * stride[u] + j * stride[v] + this.layer * stride[w]);
                texels[t] = this.answers[at];
                texels[t + 1] = this.answers[at + 1];
            }
        if (this.texture) this.texture.dispose();
        this.texture = new THREE.DataTexture(texels, columns, rows, THREE.RGBAFormat);
        this.texture.needsUpdate = true;
        this.material.uniforms.answers.value = this.texture;
        this.place_m = low[w] + (this.layer + 0.5) * cell[w];
        this.shape(u, v, w);
    }

    shape(u, v, w) {
        const {counts, low, cell} = this.lattice;
        const corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(([a, b]) => {
            const corner = [0, 0, 0];
            corner[u] = low[u] + a * counts[u] * cell[u];
            corner[v] = low[v] + b * counts[v] * cell[v];
            corner[w] = this.place_m;
            return corner;
        });
        const geometry = this.mesh.geometry;
        geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners.flat(), 3));
        geometry.setAttribute('uv', new THREE.Float32BufferAttribute([0, 0, 1, 0, 1, 1, 0, 1], 2));
        geometry.setIndex([0, 1, 2, 0, 2, 3]);
    }

    // P(occupied) and P(free) of the cell that holds a place.
    at(place) {
        const {counts, low, cell} = this.lattice;
        const [i, j, k] = [0, 1, 2].map((a) => Math.min(
            counts[a] - 1, Math.max(0, Math.floor((place[a] - low[a]) / cell[a]))));
        const at = 2 * ((k * counts[1] + j) * counts[0] + i);
        return {occupied: this.answers[at] / 50, free: this.answers[at + 1] / 50};
    }
}
