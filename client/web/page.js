// The page's own thread: what the user does, the controls. The socket and the pictures have threads of their own.
'use strict';

const part = id => document.getElementById(id);
const view = part('view');
const painter = new Worker('painter.js');
const network = new Worker('network.js');
let isReady = false; // the painter: what is said before is not heard
const tell = (...message) => isReady && painter.postMessage(message);
let questions = new Map(); // that the painter has not answered, by number
let asked = 0;
/// Resolves to the painter's answer.
const ask = (...message) => new Promise(resolve => {
    questions.set(++asked, resolve);
    tell(...message, asked);
});
let size = [1, 1]; // of the canvas on the screen, device pixels
let isAsked = false; // the painter has not answered the last request for a picture
let shown = {state: {}, pictures: [], tell, ask}; // the last state, and when pictures of the last second were shown
let isSeeking = false;

window.framelet = shown; // for tests

/// What the address says behind its #, where no server hears it.
const told = name => new URLSearchParams(location.hash.slice(1)).get(name);

new ResizeObserver(() => {
    const box = view.getBoundingClientRect();
    size = [box.width, box.height].map(side => Math.max(1, Math.round(side * devicePixelRatio)));
}).observe(view);

function askForPictures() {
    requestAnimationFrame(askForPictures);
    if (!isAsked) {
        isAsked = true;
        tell('paint', ...size);
    }
}

