// The canvas, the camera, and what is drawn. Frames are drawn when something has changed.
class Viewer {
    constructor(canvas, context, arrays) {
        this.canvas = canvas;
        this.arrays = arrays;
        this.renderer = new THREE.WebGLRenderer({canvas, context, antialias: true});
        this.renderer.info.autoReset = false;
        this.scene = new THREE.Scene();
        this.camera = new THREE.PerspectiveCamera(35, 1, 0.01, 1000);
        this.radius = Math.hypot(...facts.half);
        this.cut = {value: new THREE.Vector4(0, 0, 0, 1)};
        this.cutting = false;
        this.stats = {calls: 0, triangles: 0};
        this.addParts();
        this.colourings = colourings(arrays);
        this.picker = new Picker(this.surfaces, this.slice);
        new ResizeObserver(() => this.request()).observe(canvas);
        this.setUp(facts.up);
    }

    // up: an axis of the map, with its sign: z, -y, ...
    setUp(up) {
        this.sign = up.startsWith('-') ? -1 : 1;
        this.upAxis = 'xyz'.indexOf(up[up.length - 1]);
        this.camera.up.set(0, 0, 0).setComponent(this.upAxis, this.sign);
        this.east = new THREE.Vector3().setComponent((this.upAxis + 1) % 3, 1);
        this.north = this.camera.up.clone().cross(this.east);
        this.colourings[0] = heightColouring(this.arrays, this.upAxis, this.sign);
        this.colouring = null;
        // They take the camera's upper side as it is now.
        if (this.controls) this.controls.dispose();
        this.controls = new THREE.OrbitControls(this.camera, this.canvas);
        this.controls.enableKeys = false;
        this.controls.screenSpacePanning = true;
        this.controls.addEventListener('change', () => this.request());
        this.lookFrom(-125, 48);
    }

    direction(yaw, pitch) {
        return this.east.clone().multiplyScalar(Math.cos(yaw) * Math.cos(pitch))
            .addScaledVector(this.north, Math.sin(yaw) * Math.cos(pitch))
            .addScaledVector(this.camera.up, Math.sin(pitch));
    }

    addParts() {
        const {scene, arrays, cut} = this;
        const mostFree = 4e5, finestFree = 80 * arrays['free.support'].length <= mostFree ? 1 : 0;
        this.surfaces = new Ellipsoids(scene, arrays, 'surfaces', facts.surfaces, cut,
                                       {fineness: [2, 1, 0], opacity: 1, mostTriangles: 1.5e6});
        this.free = new Ellipsoids(
            scene, arrays, 'free', facts.free, cut,
            {fineness: [finestFree], opacity: 0.12, mostTriangles: mostFree});
        const sky = [...classColours.free, 1].map((v) => 255 * v);
        this.free.paint(Uint8Array.from({length: 4 * this.free.count}, (_, i) => sky[i % 4]));
        this.free.shown = false;
        this.slice = new Slice(scene, arrays.lattice);
        this.unknown = pointLayer(scene, unknownPlaces(arrays.lattice, 60000), cut,
                                  classColours.unknown, 2.5, 0.55);
        this.points = facts.hasPoints
            ? pointLayer(scene, arrays.points, cut, [0.05, 0.62, 0.45], 1.6, 1) : null;
        this.trajectory = facts.poses > 0
            ? new Trajectory(scene, arrays, 0.0018 * this.radius) : null;
    }

    // From a direction: yaw about the axis that is up, and above the horizon [deg]. The corners
    // of the box just fit into the picture.
    lookFrom(yaw, pitch) {
        const away = this.direction(yaw * Math.PI / 180, pitch * Math.PI / 180);
        const right = this.camera.up.clone().cross(away).normalize();
        const up = away.clone().cross(right);
        const target = new THREE.Vector3();
        let distance = 1;
        // What is near looks larger: the middle of the picture is not the middle of the box.
        for (let i = 0; i < 5; ++i) {
            distance = this.fittingDistance(away, right, up, target);
            target.addScaledVector(up, distance * this.offCentre(away, up, target, distance));
        }
        this.controls.target.copy(target);
        this.camera.position.copy(target).addScaledVector(away, 1.05 * distance);
        this.controls.update();
        this.request();
    }

