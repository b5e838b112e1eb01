// The controls beside the canvas, the legend and the numbers of what was picked.
const element = (id) => document.getElementById(id);
const metres = (v, digits = 2) => `${v.toFixed(digits)} m`;
const percent = (p) => `${Math.round(100 * p)} %`;

class Panel {
    constructor(viewer) {
        this.viewer = viewer;
        this.fill();
        this.listen();
        this.changed();
    }

    fill() {
        const {viewer} = this;
        const {surfaces, poses, hasPoints} = facts;
        element('level').max = surfaces.length - 2;
        viewer.colourings.forEach((c, i) => element('colour').add(new Option(c.title, i)));
        element('up').value = facts.up;
        element('slice-axis').value = facts.up.slice(-1);
        element('points-row').hidden = !hasPoints;
        element('path-rows').hidden = poses === 0;
        element('time').max = Math.max(0, poses - 1);
        element('time').value = element('time').max;
        const size = facts.half.map((h) => (2 * h).toFixed(1)).join(' \u00d7 ');
        element('facts-line').textContent =
            `${surfaces[1].toLocaleString('en')} Gaussians of surfaces, ` +
            `${facts.free[1].toLocaleString('en')} of free space, ${size} m`;
        this.resetSlice();
    }

    // To where most is known.
    resetSlice() {
        const w = {x: 0, y: 1, z: 2}[element('slice-axis').value];
        const known = this.viewer.slice.knownCells(w);
        element('slice-at').max = known.length - 1;
        element('slice-at').value = known.indexOf(Math.max(...known));
    }

