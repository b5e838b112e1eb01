function refuse(reason) {
    element('trouble').hidden = false;
    element('trouble').textContent = reason;
    document.body.dataset.state = 'refused';
}

async function start() {
    const canvas = element('canvas');
    const context = canvas.getContext('webgl', {antialias: true, alpha: false});
    if (!context || !context.getExtension('OES_texture_float') ||
        context.getParameter(context.MAX_VERTEX_TEXTURE_IMAGE_UNITS) < 4)
        return refuse('This browser has no WebGL, which the 3D view needs.');
    if (typeof DecompressionStream === 'undefined')
        return refuse('This browser is too old to unpack the map in this page.');
    const viewer = new Viewer(canvas, context, await unpackArrays());
    const panel = new Panel(viewer);
    viewer.draw();
    document.body.dataset.state = 'ready';
    // For programs that look at the page.
    window.hgmmView = {viewer, panel, facts};
}

start();
