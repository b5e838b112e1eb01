// What is beyond the cutting plane, dot(cut.xyz, p) > cut.w, is not drawn.
const cutting = `
    uniform vec4 cut;
    varying vec3 place;
    void dropBeyondCut() { if (dot(cut.xyz, place) > cut.w) discard; }
`;

// An instance is a number; textures hold what belongs to it.
const ellipsoidVertex = `
    attribute float component;
    uniform sampler2D means, deviations, turns, colours;
    uniform vec2 cells;
    uniform float sigmas, picked;
    uniform vec3 pickedColour;
    varying vec3 place, normalInView, colour;

    vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

    void main() {
        vec2 cell = (vec2(mod(component, cells.x), floor(component / cells.x)) + 0.5) / cells;
        vec3 size = texture2D(deviations, cell).xyz;
        vec4 turn = texture2D(turns, cell);
        place = texture2D(means, cell).xyz + turned(turn, sigmas * size * position);
        normalInView = mat3(viewMatrix) * turned(turn, normalize(position / size * size.z));
        colour = component == picked ? pickedColour : texture2D(colours, cell).rgb;
        gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
    }
`;
const ellipsoidFragment = cutting + `
    uniform float opacity;
    varying vec3 normalInView, colour;
    void main() {
        dropBeyondCut();
        float facing = abs(normalize(normalInView).z);
        float slanted = max(0.0, dot(normalize(normalInView), vec3(-0.4, 0.7, 0.6)));
        gl_FragColor = vec4(colour * (0.45 + 0.3 * facing + 0.3 * slanted), opacity);
    }
`;

const pointVertex = `
    uniform float size;
    varying vec3 place;
    void main() {
        place = position;
        gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
        gl_PointSize = size;
    }
`;
const pointFragment = cutting + `
    uniform vec3 colour;
    uniform float opacity;
    void main() {
        dropBeyondCut();
        gl_FragColor = vec4(colour, opacity);
    }
`;

// The likeliest of the three, with stripes for what is unknown.
const sliceVertex = `
    varying vec2 cell;
    void main() {
        cell = uv;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    }
`;
const sliceFragment = `
    uniform sampler2D answers;
    uniform vec3 occupiedColour, freeColour, unknownColour;
    uniform float stripe;
    varying vec2 cell;
    void main() {
        vec2 p = texture2D(answers, cell).rg * 5.1;
        float unknown = 1.0 - p.r - p.g;
        vec3 colour = p.r > p.g ? occupiedColour : freeColour;
        if (unknown > max(p.r, p.g)) {
            float phase = mod((gl_FragCoord.x + gl_FragCoord.y) / stripe, 1.0);
            colour = unknownColour * (phase < 0.3 ? 0.62 : 1.0);
        }
        gl_FragColor = vec4(colour, 1.0);
    }
`;