    listen() {
        element('controls').addEventListener('input', (event) => {
            if (event.target.id === 'up') {
                this.viewer.setUp(element('up').value);
                element('slice-axis').value = element('up').value.slice(-1);
            }
            if (['up', 'slice-axis'].includes(event.target.id)) this.resetSlice();
            if (event.target.id === 'level') this.showPicked({kind: 'nothing'});
            this.changed();
        });
        element('view-top').addEventListener('click', () => this.viewer.lookFrom(-90, 89.9));
        element('view-side').addEventListener('click', () => this.viewer.lookFrom(-90, 8));
        element('view-start').addEventListener('click', () => this.viewer.lookFrom(-125, 48));
        element('theme').addEventListener('click', () => this.turnTheme());
        matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.changed());
        this.listenToPointer();
        document.addEventListener('keydown', (event) => this.key(event));
    }

    // A press and release in one place picks; a drag turns.
    listenToPointer() {
        const {canvas} = this.viewer;
        let down = null;
        canvas.addEventListener('pointerdown', (e) => { down = [e.clientX, e.clientY]; });
        canvas.addEventListener('pointerup', (e) => {
            if (!down || Math.hypot(e.clientX - down[0], e.clientY - down[1]) > 5) return;
            const box = canvas.getBoundingClientRect();
            this.pick((e.clientX - box.left) / box.width, (e.clientY - box.top) / box.height);
        });
    }

    pick(x, y) {
        const found = this.viewer.pickAt(x, y);
        this.viewer.picked(found.kind === 'component' ? found.component : -1);
        this.showPicked(found);
    }

    turnTheme() {
        const root = document.documentElement;
        const dark = getComputedStyle(root).getPropertyValue('--dark').trim() === '1';
        root.dataset.theme = dark ? 'light' : 'dark';
        this.changed();
    }

    // Puts what the controls say into the view.
    changed() {
        const {viewer} = this, level = Number(element('level').value);
        if (level !== viewer.surfaces.level) viewer.level(level);
        const colouring = Number(element('colour').value);
        if (viewer.colouring !== viewer.colourings[colouring]) viewer.colour(colouring);
        viewer.surfaces.shown = element('surfaces').checked;
        viewer.free.shown = element('free').checked;
        viewer.unknown.visible = element('unknown').checked;
        if (viewer.points) viewer.points.visible = element('points').checked;
        viewer.slice.mesh.visible = element('slice').checked;
        viewer.cutting = element('cut').checked;
        viewer.slice.put(element('slice-axis').value, Number(element('slice-at').value));
        this.changedPath();
        const paper = getComputedStyle(document.documentElement).getPropertyValue('--canvas');
        viewer.renderer.setClearColor(new THREE.Color(paper.trim()));
        this.describe(level);
        this.drawLegend();
        viewer.request();
    }

    changedPath() {
        const {trajectory} = this.viewer;
        if (!trajectory) return;
        const at = Number(element('time').value);
        trajectory.group.visible = element('path').checked;
        trajectory.goTo(at);
        element('time-text').textContent =
            `${trajectory.time[at].toFixed(1)} of ${trajectory.time[facts.poses - 1].toFixed(1)} s`;
    }

    describe(level) {
        const {slice} = this.viewer, w = slice.axes()[2];
        const count = facts.surfaces[level + 1] - facts.surfaces[level];
        element('level-text').textContent =
            `${level + facts.finest}${level === 0 ? ', the finest' : ''}: ` +
            `${count.toLocaleString('en')} ellipsoids`;
        element('slice-text').textContent =
            `${slice.axis} = ${metres(slice.place_m + facts.centre[w])}`;
        const cell = facts.lattice.cell.map((c) => (100 * c).toFixed(0)).join(' \u00d7 ');
        element('cell-text').textContent = `Cells of ${cell} cm. One that a surface passes is occupied.`;
    }

    drawLegend() {
        const {viewer} = this, {colouring} = viewer, rows = [];
        const swatch = (look, text) => `<li><i class="swatch ${look}"></i>${text}</li>`;
        if (viewer.slice.mesh.visible)
            rows.push(...['free', 'occupied', 'unknown'].map((name) => swatch(name, name)));
        else {
            if (viewer.free.shown) rows.push(swatch('free', 'free'));
            if (viewer.unknown.visible) rows.push(swatch('unknown', 'unknown'));
        }
        if (viewer.points && viewer.points.visible) rows.push(swatch('points', 'input points'));
        if (viewer.trajectory && viewer.trajectory.group.visible)
            rows.push(swatch('path', 'trajectory'));
        element('legend-list').innerHTML = rows.join('');
        element('scale').hidden = !viewer.surfaces.shown;
        const unit = colouring.unit ? ` [${colouring.unit}]` : '';
        element('scale-title').textContent = `Surfaces: ${colouring.title}${unit}`;
        element('scale-bar').hidden = !colouring.range;
        if (!colouring.range) return;
        const digits = colouring.range[1] - colouring.range[0] < 1 ? 3 : 1;
        element('scale-low').textContent = colouring.range[0].toFixed(digits);
        element('scale-high').textContent = colouring.range[1].toFixed(digits);
    }

    showPicked(found) {
        element('picked').hidden = found.kind === 'nothing';
        element('picked').dataset.kind = found.kind;
        if (found.kind === 'nothing') return;
        const rows = found.kind === 'slice' ? this.sliceRows(found) : this.componentRows(found);
        element('picked-title').textContent = found.kind === 'slice'
            ? 'Cell of the slice' : `Component ${found.component - facts.surfaces[
                this.viewer.surfaces.level]}`;
        const list = element('picked-list');
        list.textContent = '';
        for (const [name, value] of rows) {
            const row = document.createElement('div');
            for (const [tag, text] of [['dt', name], ['dd', value]])
                row.appendChild(document.createElement(tag)).textContent = text;
            list.appendChild(row);
        }
    }

    inMap(place) {
        return [0, 1, 2].map((k) => (place[k] + facts.centre[k]).toFixed(2)).join(', ') + ' m';
    }

    sliceRows(found) {
        const answer = this.viewer.slice.at(found.place);
        const unknown = Math.max(0, 1 - answer.occupied - answer.free);
        const shares = {occupied: answer.occupied, free: answer.free, unknown};
        const word = Object.keys(shares).reduce((a, b) => shares[b] > shares[a] ? b : a);
        return [['it is', word], ['P(occupied)', percent(answer.occupied)],
                ['P(free)', percent(answer.free)], ['P(unknown)', percent(unknown)],
                ['at x, y, z', this.inMap(found.place)]];
    }

    componentRows({component: i}) {
        const {arrays, surfaces} = this.viewer;
        const three = (array) => [array[3 * i], array[3 * i + 1], array[3 * i + 2]];
        const rows = [
            ['level', `${surfaces.level + facts.finest}`],
            ['mean x, y, z', this.inMap(three(surfaces.mean))],
            ['std. deviations',
             three(surfaces.deviation).map((d) => (100 * d).toFixed(1)).join(', ') + ' cm'],
            ['points explained', arrays['surfaces.support'][i].toFixed(0)],
            ['P(occupied) at the mean', percent(arrays.occupied[i])],
            ['std. deviation of distance', (100 * arrays.deviation[i]).toFixed(1) + ' cm'],
        ];
        for (const name of facts.modalities) {
            const [mean, deviation] = arrays[`modality.${name}`].subarray(2 * i, 2 * i + 2);
            rows.push([name, Number.isFinite(mean)
                ? `${mean.toFixed(3)} \u00b1 ${deviation.toFixed(3)}` : 'not known']);
        }
        return rows;
    }

    toggle(id) {
        if (element(id).closest('[hidden]')) return;
        element(id).checked = !element(id).checked;
        this.changed();
    }

    step(id, by) {
        element(id).value = Number(element(id).value) + by;
        if (id === 'level') this.showPicked({kind: 'nothing'});
        this.changed();
    }

    nextColour() {
        const list = element('colour');
        list.selectedIndex = (list.selectedIndex + 1) % list.options.length;
        this.changed();
    }

    key(event) {
        if (event.ctrlKey || event.altKey || event.metaKey) return;
        const onControl = event.target.matches('input, select, button, summary');
        const turns = {ArrowLeft: [-0.1, 0, 1], ArrowRight: [0.1, 0, 1], ArrowUp: [0, 0.1, 1],
                       ArrowDown: [0, -0.1, 1], '+': [0, 0, 1.15], '=': [0, 0, 1.15],
                       '-': [0, 0, 1 / 1.15]};
        const actions = {
            '[': () => this.step('level', -1), ']': () => this.step('level', 1),
            ',': () => this.step('slice-at', -1), '.': () => this.step('slice-at', 1),
            j: () => this.step('time', -1), k: () => this.step('time', 1),
            c: () => this.nextColour(), e: () => this.toggle('surfaces'),
            s: () => this.toggle('slice'), x: () => this.toggle('cut'),
            f: () => this.toggle('free'), u: () => this.toggle('unknown'),
            i: () => this.toggle('points'), p: () => this.toggle('path'),
            t: () => this.viewer.lookFrom(-90, 89.9), r: () => this.viewer.lookFrom(-125, 48),
        };
        if (actions[event.key]) actions[event.key]();
        else if (event.key === 'Enter' && !onControl) this.pick(0.5, 0.5);
        else if (turns[event.key] && !(onControl && event.key.startsWith('Arrow')))
            this.viewer.move(...turns[event.key]);
        else return;
        event.preventDefault();
    }
}
