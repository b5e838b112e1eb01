// What a ray meets first: a component of the shown level, or the slice.
class Picker {
    constructor(surfaces, slice) {
        this.surfaces = surfaces;
        this.slice = slice;
    }

    // The nearest ellipsoid that the ray meets before the cut hides it.
    // A turned and shrunken ellipsoid is the unit ball, and the ray another ray.
    component(origin, direction, cut) {
        const {mean, deviation, turn, sigmas} = this.surfaces;
        const [from, to] = this.surfaces.range();
        const back = new THREE.Quaternion(), o = new THREE.Vector3(), d = new THREE.Vector3();
        let nearest = {range: Infinity, component: -1};
        for (let i = from; i < to; ++i) {
            o.set(mean[3 * i], mean[3 * i + 1], mean[3 * i + 2]).sub(origin);
            const along = o.dot(direction), reach = sigmas * deviation[3 * i];
            if (o.lengthSq() - along * along > reach * reach) continue;
            back.set(-turn[4 * i], -turn[4 * i + 1], -turn[4 * i + 2], turn[4 * i + 3]).normalize();
            o.negate().applyQuaternion(back);
            d.copy(direction).applyQuaternion(back);
            for (const [axis, k] of [['x', 0], ['y', 1], ['z', 2]]) {
                o[axis] /= sigmas * deviation[3 * i + k];
                d[axis] /= sigmas * deviation[3 * i + k];
            }
            const a = d.lengthSq(), b = o.dot(d), c = o.lengthSq() - 1;
            const root = Math.sqrt(b * b - a * c);
            if (!(root >= 0)) continue;
            for (const range of [(-b - root) / a, (-b + root) / a]) {
                const place = origin.clone().addScaledVector(direction, range);
                const hidden = place.x * cut.x + place.y * cut.y + place.z * cut.z > cut.w;
                if (range > 0 && range < nearest.range && !hidden)
                    nearest = {range, component: i};
            }
        }
        return nearest;
    }

    // Where the ray meets the slice.
    slicePlace(origin, direction) {
        const w = this.slice.axes()[2];
        const range = (this.slice.place_m - origin.getComponent(w)) / direction.getComponent(w);
        const place = origin.clone().addScaledVector(direction, range);
        const inside = [0, 1, 2].every((k) => {
            const {low, cell, counts} = facts.lattice;
            const from = place.getComponent(k) - low[k];
            return k === w || (from >= 0 && from <= cell[k] * counts[k]);
        });
        return range > 0 && inside ? {range, place: place.toArray()} : {range: Infinity};
    }

    pick(origin, direction, cut) {
        const none = {range: Infinity};
        const component = this.surfaces.shown ? this.component(origin, direction, cut) : none;
        const slice = this.slice.mesh.visible ? this.slicePlace(origin, direction) : none;
        if (slice.range < component.range) return {kind: 'slice', ...slice};
        if (component.range < Infinity) return {kind: 'component', ...component};
        return {kind: 'nothing'};
    }
}