async function begin() {
    const module = await WebAssembly.compileStreaming(fetch('framelet.wasm'));
    const [token, painterName] = [told('token') ?? '', told('painter') ?? 'auto'];
    if (token !== '' && !isSecureContext) {
        throw new Error('the token is not sent to another machine in clear: open it by https, or through a tunnel');
    }
    const address = new URL('session', location.href.split(/[?#]/)[0]);
    address.protocol = address.protocol.replace('http', 'ws');
    const screen = part('picture').transferControlToOffscreen();
    const {port1, port2} = new MessageChannel();
    painter.postMessage({module, token, screen, painter: painterName, port: port1}, [screen, port1]);
    network.postMessage({module, url: address.href, port: port2}, [port2]);
}

painter.onmessage = event => {
    const {ready, needsScreen, id, answer, state} = event.data;
    if (ready) {
        isReady = true;
        tell('exposure', Number(part('exposure').value)); // browsers keep it where a page is loaded again
        tell('smooth', part('smooth').checked);
        tell('pause', document.hidden);
        offerOverlays();
        askForPictures();
        return;
    }
    if (id) {
        questions.get(id)(answer);
        questions.delete(id);
        return;
    }
    if (needsScreen) { // a canvas that has had WebGL can have nothing else
        const screen = document.createElement('canvas');
        screen.id = 'picture';
        part('picture').replaceWith(screen);
        const moved = screen.transferControlToOffscreen();
        painter.postMessage(['screen', moved], [moved]);
        return;
    }
    isAsked = false;
    const now = performance.now();
    shown.pictures = shown.pictures.filter(time => now - time < 1000);
    if (state.pictures > (shown.state.pictures ?? 0)) {
        shown.pictures.push(now);
    }
    const isFirst = shown.state.scene === undefined && state.scene !== undefined;
    const isOther = state.scene_number !== shown.state.scene_number;
    shown.state = state;
    show(state);
    if (isFirst) {
        goToAddress();
    }
    if (isOther) {
        loadBookmarks();
    }
};
const fail = event => setText('notice', 'the page cannot go on: ' + event.message);
painter.onerror = network.onerror = fail;
begin().catch(fail);
view.focus();

function setText(id, text) {
    if (part(id).textContent !== text) {
        part(id).textContent = text;
    }
}

function show(state) {
    const isTried = state.reason && !state.refused;
    const what = isTried ? '; trying to connect again'
        : state.reason === 'wrong or missing token' ? ': open the whole address, which the server shows in its terminal'
        : '';
    setText('notice', state.reason ? state.reason + what
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
    part('exposure').value = document.activeElement === part('exposure') ? part('exposure').value : state.exposure;
    showCameras(state);
    part('smooth').disabled = state.smoothing_lacks !== '';
    part('smooth').parentElement.title = state.smoothing_lacks || 'smooth motion, the scene a little late';
    plots.note(state, performance.now() / 1000);
    const perPicture = 1000 * state.reconstruct_seconds / Math.max(state.pictures, 1);
    setText('statistics', `${state.quality}, ${shown.pictures.length} pictures/s, ${perPicture.toFixed(0)} ms each, `
        + `${(state.bytes / 1e6).toFixed(1)} MB, answer after ${(1000 * state.round_trip_seconds).toFixed(0)} ms`);
}

/// What one can look through: cameras of the scene, the user's own, and bookmarks.
function showCameras(state) {
    const names = JSON.stringify([state.cameras, state.bookmarks]);
    if (part('camera').dataset.names !== names) {
        const bookmarks = document.createElement('optgroup');
        bookmarks.label = 'bookmarks';
        bookmarks.append(...state.bookmarks.map((name, i) => new Option(name, 'bookmark ' + i)));
        part('camera').replaceChildren(...state.cameras.map((name, i) => new Option(name || 'camera ' + (i + 1), i)),
            new Option('free camera', -1), ...state.bookmarks.length > 0 ? [bookmarks] : []);
        part('camera').dataset.names = names;
    }
    part('camera').value = state.bookmark >= 0 ? 'bookmark ' + state.bookmark : state.camera;
    part('remove').hidden = state.bookmark < 0;
}

/// Goes to the view that the address says, if it does.
async function goToAddress() {
    const view = told('camera');
    note(view === null ? '' : await ask('go_to', view));
}
window.onhashchange = goToAddress;

/// Puts the view into the address, from where it can be copied.
async function putIntoAddress() {
    const others = location.hash.slice(1).split('&').filter(part => part !== '' && !part.startsWith('camera='));
    others.push('camera=' + encodeURIComponent((await ask('view')).trim()));
    history.replaceState(null, '', '#' + others.join('&'));
    note('the address is that of this view now');
}

async function savePicture() {
    const picture = await ask('picture');
    if (picture !== null) {
        const link = document.createElement('a');
        link.href = URL.createObjectURL(picture);
        link.download = (shown.state.scene ?? 'framelet') + '.png';
        link.click();
        setTimeout(URL.revokeObjectURL, 60000, link.href);
    }
}

let overlays = []; // what can be drawn over the picture, with its legends

async function offerOverlays() {
    const {colors, overlays: all} = JSON.parse(await ask('overlays'));
    overlays = all;
    part('overlay').replaceChildren(...overlays.map(({name}) => new Option(name)));
    overlays.forEach(({tip}, i) => part('overlay').options[i].title = tip);
    part('ramp').style.background = `linear-gradient(to right, ${colors.map(color => `rgb(${color})`)})`;
}

function drawOver() {
    const {name, tip, title, newest, oldest, remark} = overlays[part('overlay').selectedIndex];
    tell('overlay', name);
    part('overlay').title = tip;
    part('legend').hidden = title === undefined;
    part('ramp').hidden = part('ends').hidden = !newest;
    for (const [id, text] of Object.entries({title, newest, oldest, remark})) {
        setText(id, text ?? '');
    }
}

part('figures').onclick = () => {
    part('plots').hidden = !part('plots').hidden;
    part('figures').setAttribute('aria-pressed', !part('plots').hidden);
    plots.draw();
};

// Bookmarks are kept in the browser, a text for each scene, named as the window names its file.
let keptAt = '';
let isBroken = false; // what is kept is no such text

async function loadBookmarks() {
    keptAt = `framelet/cameras/${shown.state.scene}-${shown.state.scene_source}`;
    let text = null;
    try {
        text = localStorage.getItem(keptAt);
    } catch { // a page around this one may have taken it away: what is added is forgotten with the page
    }
    const complaint = await ask('load_bookmarks', text ?? '{"cameras": []}');
    isBroken = complaint !== '';
    if (isBroken) {
        note(complaint);
    }
}
window.onstorage = event => event.key === keptAt && loadBookmarks(); // another page of the scene has changed them

/// Changes the bookmarks by this message, and keeps them.
async function changeBookmarks(message) {
    const before = await ask('bookmarks');
    const said = await ask(message);
    const after = await ask('bookmarks');
    note(said + (after === before ? '' : keepBookmarks(after)));
}

/// Says where that fails. What was broken is kept beside it.
function keepBookmarks(text) {
    try {
        if (isBroken) {
            localStorage.setItem(keptAt + '.broken', localStorage.getItem(keptAt));
        }
    } catch { // it is written over
    }
    try {
        localStorage.setItem(keptAt, text);
        isBroken = false;
        return '';
    } catch (error) {
        return '; it is forgotten with the page: ' + error.message;
    }
}

const goToBookmark = async number => note(await ask('go_to_bookmark', number));

let noted = 0; // the timer of the note
function note(text) {
    clearTimeout(noted);
    part('note').textContent = text;
    noted = setTimeout(() => part('note').textContent = '', 4000);
}

part('controls').onsubmit = event => event.preventDefault();
part('play').onclick = () => tell('play', !shown.state.playing);
part('time').oninput = event => {
    isSeeking = true;
    tell('seek', Number(event.target.value));
};
part('time').onchange = () => isSeeking = false;
part('exposure').oninput = event => tell('exposure', Number(event.target.value));
part('camera').onchange = event => {
    const [, bookmark] = /^bookmark (\d+)$/.exec(event.target.value) ?? [];
    bookmark === undefined ? tell('camera', Number(event.target.value)) : goToBookmark(Number(bookmark));
};
part('bookmark').onclick = () => changeBookmarks('add_bookmark');
part('remove').onclick = () => changeBookmarks('remove_bookmark');
part('overlay').onchange = drawOver;
part('smooth').onchange = event => tell('smooth', event.target.checked);
part('view-along').onchange = event => {
    tell('look_along', Number(event.target.value));
    event.target.value = '';
};
part('fit').onclick = () => tell('fit');
part('link').onclick = putIntoAddress;
part('save').onclick = savePicture;
part('help').onclick = () => part('keys').showModal();
part('close').onclick = () => part('keys').close();
// Says goodbye, so that the server keeps nothing for this page, before the browser ends or freezes its threads: they
// need a moment.
window.onpagehide = () => {
    network.postMessage('leave');
    for (const begun = performance.now(); performance.now() < begun + 50;);
    network.terminate();
};
window.onpageshow = event => event.persisted && location.reload(); // one that was kept to come back to
document.onvisibilitychange = () => tell('pause', document.hidden);

// One finger or the left button orbits; the right or middle one, or Shift, pans; two fingers pan and pinch.
const fingers = new Map(); // pointers that are down, by their id: their places, device pixels
const placeOf = event => {
    const box = view.getBoundingClientRect();
    return [(event.clientX - box.left) * devicePixelRatio, (event.clientY - box.top) * devicePixelRatio];
};
const middle = () => [0, 1].map(axis => [...fingers.values()].reduce((sum, at) => sum + at[axis], 0) / fingers.size);
const spread = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
};

view.onpointerdown = event => {
    view.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, placeOf(event));
};
view.onpointerup = view.onpointercancel = event => fingers.delete(event.pointerId);
view.onpointermove = event => {
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
view.oncontextmenu = event => event.preventDefault();
view.ondblclick = event => tell('focus', ...placeOf(event));
view.addEventListener('wheel', event => {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / 100 : event.deltaY / 3;
    tell('dolly', -lines);
}, {passive: false});
// Keys as in framelet-viewer, as far as browsers leave them.
const held = new Set();
const ways = {d: [0, 1], a: [0, -1], e: [1, 1], q: [1, -1], s: [2, 1], w: [2, -1]};
const acts = {
    ' ': () => part('play').click(), f: () => tell('fit'), c: putIntoAddress, '0': () => tell('camera', -1),
    b: event => changeBookmarks(event.shiftKey ? 'remove_bookmark' : 'add_bookmark'),
    ArrowRight: () => seekBy(1), ArrowLeft: () => seekBy(-1), Home: () => tell('seek', 0),
    ']': () => expose(0.25), '[': () => expose(-0.25),
};
for (const [key, forth, back] of [['1', 0, 1], ['3', 2, 3], ['7', 4, 5]]) {
    acts['Num' + key] = event => tell('look_along', event.ctrlKey ? back : forth);
}
acts.Num5 = () => tell('projection');
for (let i = 1; i <= 9; ++i) {
    acts[i] = () => tell('camera', i - 1);
    acts['Shift' + i] = () => goToBookmark(i - 1);
}
const repeating = new Set(['ArrowRight', 'ArrowLeft', ']', '[']); // while the key is held
const seekBy = seconds => shown.state.controls && tell('seek', Math.max(shown.state.time + seconds, 0));
const expose = stops => tell('exposure', Math.max(-16, Math.min(16, shown.state.exposure + stops)));

function fly(event) {
    const direction = [0, 0, 0];
    held.forEach(key => direction[ways[key][0]] += ways[key][1]);
    tell('fly', direction, event.shiftKey);
}
view.onkeydown = event => {
    const [, row, digit] = /^(Numpad|Digit)(\d)$/.exec(event.code) ?? []; // by its place, whatever Shift makes of it
    const key = row === 'Numpad' ? 'Num' + digit : row ? (event.shiftKey ? 'Shift' : '') + digit
        : event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (event.altKey || event.metaKey || (event.ctrlKey && row !== 'Numpad')) {
        return;
    }
    if (key in ways) {
        held.add(key);
    } else if (!(key in acts)) {
        return;
    }
    event.preventDefault();
    if (key in ways) {
        fly(event);
    } else if (!event.repeat || repeating.has(key)) {
        acts[key](event);
    }
};
view.onkeyup = event => held.delete(event.key.toLowerCase()) && fly(event);
view.onblur = event => {
    held.clear();
    fly(event);
};

const everywhere = { // wherever the focus is
    F2: () => part('figures').click(),
    F3: () => {
        if (overlays.length > 0) {
            part('overlay').selectedIndex = (part('overlay').selectedIndex + 1) % overlays.length;
            drawOver();
        }
    },
};
window.onkeydown = event => {
    if (event.key in everywhere && !event.altKey && !event.metaKey && !event.ctrlKey && !event.shiftKey) {
        event.preventDefault();
        event.repeat || everywhere[event.key]();
    }
};

// A page around this one, as a notebook, says [call, value] by postMessage and is answered [call, answer]. It is to be
// of this page's origin, or to have opened it with a token, without which nothing can be seen.
const calls = {
    state: () => shown.state, view: () => ask('view'), go: view => ask('go_to', view), picture: () => ask('picture'),
    play: playing => tell('play', Boolean(playing)), seek: seconds => tell('seek', Number(seconds)),
};
window.onmessage = async event => {
    const [call, value] = Array.isArray(event.data) ? event.data : [];
    const isTrusted = event.origin === location.origin || Boolean(told('token'));
    if (isTrusted && window.parent !== window && event.source === window.parent && Object.hasOwn(calls, call)) {
        event.source.postMessage([call, await calls[call](value)], event.origin);
    }
};
document.body.classList.toggle('bare', new URLSearchParams(location.search).get('ui') === 'none');
