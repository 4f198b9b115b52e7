// The page's own thread: what the user does, the canvas, the controls. The session is the worker's.
'use strict';

const part = id => document.getElementById(id);
const canvas = part('picture');
const context = canvas.getContext('2d', {alpha: false});
const worker = new Worker('worker.js');
const tell = (...message) => worker.postMessage(message);
let size = [1, 1]; // of the canvas on the screen, device pixels
let isAsked = false; // the worker has not answered the last request for a picture
let shown = {state: {}, pictures: []}; // the last state, and when pictures of the last second were shown
let isSeeking = false;

// Tests and pages around this one read it.
window.framelet = shown;

new ResizeObserver(() => {
    const box = canvas.getBoundingClientRect();
    size = [box.width, box.height].map(side => Math.max(1, Math.round(side * devicePixelRatio)));
}).observe(canvas);

function ask() {
    requestAnimationFrame(ask);
    if (!isAsked) {
        isAsked = true;
        tell('paint', ...size);
    }
}

worker.onmessage = event => {
    const {ready, state, picture} = event.data;
    if (ready) {
        const token = new URLSearchParams(location.hash.slice(1)).get('token') ?? '';
        const address = new URL('session', location.href.split(/[?#]/)[0]);
        address.protocol = address.protocol.replace('http', 'ws');
        tell('begin', token, address.href);
        tell('exposure', Number(part('exposure').value)); // browsers keep it where a page is loaded again
        tell('pause', document.hidden);
        ask();
        return;
    }
    isAsked = false;
    const now = performance.now();
    shown.pictures = shown.pictures.filter(time => now - time < 1000);
    if (picture) {
        shown.pictures.push(now);
        if (canvas.width !== picture.width || canvas.height !== picture.height) {
            [canvas.width, canvas.height] = [picture.width, picture.height];
        }
        context.putImageData(new ImageData(picture.pixels, picture.width, picture.height), 0, 0);
    }
    shown.state = state;
    show(state);
};
worker.onerror = event => {
    part('notice').textContent = 'the page cannot go on: ' + event.message;
};

function setText(id, text) {
    if (part(id).textContent !== text) {
        part(id).textContent = text;
    }
}

function show(state) {
    const isTried = state.reason && !state.refused;
    setText('notice', state.reason ? state.reason + (isTried ? '; trying to connect again' : '')
        : state.scene === undefined ? 'connecting ...' : '');
    if (state.scene === undefined) {
        return;
    }
    document.title = state.scene + ' - framelet';
    setText('play', state.playing ? 'Pause' : 'Play');
    const moves = state.duration > 0;
    part('play').disabled = part('time').disabled = !moves || !state.controls;
    part('time').max = state.duration;
    const time = moves ? state.time % state.duration : 0;
    if (!isSeeking) {
        part('time').value = time;
    }
    setText('seconds', time.toFixed(2) + ' s');
    const names = state.cameras.concat('free');
    if ([...part('camera').options].map(option => option.text).join('\n') !== names.join('\n')) {
        part('camera').replaceChildren(...names.map((name, i) => new Option(name, i < state.cameras.length ? i : -1)));
    }
    part('camera').value = state.camera;
    const perPicture = 1000 * state.reconstruct_seconds / Math.max(state.pictures, 1);
    setText('statistics', `${state.quality}, ${shown.pictures.length} pictures/s, ${perPicture.toFixed(0)} ms each, `
        + `${(state.bytes / 1e6).toFixed(1)} MB, answer after ${(1000 * state.round_trip_seconds).toFixed(0)} ms`);
}

part('controls').onsubmit = event => event.preventDefault();
part('play').onclick = () => tell('play', !shown.state.playing);
part('time').oninput = event => {
    isSeeking = true;
    tell('seek', Number(event.target.value));
};
part('time').onchange = () => isSeeking = false;
part('exposure').oninput = event => tell('exposure', Number(event.target.value));
part('camera').onchange = event => tell('camera', Number(event.target.value));
part('fit').onclick = () => tell('fit');
document.onvisibilitychange = () => tell('pause', document.hidden);

// One finger or the left button orbits; the right or middle one, or Shift, pans; two fingers pan and pinch.
const fingers = new Map(); // pointers that are down, by their id: their places, device pixels
const placeOf = event => {
    const box = canvas.getBoundingClientRect();
    return [(event.clientX - box.left) * devicePixelRatio, (event.clientY - box.top) * devicePixelRatio];
};
const middle = () => [0, 1].map(axis => [...fingers.values()].reduce((sum, at) => sum + at[axis], 0) / fingers.size);
const spread = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
};

canvas.onpointerdown = event => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, placeOf(event));
};
canvas.onpointerup = canvas.onpointercancel = event => fingers.delete(event.pointerId);
canvas.onpointermove = event => {
    if (!fingers.has(event.pointerId)) {
        return;
    }
    const before = middle();
    const wide = fingers.size === 2 ? spread() : 0;
    fingers.set(event.pointerId, placeOf(event));
    const after = middle();
    const moved = [after[0] - before[0], after[1] - before[1]];
    const pans = fingers.size > 1 || event.shiftKey || (event.buttons & 6) !== 0;
    tell(pans ? 'pan' : 'orbit', ...moved);
    if (wide > 0) { // a step is a tenth of the way
        tell('dolly', Math.log(Math.max(spread(), 1) / wide) / -Math.log(0.9));
    }
};
canvas.oncontextmenu = event => event.preventDefault();
canvas.ondblclick = event => tell('focus', ...placeOf(event));
canvas.addEventListener('wheel', event => {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / 100 : event.deltaY / 3;
    tell('dolly', -lines);
}, {passive: false});
canvas.onkeydown = event => {
    const key = {' ': 'play', f: 'fit'}[event.key];
    if (key) {
        event.preventDefault();
        part(key).click();
    }
};
