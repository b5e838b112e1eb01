// A trajectory: a thin tube, pale ahead of the time of the slider, and a cone for the robot.
class Trajectory {
    constructor(scene, arrays, radius) {
        this.time = arrays['poses.time'];
        this.position = arrays['poses.position'];
        this.turn = arrays['poses.turn'];
        this.group = new THREE.Group();
        const tube = this.tubeOf(radius);
        const look = (opacity) => new THREE.MeshBasicMaterial({
            color: new THREE.Color(...pathColour), transparent: opacity < 1, opacity});
        this.all = new THREE.Mesh(tube, look(0.3));
        this.past = new THREE.Mesh(tube.clone(), look(1));
        const cone = new THREE.ConeBufferGeometry(4 * radius, 14 * radius, 12);
        cone.rotateZ(-Math.PI / 2);  // ahead is x
        this.robot = new THREE.Mesh(cone, look(1));
        for (const mesh of [this.all, this.past, this.robot]) {
            mesh.frustumCulled = false;
            this.group.add(mesh);
        }
        scene.add(this.group);
        this.goTo(this.time.length - 1);
    }

    place(i) {
        return new THREE.Vector3().fromArray(this.position, 3 * i);
    }

    tubeOf(radius) {
        const places = [], index = [], n = this.time.length;
        const ahead = new THREE.Vector3(1, 0, 0), side = new THREE.Vector3();
        for (let i = 0; i < n; ++i) {
            const step = this.place(Math.min(n - 1, i + 1)).sub(this.place(Math.max(0, i - 1)));
            if (step.length() > 0) ahead.copy(step).normalize();
            side.set(0, 0, 1);
            if (Math.abs(ahead.z) > 0.9) side.set(1, 0, 0);
            side.cross(ahead).normalize().multiplyScalar(radius);
            const up = ahead.clone().cross(side);
            for (const [a, b] of [[1, 0], [0, 1], [-1, 0], [0, -1]]) {
                const corner = this.place(i).addScaledVector(side, a).addScaledVector(up, b);
                places.push(corner.x, corner.y, corner.z);
            }
            for (let k = 0; k < 4 && i + 1 < n; ++k) {
                const a = 4 * i + k, b = 4 * i + (k + 1) % 4;
                index.push(a, b, a + 4, b, b + 4, a + 4);
            }
        }
        const tube = new THREE.BufferGeometry();
        tube.setAttribute('position', new THREE.Float32BufferAttribute(places, 3));
        tube.setIndex(index);
        return tube;
    }

    goTo(i) {
        this.past.geometry.setDrawRange(0, 24 * i);
        this.robot.position.copy(this.place(i));
        this.robot.quaternion.fromArray(this.turn, 4 * i);
    }
}