    corners(target) {
        return [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => new THREE.Vector3(
            ...facts.half.map((h, k) => corner >> k & 1 ? h : -h)).sub(target));
    }

    fittingDistance(away, right, up, target) {
        const tall = Math.tan(this.camera.fov * Math.PI / 360);
        const wide = tall * Math.max(0.2, this.canvas.clientWidth / this.canvas.clientHeight);
        return Math.max(0.1, ...this.corners(target).map((at) => at.dot(away) + Math.max(
            Math.abs(at.dot(right)) / wide, Math.abs(at.dot(up)) / tall)));
    }

    // How far above the middle of the picture the middle of what is seen is, as a slope.
    offCentre(away, up, target, distance) {
        const slopes = this.corners(target).map((at) => at.dot(up) / (distance - at.dot(away)));
        return (Math.min(...slopes) + Math.max(...slopes)) / 2;
    }

    // Turns about what is looked at [rad], and goes nearer by a factor.
    move(left, up, nearer) {
        const offset = this.camera.position.clone().sub(this.controls.target);
        const yaw = Math.atan2(offset.dot(this.north), offset.dot(this.east)) + left;
        const above = Math.asin(offset.dot(this.camera.up) / offset.length());
        const pitch = Math.min(1.57, Math.max(-1.57, above + up));
        this.camera.position.copy(this.controls.target)
            .addScaledVector(this.direction(yaw, pitch), offset.length() / nearer);
        this.controls.update();
        this.request();
    }

    colour(index) {
        this.colouring = this.colourings[index];
        this.surfaces.paint(coloursOf(this.colouring, this.surfaces.count));
        this.request();
    }

    level(level) {
        this.surfaces.level = level;
        this.free.level = level;
        this.picked(-1);
    }

    picked(component) {
        this.surfaces.material.uniforms.picked.value = component;
        this.request();
    }

    // Hides what is on the camera's side of the slice.
    placeCut() {
        if (!this.cutting || !this.slice.mesh.visible) {
            this.cut.value.set(0, 0, 0, 1);
            return;
        }
        const w = this.slice.axes()[2];
        const side = this.camera.position.getComponent(w) > this.slice.place_m ? 1 : -1;
        this.cut.value.set(0, 0, 0, side * this.slice.place_m);
        this.cut.value.setComponent(w, side);
    }

    // What is at a place of the canvas, in shares of its width and height.
    pickAt(x, y) {
        const ray = new THREE.Raycaster();
        ray.setFromCamera(new THREE.Vector2(2 * x - 1, 1 - 2 * y), this.camera);
        this.placeCut();
        return this.picker.pick(ray.ray.origin, ray.ray.direction, this.cut.value);
    }

    request() {
        if (this.requested) return;
        this.requested = true;
        requestAnimationFrame(() => {
            this.requested = false;
            this.draw();
        });
    }

    fitToCanvas() {
        const {clientWidth, clientHeight} = this.canvas;
        const size = this.renderer.getSize(new THREE.Vector2());
        if (size.x !== clientWidth || size.y !== clientHeight) {
            this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
            this.renderer.setSize(clientWidth, clientHeight, false);
            this.camera.aspect = clientWidth / clientHeight;
        }
        const distance = this.camera.position.length();
        this.camera.near = Math.max(0.002 * this.radius, distance - 20 * this.radius);
        this.camera.far = distance + 20 * this.radius;
        this.camera.updateProjectionMatrix();
    }

    draw() {
        this.fitToCanvas();
        this.camera.updateMatrixWorld();
        this.placeCut();
        const height_px = this.canvas.clientHeight;
        this.surfaces.arrange(this.camera, height_px);
        this.free.arrange(this.camera, height_px);
        this.renderer.info.reset();
        this.renderer.render(this.scene, this.camera);
        const {calls, triangles} = this.renderer.info.render;
        this.stats = {calls, triangles};
    }

    // Frames a second of one turn about the scene, and the most that was drawn.
    async measure(frames) {
        const start = performance.now(), most = {calls: 0, triangles: 0};
        for (let i = 0; i < frames; ++i) {
            this.move(2 * Math.PI / frames, 0, 1);
            await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
            for (const key of ['calls', 'triangles'])
                most[key] = Math.max(most[key], this.stats[key]);
        }
        const seconds = (performance.now() - start) / 1000;
        return {framesPerSecond: frames / seconds, ...most};
    }
}
