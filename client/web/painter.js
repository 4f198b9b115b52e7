// The painter's thread: core and canvas. From the page: what the user does, and a request for each picture. To the page:
// its state after each. From the network and to it: bytes.
'use strict';

const mostMilliseconds = 1000 / 15; // a picture, beyond which it has half the size
const slowPictures = 10; // in a row, until it has
const standsMilliseconds = 1000; // until it has its whole size again
const mostFlownSeconds = 0.2; // at once, where a picture took long

let network = null; // its port
let number = 0; // of the socket whose bytes these are; 0: none
let unsent = 0; // frames that the network has not taken
let core = null;
let canvas = null;
let context = null; // of a canvas without WebGL
let webgl = null; // the number of the canvas' context, where it has that
let wantedPainter = 'auto';
let scale = 1; // of the picture's size to the canvas' on the screen
let slow = 0; // pictures in a row that took too long
let moved = 0; // when something moved last, milliseconds
let flying = [0, 0, 0]; // right, up, backwards, as the keys that are held say
let isFast = false;
let painted = 0; // when the last picture was asked for, milliseconds
const does = {
    paint, painter: askForScreen, screen: setScreen, picture,
    fly: (direction, fast) => [flying, isFast] = [direction, fast],
};

onmessage = async event => {
    const {module, port, screen, token, painter} = event.data;
    const call = await startModule(module, bytes => {
        ++unsent;
        core.noteSent(false);
        network.postMessage(['send', number, bytes], [bytes.buffer]);
    });
    core = {
        begin: call('begin', null, 'string'), open: call('open', null),
        receive: call('receive', 'boolean', 'number', 'number'), noteSent: call('note_sent', null, 'boolean'),
        close: call('close', 'number', 'string', 'number'), setScreen: call('set_screen', 'boolean', 'string'),
        dropScreen: call('drop_screen', null), paint: call('paint', 'number', 'number', 'number'),
        show: call('show', null),
        pixels: call('pixels', 'number'), width: call('width', 'number'), height: call('height', 'number'),
        state: call('state', 'string'),
        fly: call('fly', null, 'number', 'number', 'number', 'boolean', 'number'),
    };
    for (const [name, ...types] of [['dolly', 'number'], ['fit'], ['camera', 'number'], ['play', 'boolean'],
        ['seek', 'number'], ['exposure', 'number'], ['pause', 'boolean'], ['look_along', 'number'], ['projection'],
        ['smooth', 'boolean'], ['overlay', 'string']]) {
        does[name] = call(name, null, ...types);
    }
    for (const [name, ...types] of [['view'], ['go_to', 'string'], ['overlays'], ['bookmarks'],
        ['load_bookmarks', 'string'], ['add_bookmark'], ['remove_bookmark'], ['go_to_bookmark', 'number']]) {
        const act = call(name, 'string', ...types); // these are answered
        does[name] = (...values) => postMessage({id: values.pop(), answer: act(...values)});
    }
    for (const name of ['orbit', 'pan', 'focus']) { // these are given pixels of the screen
        const act = call(name, null, 'number', 'number');
        does[name] = (x, y) => act(scale * x, scale * y);
    }
    core.begin(token);
    wantedPainter = painter;
    setScreen(screen);
    network = port;
    network.onmessage = message => hears[message.data[0]](...message.data.slice(1));
    onmessage = message => {
        const [name, ...values] = message.data;
        does[name](...values);
        moved = name === 'paint' ? moved : performance.now();
    };
    postMessage({ready: true});
};

const hears = {
    open: of => {
        number = of;
        core.open();
    },
    bytes: buffer => {
        if (number > 0 && !withBytes(new Uint8Array(buffer), core.receive)) {
            network.postMessage(['end', number]);
            number = 0; // what else comes of it is nothing
        }
        network.postMessage(['taken', number, buffer.byteLength]);
    },
    closed: reason => {
        const seconds = core.close(reason, Math.random());
        if (seconds >= 0) {
            network.postMessage(['retry', seconds]);
        }
    },
    sent: frames => {
        unsent -= frames;
        core.noteSent(unsent === 0);
    },
};

/// Paints to this canvas from now on: by WebGL where the graphics card can paint, else from memory, for which the page
/// is asked for a canvas that has no WebGL yet.
function setScreen(screen) {
    const gl = wantedPainter === 'cpu' ? null : screen.getContext('webgl2', {alpha: false, antialias: false,
        depth: false, stencil: false, preserveDrawingBuffer: true, powerPreference: 'high-performance'});
    if (gl) {
        gl.getExtension('EXT_color_buffer_float');
        gl.getExtension('WEBGL_debug_renderer_info');
        webgl = GL.registerContext(gl, {majorVersion: 2});
        GL.makeContextCurrent(webgl);
        if (core.setScreen(wantedPainter)) {
            canvas = screen;
        } else {
            askForScreen('cpu');
        }
    } else {
        core.dropScreen();
        canvas = screen;
        context = canvas.getContext('2d', {alpha: false});
    }
}

function askForScreen(painter) {
    wantedPainter = painter;
    canvas = context = null;
    core.dropScreen();
    if (webgl !== null) {
        GL.deleteContext(webgl);
        webgl = null;
    }
    postMessage({needsScreen: true});
}

function paint(width, height) {
    const begun = performance.now();
    if (flying.some(way => way !== 0)) {
        core.fly(...flying, isFast, Math.min((begun - painted) / 1000, mostFlownSeconds));
        moved = begun;
    }
    painted = begun;
    const result = canvas === null ? 0 : core.paint(Math.ceil(width * scale), Math.ceil(height * scale));
    if (result < 0) {
        askForScreen('cpu');
    } else if (result > 0) {
        show();
    }
    const state = JSON.parse(core.state());
    chooseScale(state, result > 0, performance.now() - begun);
    postMessage({state});
}

function show() {
    const [width, height] = [core.width(), core.height()];
    if (canvas.width !== width || canvas.height !== height) {
        [canvas.width, canvas.height] = [width, height];
    }
    if (webgl !== null) {
        core.show();
    } else {
        const pixels = new Uint8ClampedArray(HEAPU8.buffer, core.pixels(), 4 * width * height);
        context.putImageData(new ImageData(pixels, width, height), 0, 0);
    }
}

/// Answers with what the canvas shows, as PNG.
async function picture(id) {
    postMessage({id, answer: canvas && canvas.width > 1 ? await canvas.convertToBlob({type: 'image/png'}) : null});
}

/// Half the size while something moves and a processor makes too few pictures; the whole one once all stands.
function chooseScale(state, isNew, milliseconds) {
    const now = performance.now();
    if (state.playing && state.duration > 0) {
        moved = now;
    }
    if (now - moved > standsMilliseconds) {
        scale = 1;
        slow = 0;
    } else if (isNew && webgl === null && scale === 1) {
        slow = milliseconds > mostMilliseconds ? slow + 1 : 0;
        scale = slow >= slowPictures ? 0.5 : 1;
    }
}
importScripts('module.js');
