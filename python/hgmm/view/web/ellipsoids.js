// Ellipsoids by instances of three balls: the larger on the screen, the finer.
// An icosahedron with each side cut in four, `times` over; corners are shared.
function ballOf(times) {
    const source = new THREE.IcosahedronBufferGeometry(1, times).attributes.position;
    const places = [], corners = new Map(), index = [];
    for (let i = 0; i < source.count; ++i) {
        const corner = [source.getX(i), source.getY(i), source.getZ(i)];
        const key = corner.map((v) => v.toFixed(4)).join();
        if (!corners.has(key)) {
            corners.set(key, places.length / 3);
            places.push(...corner);
        }
        index.push(corners.get(key));
    }
    const ball = new THREE.InstancedBufferGeometry();
    ball.setAttribute('position', new THREE.Float32BufferAttribute(places, 3));
    ball.setIndex(index);
    ball.triangles = index.length / 3;
    return ball;
}

// Four numbers of each component as a texture.
function textureOf(values, stride, cells, scale, kind) {
    const texels = new kind(4 * cells.x * cells.y);
    for (let i = 0; i < values.length / stride; ++i)
        for (let k = 0; k < stride; ++k) texels[4 * i + k] = values[stride * i + k] * scale;
    const type = kind === Float32Array ? THREE.FloatType : THREE.UnsignedByteType;
    const texture = new THREE.DataTexture(texels, cells.x, cells.y, THREE.RGBAFormat, type);
    texture.needsUpdate = true;
    return texture;
}

class Ellipsoids {
    // fineness: how often the sides of each ball are cut, the finest first. mostTriangles: to
    // be drawn.
    constructor(scene, arrays, name, first, cut, {fineness, opacity, mostTriangles}) {
        this.mean = arrays[`${name}.mean`];
        this.deviation = arrays[`${name}.deviation`];
        this.turn = arrays[`${name}.turn`];
        this.count = this.mean.length / 3;
        this.first = first;
        this.mostTriangles = mostTriangles;
        this.level = 0;
        this.shown = true;
        this.sigmas = 2;
        const width = Math.min(2048, Math.max(1, this.count));
        this.cells = new THREE.Vector2(width, Math.max(1, Math.ceil(this.count / width)));
        this.material = this.materialOf(cut, opacity);
        this.balls = fineness.map((times) => this.addBall(scene, times));
        this.sizes = new Float32Array(this.count);
    }

    materialOf(cut, opacity) {
        const data = (values, stride, scale) =>
            ({value: textureOf(values, stride, this.cells, scale, Float32Array)});
        const material = new THREE.ShaderMaterial({
            vertexShader: ellipsoidVertex,
            fragmentShader: ellipsoidFragment,
            side: opacity < 1 ? THREE.FrontSide : THREE.DoubleSide,
            transparent: opacity < 1,
            depthWrite: opacity === 1,
            uniforms: {
                means: data(this.mean, 3, 1),
                deviations: data(this.deviation, 3, 1),
                turns: data(this.turn, 4, 1 / 32767),
                colours: {value: null},
                cells: {value: this.cells},
                sigmas: {value: this.sigmas},
                picked: {value: -1},
                pickedColour: {value: new THREE.Vector3(...pickedColour)},
                opacity: {value: opacity},
                cut,
            },
        });
        return material;
    }

    addBall(scene, times) {
        const ball = ballOf(times);
        const numbers = new THREE.InstancedBufferAttribute(new Float32Array(this.count), 1);
        numbers.setUsage(THREE.DynamicDrawUsage);
        ball.setAttribute('component', numbers);
        const mesh = new THREE.Mesh(ball, this.material);
        mesh.frustumCulled = false;
        mesh.visible = false;
        scene.add(mesh);
        return {mesh, numbers, triangles: ball.triangles, used: 0};
    }

    // Bytes red, green, blue, 255 of each component.
    paint(bytes) {
        const old = this.material.uniforms.colours.value;
        if (old) old.dispose();
        this.material.uniforms.colours.value = textureOf(bytes, 4, this.cells, 1, Uint8Array);
    }

    range() {
        return [this.first[this.level], this.first[this.level + 1]];
    }

    // Sizes on the screen [pixels]; 0 behind the camera.
    measure(camera, height_px) {
        const [from, to] = this.range();
        const eye = camera.position, ahead = camera.getWorldDirection(new THREE.Vector3());
        const focal = height_px / (2 * Math.tan(camera.fov * Math.PI / 360));
        const {mean, deviation, sizes, sigmas} = this;
        const ax = ahead.x, ay = ahead.y, az = ahead.z, ex = eye.x, ey = eye.y, ez = eye.z;
        for (let i = from, k = 3 * from; i < to; ++i, k += 3) {
            const depth = (mean[k] - ex) * ax + (mean[k + 1] - ey) * ay + (mean[k + 2] - ez) * az;
            const reach = sigmas * deviation[k];
            sizes[i] = depth > -reach ? focal * reach / Math.max(depth, 0.1 * reach) : 0;
        }
    }

    // How many triangles there are if balls get coarser below these sizes [pixels].
    trianglesFor(limits) {
        const [from, to] = this.range(), {sizes} = this, counts = this.balls.map(() => 0);
        for (let i = from; i < to; ++i)
            if (sizes[i] > 0) ++counts[this.ballFor(sizes[i], limits)];
        return this.balls.reduce((sum, ball, k) => sum + counts[k] * ball.triangles, 0);
    }

    ballFor(size, limits) {
        let ball = 0;
        while (ball < limits.length && size < limits[ball]) ++ball;
        return ball;
    }

    // Gives each component its ball for this view.
    arrange(camera, height_px) {
        for (const ball of this.balls) ball.used = 0;
        if (this.shown) {
            this.measure(camera, height_px);
            let limits = [40, 9].slice(0, this.balls.length - 1);
            for (let i = 0; i < 8 && this.trianglesFor(limits) > this.mostTriangles; ++i)
                limits = limits.map((limit) => 2 * limit);
            const [from, to] = this.range();
            for (let i = from; i < to; ++i) {
                if (!(this.sizes[i] > 0)) continue;
                const ball = this.balls[this.ballFor(this.sizes[i], limits)];
                ball.numbers.array[ball.used++] = i;
            }
        }
        for (const ball of this.balls) {
            ball.mesh.visible = ball.used > 0;
            ball.mesh.geometry.maxInstancedCount = ball.used;
            ball.numbers.updateRange.count = ball.used;
            ball.numbers.needsUpdate = ball.used > 0;
        }
    }
}
